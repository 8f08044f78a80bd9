// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/manifest.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "support/refusal.h"
#include "tests/support/temp_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <functional>
#include <regex>
#include <string>
#include <tuple>
#include <vector>

namespace aphotic::manifest_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Numbers = std::vector<double>;

Manifest some_manifest() {
    Manifest manifest;
    manifest.aphotic_version = "0.1.0";
    manifest.povray_version = "3.7.0.10";
    manifest.rig_title = "A \"quoted\" title, in Kiel\n";
    manifest.rig_sha256 = "ab12";
    manifest.width_px = 1360;
    manifest.height_px = 1024;
    manifest.lamp_signal = {0.1, 1.0 / 3.0, 1e-300};
    manifest.method = "fitted";
    manifest.tolerance = 1e-3;
    manifest.quality = {{{.error = 1.0 / 7.0, .amplification = 1.2}, {}, {.error = 1e-300}}};
    manifest.frame_error = 1.0 / 2048.0;
    manifest.geometry = {{"sled.altitude_m", "2"}, {"strobe 'fore \"x\"'", "at 0.5 0 0 m"}};
    manifest.model = ManifestModel{.error = {0.01, 1.0 / 3.0, 0.0}};
    manifest.rig_settings = ManifestSettings{.keys = {"sled.altitude_m=3", "title=a \"b\""}};
    manifest.strobes = {{.name = "fore \"x\"", .lamps_across = 5, .lamps_along = 3},
                        {.name = "aft"}};
    manifest.frames = {
        {.name = "band_450_550nm", .scene_sha256 = "s0", .image_sha256 = "i0"},
        {.name = "band_650.5nm", .scene_sha256 = "s1", .image_sha256 = ""},
    };
    manifest.wavelengths = {
        {.lambda_nm = 450.0,
         .weight = {0.1, -0.2, 1e17},
         .frame = 0,
         .channel = 0,
         .index_nm = 450.0,
         .light = {.attenuation_per_m = 1.0 / 3.0, .flux = {1.0 / 7.0, 0.0}, .reflectance = {0.3}},
         .exposure_log2 = 12,
         .radiance_bound = 0.75},
        {.lambda_nm = 550.1, .weight = {}, .frame = 0, .channel = 1, .exposure_log2 = -1000},
        {.lambda_nm = 650.5, .weight = {}, .frame = 1, .channel = 2, .exposure_log2 = 1000},
    };
    return manifest;
}

Json some_json() {
    const TempFolder folder;
    write_manifest(folder.path(), some_manifest());
    return Json::parse(read_text_file(folder.path() / "manifest.json"));
}

Manifest of_a_user_scene() {
    Manifest manifest = some_manifest();
    manifest.scene = ManifestScene{.file = "/a b/reef.pov",
                                   .sha256 = "c3",
                                   .materials = {"sand", "rust.csv"},
                                   .shortest_path_m = 1.0 / 3.0,
                                   .longest_path_m = 5.0};
    return manifest;
}

// What reading says of the manifest that change makes of a good one, after the file's name.
std::string error_after(const std::function<void(Json&)>& change) {
    Json json = some_json();
    change(json);
    const std::string message =
        refusal_of([&] { static_cast<void>(parse_manifest("manifest.json", json.dump())); });
    const std::string where = "manifest.json: ";
    if (message.starts_with(where)) return message.substr(where.size());
    return message == kAccepted ? message : "elsewhere: " + message;
}

// By hand: one weight of 0.1 at an exposure of 2^12.
TEST(Manifest, BlackIsWhereFramesLoseTheirDigits) {
    Manifest manifest = some_manifest();
    EXPECT_DOUBLE_EQ(manifest.black(0), 64.0 * 0.1 * 0x1p-26);
    manifest.png.emplace();
    EXPECT_DOUBLE_EQ(manifest.black(0), 0.1 * 0x1p-18);
    const TempFolder folder;
    write_manifest(folder.path(), manifest);
    EXPECT_EQ(read_manifest(folder.path()).frame_format(), FrameFormat::Png16);
}

Json json_in(const fs::path& folder) {
    return Json::parse(read_text_file(folder / "manifest.json"));
}

// No value is that of an empty manifest, so that what is not written, or not read, shows.
TEST(Manifest, ComesBackWhole) {
    const TempFolder folder;
    write_manifest(folder.path(), of_a_user_scene());
    const Json written = json_in(folder.path());
    const Manifest read = read_manifest(folder.path());
    EXPECT_TRUE(read.frames[0].done());
    EXPECT_FALSE(read.frames[1].done());
    write_manifest(folder.path(), read);
    EXPECT_EQ(json_in(folder.path()), written);
    write_manifest(folder.path(), {});
    const Json empty = json_in(folder.path());
    for (const auto& [key, value] : written.items()) {
        if (key == "format" || key == "no_promise") continue;
        EXPECT_NE(value, empty.value(key, Json())) << key;
    }
    // And so within the lists.
    const auto all_of = [](const Manifest& manifest) {
        std::vector<std::tuple<std::string, int, int>> strobes;
        for (const auto& s : manifest.strobes)
            strobes.emplace_back(s.name, s.lamps_across, s.lamps_along);
        std::vector<std::tuple<std::string, std::string, std::string>> frames;
        for (const auto& f : manifest.frames)
            frames.emplace_back(f.name, f.scene_sha256, f.image_sha256);
        std::vector<std::tuple<double, std::array<double, kChannels>, double, int, double>> bands;
        std::vector<std::tuple<std::size_t, std::size_t, double, Numbers, Numbers>> lights;
        for (const auto& w : manifest.wavelengths) {
            bands.emplace_back(
                w.lambda_nm, w.weight, w.index_nm, w.exposure_log2, w.radiance_bound);
            lights.emplace_back(
                w.frame, w.channel, w.light.attenuation_per_m, w.light.flux, w.light.reflectance);
        }
        return std::tuple(strobes, frames, bands, lights);
    };
    EXPECT_EQ(all_of(read), all_of(of_a_user_scene()));
}

TEST(Manifest, ComesBackWithoutAPromise) {
    const TempFolder folder;
    Manifest manifest = of_a_user_scene();
    manifest.no_promise = {"colours by numbers", "radiosity"};
    write_manifest(folder.path(), manifest);
    const Manifest read = read_manifest(folder.path());
    EXPECT_EQ(read.no_promise, manifest.no_promise);
    EXPECT_FALSE(read.has_promise());
    EXPECT_TRUE(some_manifest().has_promise());
    EXPECT_EQ(error_after([](Json& json) { json.erase("quality"); }),
              "quality: found nothing; allowed: a list of objects");
    EXPECT_EQ(error_after([](Json& json) {
                  json.erase("quality");
                  json["no_promise"] = {"radiosity"};
              }),
              kAccepted);
}

TEST(Manifest, ReplacesBytesOfATitleThatAreNoText) {
    const TempFolder folder;
    Manifest manifest = some_manifest();
    manifest.rig_title = "Kiel \xFF";
    write_manifest(folder.path(), manifest);
    EXPECT_EQ(read_manifest(folder.path()).rig_title, "Kiel \xEF\xBF\xBD");
}

TEST(Manifest, KnowsWhereEverythingStands) {
    const ManifestFrame frame{.name = "band_450nm", .scene_sha256 = "", .image_sha256 = ""};
    EXPECT_EQ(manifest_path("out"), "out/manifest.json");
    EXPECT_EQ(scene_path("out", frame), "out/povray/band_450nm.pov");
    EXPECT_EQ(image_path("out", frame), "out/povray/frames/band_450nm.exr");
}

TEST(Manifest, ThatIsMissingIsAnInputErrorThatNamesIt) {
    const TempFolder folder;
    EXPECT_EQ(
        refusal_of([&] { static_cast<void>(read_manifest(folder.path())); }),
        (folder.path() / "manifest.json").string() + ": cannot be read: No such file or directory");
}

TEST(Manifest, ThatIsNoJsonIsRefused) {
    for (const std::string text : {"", "{", "{\"format\":", "{\"width_px\": 1e999}"}) {
        const TempFolder folder;
        write_file(folder.path() / "manifest.json", text);
        EXPECT_EQ(refusal_of([&] { static_cast<void>(read_manifest(folder.path())); }),
                  (folder.path() / "manifest.json").string() + ": not valid JSON")
            << text;
    }
    EXPECT_EQ(error_after([](Json& json) { json = Json::array(); }),
              "value: found []; allowed: an object");
}

TEST(Manifest, NamesEachKeyThatIsMissing) {
    EXPECT_EQ(error_after([](Json&) {}), kAccepted);
    Json whole = some_json();
    whole.erase("sha256");        // is asked for of files alone
    whole.erase("rig_settings");  // of rigs with --set
    whole.erase("model");         // of water that scatters
    for (const auto& [key, value] : whole.items()) {
        const std::string message = error_after([gone = key](Json& json) { json.erase(gone); });
        EXPECT_TRUE(message.starts_with(key + ": found nothing; allowed: ")) << message;
    }
    for (const auto& [key, value] : whole["wavelengths"][1].items()) {
        const std::string message =
            error_after([gone = key](Json& json) { json["wavelengths"][1].erase(gone); });
        EXPECT_TRUE(message.starts_with("wavelengths[1]: " + key + ": found nothing; allowed: "))
            << message;
    }
    for (const auto& [key, value] : whole["frames"][0].items()) {
        const std::string message =
            error_after([gone = key](Json& json) { json["frames"][0].erase(gone); });
        EXPECT_TRUE(message.starts_with("frames[0]: " + key + ": found nothing; allowed: "))
            << message;
    }
}

// Whatever changed: what is read from a folder is what was written to it.
TEST(Manifest, ChangedSinceItWasWrittenIsRefused) {
    const TempFolder folder;
    write_manifest(folder.path(), some_manifest());
    const fs::path file = folder.path() / "manifest.json";
    const auto error_of = [&](const std::function<void(Json&)>& change) -> std::string {
        Json json = some_json();
        change(json);
        write_file(file, json.dump());
        return refusal_of([&] { static_cast<void>(read_manifest(folder.path())); });
    };
    EXPECT_EQ(error_of([](Json&) {}), kAccepted) << "laid out anew";
    const std::string refused = file.string() +
                                ": sha256: does not match the rest, which was changed after it was "
                                "written; allowed: a manifest as aphotic wrote it";
    EXPECT_EQ(error_of([](Json& json) { json["rig_title"] = "another"; }), refused);
    EXPECT_EQ(error_of([](Json& json) { json["tolerance"] = 0.5; }), refused);
    EXPECT_EQ(error_of([](Json& json) { json["frames"][1]["image_sha256"] = "d4"; }), refused);
    EXPECT_EQ(error_of([](Json& json) { json["wavelengths"][1]["weight"][2] = 0.5; }), refused);
    EXPECT_EQ(error_of([](Json& json) { json["more"] = 1; }), refused);
    EXPECT_EQ(error_of([](Json& json) { json.erase("sha256"); }),
              file.string() + ": sha256: found nothing; allowed: a string");
}

// Values in place of a good one, by its place in the file, and what is allowed there.
TEST(Manifest, RefusesValuesThatNoManifestHas) {
    const Json scene{{"file", "f"},
                     {"sha256", "s"},
                     {"materials", Json::array()},
                     {"shortest_path_m", 1.0},
                     {"longest_path_m", 1.0}};
    EXPECT_EQ(error_after([&](Json& json) { json["scene"] = scene; }), kAccepted);
    const Json all = Json::parse(
        read_text_file(fs::path(APHOTIC_SOURCE_DIR) / "tests/spectral/bad_manifest_values.json"));
    ASSERT_EQ(all.size(), 35U);
    for (const Json& each : all) {
        const std::string place = each.at(0);
        for (const Json& value : each.at(1)) {
            const std::string found = error_after([&](Json& json) {
                json["scene"] = scene;
                json[Json::json_pointer(place)] = value;
            });
            // "/wavelengths/1/weight" is "wavelengths[1]: weight".
            std::string where =
                std::regex_replace(place, std::regex("^/(\\w+)/(\\d+)/"), "$1[$2]: ");
            where = std::regex_replace(where, std::regex("^/scene/"), "scene: ");
            if (where.starts_with('/')) where.erase(0, 1);
            EXPECT_EQ(
                found,
                where + ": found " + value.dump() + "; allowed: " + each.at(2).get<std::string>());
        }
    }
}

// Where each was held against all before it, this would take minutes.
TEST(Manifest, MayHaveManyFramesAndWavelengths) {
    constexpr std::size_t kFrames = 200'000;
    Json json = some_json();
    Json frame = json["frames"][1];
    Json wavelength = json["wavelengths"][2];
    frame.erase("name");
    wavelength.erase("frame");
    wavelength.erase("lambda_nm");
    const std::string rest_of_frame = frame.dump().substr(1);
    const std::string rest_of_wavelength = wavelength.dump().substr(1);
    std::string frames;
    std::string wavelengths;
    for (std::size_t f = 0; f < kFrames; ++f) {
        frames += fmt::format(R"({{"name": "band_{}", {},)", f, rest_of_frame);
        wavelengths += fmt::format(
            R"({{"frame": {}, "lambda_nm": {}, {},)", kFrames - 1 - f, f + 1, rest_of_wavelength);
    }
    frames.pop_back();
    wavelengths.pop_back();
    json.erase("frames");
    json.erase("wavelengths");
    std::string text = json.dump();
    text.pop_back();
    const Manifest read = parse_manifest(
        "m",
        fmt::format(R"({}, "frames": [{}], "wavelengths": [{}]}})", text, frames, wavelengths));
    ASSERT_EQ(read.wavelengths.size(), kFrames);
    EXPECT_EQ(read.frames.back().name, "band_199999");
    EXPECT_EQ(read.wavelengths.back().frame, 0U);
}

TEST(Manifest, RefusesValuesWithinValuesWithoutEnd) {
    constexpr std::size_t kDepth = 1'000'000;
    const std::string text =
        "{\"format\": " + std::string(kDepth, '[') + std::string(kDepth, ']') + "}";
    EXPECT_EQ(refusal_of([&] { static_cast<void>(parse_manifest("manifest.json", text)); }),
              "manifest.json: found values nested 1000001 deep; allowed: up to 64");
}

}  // namespace
}  // namespace aphotic::manifest_test
