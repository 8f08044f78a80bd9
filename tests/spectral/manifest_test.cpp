// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/manifest.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "tests/support/temp_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <functional>

namespace aphotic::manifest_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

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
    try {
        static_cast<void>(parse_manifest("manifest.json", json.dump()));
    } catch (const InputError& error) {
        const std::string message = error.what();
        const std::string where = "manifest.json: ";
        return message.starts_with(where) ? message.substr(where.size()) : "elsewhere: " + message;
    }
    return "no error";
}

std::string error_with(const std::string& key, const Json& value) {
    return error_after([&](Json& json) { json[key] = value; });
}

std::string frame_error(const std::string& key, const Json& value) {
    return error_after([&](Json& json) { json["frames"][1][key] = value; });
}

std::string wavelength_error(const std::string& key, const Json& value) {
    return error_after([&](Json& json) { json["wavelengths"][1][key] = value; });
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

TEST(Manifest, ComesBackWhole) {
    const TempFolder folder;
    const Manifest written = some_manifest();
    write_manifest(folder.path(), written);
    const Manifest read = read_manifest(folder.path());
    EXPECT_EQ(read.aphotic_version, written.aphotic_version);
    EXPECT_EQ(read.povray_version, written.povray_version);
    EXPECT_EQ(read.rig_title, written.rig_title);
    EXPECT_EQ(read.rig_sha256, written.rig_sha256);
    EXPECT_EQ(read.width_px, written.width_px);
    EXPECT_EQ(read.height_px, written.height_px);
    EXPECT_EQ(read.lamp_signal, written.lamp_signal);
    ASSERT_TRUE(read.rig_settings);
    EXPECT_EQ(read.rig_settings->keys, written.rig_settings->keys);
    ASSERT_TRUE(read.model);
    EXPECT_EQ(read.model->error, written.model->error);
    EXPECT_EQ(read.method, written.method);
    EXPECT_EQ(read.tolerance, written.tolerance);
    EXPECT_EQ(read.frame_error, written.frame_error);
    EXPECT_EQ(read.geometry, written.geometry);
    ASSERT_EQ(read.strobes.size(), written.strobes.size());
    for (std::size_t s = 0; s < read.strobes.size(); ++s) {
        EXPECT_EQ(read.strobes[s].name, written.strobes[s].name);
        EXPECT_EQ(read.strobes[s].lamps_across, written.strobes[s].lamps_across);
        EXPECT_EQ(read.strobes[s].lamps_along, written.strobes[s].lamps_along);
    }
    for (std::size_t c = 0; c < kChannels; ++c) {
        EXPECT_EQ(read.quality[c].error, written.quality[c].error);
        EXPECT_EQ(read.quality[c].amplification, written.quality[c].amplification);
        EXPECT_EQ(read.promise(c), written.promise(c));
    }
    ASSERT_EQ(read.frames.size(), written.frames.size());
    for (std::size_t f = 0; f < read.frames.size(); ++f) {
        EXPECT_EQ(read.frames[f].name, written.frames[f].name);
        EXPECT_EQ(read.frames[f].scene_sha256, written.frames[f].scene_sha256);
        EXPECT_EQ(read.frames[f].image_sha256, written.frames[f].image_sha256);
    }
    EXPECT_TRUE(read.frames[0].done());
    EXPECT_FALSE(read.frames[1].done());
    ASSERT_EQ(read.wavelengths.size(), written.wavelengths.size());
    for (std::size_t j = 0; j < read.wavelengths.size(); ++j) {
        EXPECT_EQ(read.wavelengths[j].lambda_nm, written.wavelengths[j].lambda_nm);
        EXPECT_EQ(read.wavelengths[j].weight, written.wavelengths[j].weight);
        EXPECT_EQ(read.wavelengths[j].frame, written.wavelengths[j].frame);
        EXPECT_EQ(read.wavelengths[j].channel, written.wavelengths[j].channel);
        EXPECT_EQ(read.wavelengths[j].exposure_log2, written.wavelengths[j].exposure_log2);
        EXPECT_EQ(read.wavelengths[j].radiance_bound, written.wavelengths[j].radiance_bound);
        EXPECT_EQ(read.wavelengths[j].index_nm, written.wavelengths[j].index_nm);
        const SourceLight& light = written.wavelengths[j].light;
        EXPECT_EQ(read.wavelengths[j].light.attenuation_per_m, light.attenuation_per_m);
        EXPECT_EQ(read.wavelengths[j].light.flux, light.flux);
        EXPECT_EQ(read.wavelengths[j].light.reflectance, light.reflectance);
    }
}

TEST(Manifest, ComesBackWithItsScene) {
    const TempFolder folder;
    write_manifest(folder.path(), some_manifest());
    EXPECT_FALSE(read_manifest(folder.path()).scene);
    const Manifest written = of_a_user_scene();
    write_manifest(folder.path(), written);
    const Manifest read = read_manifest(folder.path());
    ASSERT_TRUE(read.scene);
    EXPECT_EQ(read.scene->file, written.scene->file);
    EXPECT_EQ(read.scene->sha256, written.scene->sha256);
    EXPECT_EQ(read.scene->materials, written.scene->materials);
    EXPECT_EQ(read.scene->shortest_path_m, written.scene->shortest_path_m);
    EXPECT_EQ(read.scene->longest_path_m, written.scene->longest_path_m);
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
              "no error");
}

TEST(Manifest, RefusesASceneWithoutPaths) {
    const auto error_of = [](const Json& paths, const Json& materials) {
        return error_after([&](Json& json) {
            json["scene"] = {{"file", "f"}, {"sha256", "s"}, {"materials", materials}};
            json["scene"]["shortest_path_m"] = paths[0];
            json["scene"]["longest_path_m"] = paths[1];
        });
    };
    EXPECT_EQ(error_of({1.0, 1.0}, Json::array()), "no error");
    EXPECT_EQ(error_of({0.0, 1.0}, Json::array()),
              "scene: shortest_path_m: found 0.0; allowed: a number over 0");
    EXPECT_EQ(error_of({2.0, 1.0}, Json::array()),
              "scene: longest_path_m: found 1.0; allowed: a number not under shortest_path_m");
    EXPECT_EQ(error_of({1.0, 2.0}, Json{{"a", 1}}),
              "scene: materials: found {\"a\":1}; allowed: a list of texts");
    EXPECT_EQ(error_with("scene", 7), "scene: found 7; allowed: an object");
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
    try {
        static_cast<void>(read_manifest(folder.path()));
        FAIL() << "no error";
    } catch (const InputError& error) {
        EXPECT_EQ(error.what(),
                  (folder.path() / "manifest.json").string() +
                      ": cannot be read: No such file or directory");
    }
}

TEST(Manifest, ThatIsNoJsonIsRefused) {
    for (const std::string text : {"", "{", "{\"format\":", "{\"width_px\": 1e999}"}) {
        const TempFolder folder;
        write_file(folder.path() / "manifest.json", text);
        try {
            static_cast<void>(read_manifest(folder.path()));
            FAIL() << "no error for " << text;
        } catch (const InputError& error) {
            EXPECT_EQ(error.what(), (folder.path() / "manifest.json").string() + ": is not JSON");
        }
    }
    EXPECT_EQ(error_after([](Json& json) { json = Json::array(); }),
              "value: found []; allowed: an object");
}

TEST(Manifest, NamesEachKeyThatIsMissing) {
    EXPECT_EQ(error_after([](Json&) {}), "no error");
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
        try {
            static_cast<void>(read_manifest(folder.path()));
        } catch (const InputError& error) {
            return error.what();
        }
        return "no error";
    };
    EXPECT_EQ(error_of([](Json&) {}), "no error") << "laid out anew";
    const std::string refused = file.string() +
                                ": sha256: is not that of the rest, which was changed since it was "
                                "written; allowed: a manifest as aphotic wrote it";
    EXPECT_EQ(error_of([](Json& json) { json["rig_title"] = "another"; }), refused);
    EXPECT_EQ(error_of([](Json& json) { json["tolerance"] = 0.5; }), refused);
    EXPECT_EQ(error_of([](Json& json) { json["frames"][1]["image_sha256"] = "d4"; }), refused);
    EXPECT_EQ(error_of([](Json& json) { json["wavelengths"][1]["weight"][2] = 0.5; }), refused);
    EXPECT_EQ(error_of([](Json& json) { json["more"] = 1; }), refused);
    EXPECT_EQ(error_of([](Json& json) { json.erase("sha256"); }),
              file.string() + ": sha256: found nothing; allowed: a text");
}

TEST(Manifest, OfAnotherFormatIsRefused) {
    EXPECT_EQ(error_with("format", "aphotic-manifest-4"),
              "format: found \"aphotic-manifest-4\"; allowed: \"aphotic-manifest-5\", which this "
              "version writes: render again, into another folder");
}

TEST(Manifest, NamesEachKeyOfTheWrongType) {
    for (const std::string key :
         {"format", "aphotic_version", "povray_version", "rig_title", "rig_sha256", "method"}) {
        EXPECT_EQ(error_with(key, 7), key + ": found 7; allowed: a text");
    }
    for (const std::string key : {"width_px", "height_px"}) {
        const std::string allowed = "; allowed: a whole number from 1 to 16384";
        for (const Json& value : {Json("7"), Json(7.5), Json(0), Json(16385), Json(true)}) {
            EXPECT_EQ(error_with(key, value), key + ": found " + value.dump() + allowed);
        }
    }
    for (const Json& value :
         {Json(1.0), Json({1, 2}), Json({1, 2, 3, 4}), Json({1, 2, "3"}), Json({1, 2, nullptr})}) {
        EXPECT_EQ(error_with("lamp_signal", value),
                  "lamp_signal: found " + value.dump() + "; allowed: three numbers");
        EXPECT_EQ(wavelength_error("weight", value),
                  "wavelengths[1]: weight: found " + value.dump() + "; allowed: three numbers");
    }
    for (const std::string key : {"flux", "reflectance"}) {
        EXPECT_EQ(wavelength_error(key, 7),
                  "wavelengths[1]: " + key + ": found 7; allowed: a list of numbers");
    }
    EXPECT_EQ(error_with("geometry", Json{{"sled", 2}}),
              "geometry: found {\"sled\":2}; allowed: an object of texts");
    for (const std::string key : {"quality", "strobes", "frames", "wavelengths"}) {
        EXPECT_EQ(error_with(key, 7), key + ": found 7; allowed: a list of objects");
        EXPECT_EQ(error_with(key, Json::array({7})),
                  key + "[0]: value: found 7; allowed: an object");
    }
}

TEST(Manifest, WithoutWavelengthsIsRefused) {
    EXPECT_EQ(error_with("wavelengths", Json::array()),
              "wavelengths: found []; allowed: at least one");
}

// A name becomes part of a path.
TEST(Manifest, RefusesFrameNamesThatLeadElsewhere) {
    for (const std::string name :
         {"../frame", "..", "a/b", "/etc", "a\\b", "", ".hidden", "a b", "a\n", "\xC3\xA4"}) {
        EXPECT_EQ(frame_error("name", name),
                  "frames[1]: name: found " + Json(name).dump() +
                      "; allowed: letters, digits, '_', '-' and '.', not first");
    }
}

TEST(Manifest, WantsTheQualityOfEachChannel) {
    const Json quality{{"error", 0.0}, {"amplification", 1.0}};
    EXPECT_EQ(error_with("quality", Json::array({quality, quality, quality})), "no error");
    EXPECT_EQ(error_with("quality", Json::array({quality})),
              "quality: found [{\"amplification\":1.0,\"error\":0.0}]; allowed: 3 objects");
}

// As many as a scene may hold, and one at least.
TEST(Manifest, WantsAStrobesLampsInNumbersThatAScenesMayHave) {
    for (const Json& value : {Json(0), Json(-1), Json(2.5), Json("5"), Json(100001)}) {
        EXPECT_EQ(error_after([&](Json& json) { json["strobes"][0]["lamps_along"] = value; }),
                  "strobes[0]: lamps_along: found " + value.dump() +
                      "; allowed: a whole number from 1 to 100000");
    }
}

TEST(Manifest, WantsIncreasingWavelengths) {
    const std::string allowed = "; allowed: increasing wavelengths over 0";
    EXPECT_EQ(wavelength_error("lambda_nm", 450.0),
              "wavelengths[1]: lambda_nm: found 450.0" + allowed);
    EXPECT_EQ(wavelength_error("lambda_nm", -5), "wavelengths[1]: lambda_nm: found -5" + allowed);
    EXPECT_EQ(wavelength_error("lambda_nm", "550"),
              "wavelengths[1]: lambda_nm: found \"550\"; allowed: a number");
    EXPECT_EQ(error_after([](Json& json) { json["wavelengths"][0]["lambda_nm"] = 0; }),
              "wavelengths[0]: lambda_nm: found 0" + allowed);
}

TEST(Manifest, WantsWavelengthsInAKnownFrameAndChannel) {
    EXPECT_EQ(wavelength_error("channel", "A"),
              "wavelengths[1]: channel: found \"A\"; allowed: one of R, G, B");
    for (const Json& value : {Json(2), Json(-1), Json("band_450_550nm")}) {
        EXPECT_EQ(wavelength_error("frame", value),
                  "wavelengths[1]: frame: found " + value.dump() +
                      "; allowed: a whole number from 0 to 1");
    }
}

TEST(Manifest, WantsEachFrameAndEachOfItsChannelsOnce) {
    EXPECT_EQ(frame_error("name", "band_450_550nm"),
              "frames[1]: name: found \"band_450_550nm\"; allowed: a name that no other frame has");
    EXPECT_EQ(wavelength_error("channel", "R"),
              "wavelengths[1]: channel: found \"R\"; allowed: a channel of the frame that no other "
              "wavelength has");
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
    try {
        static_cast<void>(parse_manifest("manifest.json", text));
        FAIL() << "no error";
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(),
                     "manifest.json: found values nested in 1000001 levels; allowed: up to 64");
    }
}

TEST(Manifest, WantsExposuresThatADoubleCanHold) {
    const std::string allowed = "; allowed: a whole number from -1000 to 1000";
    for (const Json& value : {Json(1001), Json(-1001), Json(0.5), Json("1"), Json(1e300)}) {
        EXPECT_EQ(wavelength_error("exposure_log2", value),
                  "wavelengths[1]: exposure_log2: found " + value.dump() + allowed);
    }
}

TEST(Manifest, WantsBoundsOfLightThatLightCanHave) {
    EXPECT_EQ(wavelength_error("radiance_bound", -1e-9),
              "wavelengths[1]: radiance_bound: found -1e-09; allowed: 0 or more");
}

}  // namespace
}  // namespace aphotic::manifest_test
