// SPDX-License-Identifier: BSD-3-Clause
//
// The correction of surveys as a user runs it. The images are made of the reference tracer's light,
// which shares no geometry and no light with the maps that they are divided by.
#include "support/abandoned_file.h"
#include "survey/light_at.h"

#include "base/sha256.h"
#include "image/exr.h"
#include "image/preview.h"
#include "lightmap/cone_edge.h"
#include "rig/file/rig_reader.h"
#include "support/absurd_images.h"
#include "support/command_test.h"
#include "support/exr_file.h"
#include "support/has.h"
#include "support/png.h"
#include "support/scene_text.h"
#include "support/tiff.h"
#include "validation/tracer.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <regex>
#include <sstream>
#include <thread>

namespace aphotic::correct_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr int kWidth = 48;
constexpr int kHeight = 36;
constexpr std::size_t kPixels = kWidth * kHeight;
constexpr double kDegree = std::numbers::pi / 180.0;

constexpr double kBlackLevel = 60.0;
constexpr double kWhiteLevel = 4095.0;
// The maps' stated error and the tracer's, with room.
constexpr double kMapError = 1e-4;

// A patch of the floor that reflects half as much again as the rest.
constexpr double kPatch = 1.5;
bool is_patch(std::size_t pixel) {
    const auto column = static_cast<int>(pixel) % kWidth;
    const auto row = static_cast<int>(pixel) / kWidth;
    return column >= 12 && column < 20 && row >= 10 && row < 18;
}

const Arguments kCorrect(
    "correct raw --rig rig.toml --nav nav.eic --bayer GRBG --black-level 60 --white-level 4095");

class CorrectCommand : public CommandTest {
  protected:
    void SetUp() override {
        // The same view in fewer pixels.
        write_file(path("rig.toml"),
                   with(scene_text("habcam.toml"),
                        {{"resolution", "[48, 36]"}, {"pixel_pitch_um", "182.75"}}));
        fs::create_directories(path("raw"));
    }

    [[nodiscard]] Rig rig_at(const Sled& sled) const {
        Rig rig = read_rig(path("rig.toml"));
        rig.sled = sled;
        return rig;
    }

    // What the camera records over its black level: planes R, G, B. The first image sets the
    // exposure, such that the patch reaches `peak` at most.
    [[nodiscard]] std::vector<double> seen(const Sled& sled, double peak) const {
        const Tracer tracer(rig_at(sled), {.signals = true, .planes_nm = {}, .threads = 1});
        std::vector<double> numbers = tracer.rows(0, kHeight);
        if (exposure_ == 0.0) exposure_ = peak / kPatch / std::ranges::max(numbers);
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            numbers[i] *= exposure_ * (has_patch_ && is_patch(i % kPixels) ? kPatch : 1.0);
        }
        return numbers;
    }

    // The mosaic of 12 bits in a 16-bit file, and its line of navigation.
    void take(const std::string& name, const Sled& sled) {
        constexpr double kPeak = 3900.0;
        const std::vector<double> planes = seen(sled, kPeak);
        std::vector<std::uint16_t> mosaic;
        for (std::size_t i = 0; i < kPixels; ++i) {
            const int channel = channel_at(
                Mosaic::Grbg, static_cast<int>(i) % kWidth, static_cast<int>(i) / kWidth);
            const double number =
                kBlackLevel + planes[static_cast<std::size_t>(channel) * kPixels + i];
            mosaic.push_back(
                static_cast<std::uint16_t>(std::lround(std::min(number, kWhiteLevel))));
        }
        write_file(path("raw/" + name), tiff_of(mosaic, kWidth, kHeight, "lat=41.5,lon=-70.6"));
        note(name, sled);
    }

    void note(const std::string& name, const Sled& sled) {
        lines_ += fmt::format("{} {} {} {}\n",
                              name,
                              sled.altitude_m,
                              sled.pitch_rad / kDegree,
                              sled.roll_rad / kDegree);
        write_file(path("nav.eic"), lines_);
    }

    // The lowest first, for it is the brightest and sets the exposure.
    std::vector<Sled> take_survey() {
        const std::vector<Sled> sleds{{1.7, 5.0 * kDegree, 0.0},
                                      {2.0, -3.0 * kDegree, 4.0 * kDegree},
                                      {2.3, 0.0, 0.0},
                                      {2.6, 7.0 * kDegree, -6.0 * kDegree}};
        for (std::size_t i = 0; i < sleds.size(); ++i) take(fmt::format("{}.tif", i), sleds[i]);
        return sleds;
    }

    // One of them level, which tells nothing of its angles.
    void take_dive() {
        constexpr int kImages = 14;
        for (int i = 0; i < kImages; ++i) {
            take(fmt::format("{:02}.tif", i),
                 {1.5 + 0.1 * i, (i % 5 - 1) * 2.0 * kDegree, (i % 3 - 1) * 3.0 * kDegree});
        }
    }

    static Arguments correct(const Arguments& more, const std::string& output = "out") {
        Arguments arguments = kCorrect + ("-o " + output);
        // In place of the same option here.
        for (const std::string& option : more) {
            if (!option.starts_with("--")) continue;
            const auto same = std::ranges::find(arguments, option);
            if (same != arguments.end()) arguments.erase(same, same + 2);
        }
        return arguments + more;
    }

    // Of images that are skipped, the reasons.
    static std::map<std::string, std::string> skipped(const Json& summary) {
        std::map<std::string, std::string> why;
        for (const Json& one : summary["skipped"]) why[one["image"]] = one["why"];
        EXPECT_EQ(why.size(), summary["skipped"].size()) << "each once";
        return why;
    }

    bool has_patch_ = true;
    mutable double exposure_ = 0.0;
    std::string lines_;
};

// The floor comes out as the rig's floor at every altitude and attitude, the patch as half as much
// again, up to half a step of the camera's whole numbers there.
TEST_F(CorrectCommand, AFloorIsEvenAndOneColourOverAltitudeAndAttitude) {
    const std::vector<Sled> sleds = take_survey();
    const Json summary = json_by(correct("--format exr --keep-mosaic --mask --edge-px 1 --json"));
    EXPECT_EQ(summary["corrected"], sleds.size());
    EXPECT_EQ(summary["gain_from"].size(), sleds.size());
    const PerChannel floor = floor_colour(rig_at(sleds[0]));
    for (std::size_t i = 0; i < sleds.size(); ++i) {
        const std::string name = std::to_string(i);
        const std::vector<float> found = read_exr(path("out/" + name + ".exr"), {"Y"});
        const DecodedPng mask = decode_png(text_of("out/" + name + ".mask.png"));
        const std::vector<double> numbers = seen(sleds[i], 0.0);
        const std::vector<std::uint8_t> edges = ConeEdges(rig_at(sleds[i])).mask(sleds[i], 1);
        std::size_t good = 0;
        for (std::size_t p = 0; p < kPixels; ++p) {
            EXPECT_EQ((mask.pixels[p] & kEdge) != 0, edges[p] != 0) << p;
            if ((mask.pixels[p] & 0xFFU) != 0) continue;
            const auto c = static_cast<std::size_t>(channel_at(
                Mosaic::Grbg, static_cast<int>(p) % kWidth, static_cast<int>(p) / kWidth));
            const double wanted = floor[c] * (is_patch(p) ? kPatch : 1.0);
            // The gain's own images were whole numbers too: half a step of some hundreds.
            constexpr double kGainError = 2e-3;
            const double rounding = 0.5 / numbers[c * kPixels + p];
            EXPECT_NEAR(found[p] / wanted, 1.0, rounding + kGainError + kMapError)
                << name << ": " << p;
            ++good;
        }
        EXPECT_GT(good, kPixels / 2) << name;
    }
}

// How much light the middle has is not known of a gain by itself, so noise holds nothing then.
TEST_F(CorrectCommand, AGainByItselfLeavesTheDarkToItsShare) {
    take("a.tif", {2.0, 5.0 * kDegree, 0.0});
    const auto dark_share = [&](const Arguments& more, const std::string& output) -> double {
        return json_by(correct("--format exr --json" + more, output))["doubtful"]["dark"];
    };
    EXPECT_EQ(dark_share("--gain 1", "one"), 0.0);
    EXPECT_GT(dark_share("--gain 1 --least-light 0.5", "half"), 0.0);
}

TEST_F(CorrectCommand, TiffOfSixteenBitsHasThreeChannelsAndTheSourcesWords) {
    take("a.tif", {2.0, 5.0 * kDegree, 0.0});
    done(correct({}));
    done(correct("--format exr", "exact"));
    // 1/65536 of white; the floor is 0.1 and more.
    constexpr const char* kStep = "1e-4";
    done({"compare", "out/a.tif", "exact/a.exr", "--bound", kStep, "--black", "0.5"}, " B ");
    EXPECT_TRUE(has(text_of("out/a.tif"), "lat=41.5,lon=-70.6"));
    EXPECT_EQ(ExrReader(path("exact/a.exr")).attribute("comments"), "lat=41.5,lon=-70.6");
    done(correct("--format png", "png"));
    EXPECT_EQ(decode_png(text_of("png/a.png")).width, kWidth);
}

// The same pixels, in a file as large as they are, or smaller.
TEST_F(CorrectCommand, EveryCompressionIsLossless) {
    take("a.tif", {2.0, 5.0 * kDegree, 0.0});
    const auto file_of = [&](const std::string& name, const Arguments& compression) {
        const std::string format = name.substr(2) == "tif" ? "tiff" : name.substr(2);
        const std::string folder = format + (compression.empty() ? "" : "-" + compression.back());
        done(correct(fmt::format("--format {}", format) + compression, folder));
        return folder + "/" + name;
    };
    const auto expect_smaller = [&](const std::string& file, const std::string& plain) {
        EXPECT_LT(fs::file_size(path(file)), fs::file_size(path(plain))) << file;
        done(fmt::format("compare {} {} --bound 0", plain, file));
    };
    for (const char* name : {"a.tif", "a.png", "a.exr"}) {
        const std::string plain = file_of(name, "--compression none");
        const std::uintmax_t sample_bytes = std::string(name) == "a.exr" ? 4 : 2;
        EXPECT_GE(fs::file_size(path(plain)), kChannels * kPixels * sample_bytes) << name;
        expect_smaller(file_of(name, {}), plain);
    }
    expect_smaller(file_of("a.tif", "--compression small"), "tiff-none/a.tif");
}

TEST_F(CorrectCommand, PngOfRgbAndExrOfFloatsAreRead) {
    const Sled sled{2.0, 5.0 * kDegree, 0.0};
    constexpr double kPeak = 250.0;
    const std::vector<double> planes = seen(sled, kPeak);
    std::vector<std::uint32_t> pixels;
    for (std::size_t p = 0; p < kPixels; ++p) {
        const auto byte = [&](std::size_t c) {
            return static_cast<std::uint32_t>(std::lround(planes[c * kPixels + p]));
        };
        pixels.push_back(byte(0) << 16U | byte(1) << 8U | byte(2));
    }
    write_file(path("raw/a.png"), png_of(pixels, kWidth, kHeight));
    write_exr(path("raw/b.exr"), kWidth, std::vector<float>(planes.begin(), planes.end()));
    note("a.png", sled);
    note("b.exr", sled);
    done("correct raw --rig rig.toml --nav nav.eic -o out --format exr --gain " +
         fmt::format("{:.17g}", 1.0 / exposure_));
    const std::vector<float> a = read_exr(path("out/a.exr"));
    const std::vector<float> b = read_exr(path("out/b.exr"));
    const std::vector<std::uint8_t> edges = ConeEdges(rig_at(sled)).mask(sled, 1);
    std::size_t good = 0;
    for (std::size_t i = 0; i < b.size(); ++i) {
        if (edges[i % kPixels] != 0) continue;
        const double wanted = is_patch(i % kPixels) ? kPatch : 1.0;
        EXPECT_NEAR(b[i], wanted, kMapError * wanted) << i;
        EXPECT_NEAR(a[i] / wanted, 1.0, 0.5 / planes[i] + kMapError) << i;
        ++good;
    }
    EXPECT_GT(good, kPixels);
}

TEST_F(CorrectCommand, BadImagesAreSaidSkippedAndListedAndTheOthersDone) {
    take_survey();
    const std::string whole = text_of("raw/0.tif");
    write_file(path("raw/cut.tif"), whole.substr(0, whole.size() / 2));
    const std::vector<std::uint16_t> grey(kPixels, 1000);
    const std::string short_of_rows = tiff_of(grey, kWidth, kHeight, "", true);
    write_file(path("raw/rows.tif"), short_of_rows.substr(0, short_of_rows.size() / 2));
    const std::string packed = tiff_of(grey, kWidth, kHeight, "", true, true);
    write_file(path("raw/packed.tif"), packed.substr(0, packed.size() / 2));
    write_file(path("raw/words.png"), "this is no image");
    write_file(path("raw/small.tif"), tiff_of({1, 2, 3, 4}, 2, 2, ""));
    write_file(path("raw/unknown.tif"), whole);
    write_file(path("raw/low.tif"), whole);
    write_file(path("raw/notes.txt"), "no image by its name: not taken up");
    for (const char* name : {"cut.tif", "rows.tif", "packed.tif", "words.png", "small.tif"})
        note(name, {2.0, 0.0, 0.0});
    note("low.tif", {0.0, 0.0, 0.0});
    const CommandResult run = done(correct("--json"), "", kAnswerIsNo);
    const Json summary = Json::parse(run.out);
    EXPECT_EQ(summary["corrected"], 4);
    auto why = skipped(summary);
    EXPECT_EQ(why.size(), 7U) << summary.dump(2);
    for (const char* name : {"raw/rows.tif", "raw/packed.tif"})
        EXPECT_TRUE(has(why[name], "it is truncated"));
    EXPECT_TRUE(has(why["raw/cut.tif"], "cannot be read"));
    EXPECT_TRUE(has(why["raw/words.png"], "cannot be read"));
    EXPECT_EQ(why["raw/small.tif"], "found 2 x 2 pixels; allowed: 48 x 36, like the map");
    EXPECT_EQ(why["raw/unknown.tif"], "nav.eic has no line for it");
    EXPECT_EQ(why["raw/low.tif"], "nav.eic:10: altitude_m: found 0; allowed: 0.001 to 10000");
    for (const auto& [image, reason] : why) {
        EXPECT_TRUE(has(run.err, "aphotic: " + image + ": " + reason + "; skipped"));
    }
    EXPECT_EQ(json_in("out/correction.json"), summary);
    const auto files = files_in("out");
    EXPECT_EQ(files.size(), 4U + 2U);  // the images, and the two that say what was done
}

// A fifth of the images cannot be read.
TEST_F(CorrectCommand, EndsWellWhenNoMoreAreSkippedThanAllowed) {
    take_survey();
    write_file(path("raw/words.tif"), "this is no image");
    note("words.tif", {2.0, 0.0, 0.0});
    struct Case {
        Arguments option;
        int status;
        int allowed;
    };
    for (const Case& one : std::vector<Case>{{{}, kAnswerIsNo, 0},
                                             {"--allow-skipped 0", kAnswerIsNo, 0},
                                             {"--allow-skipped 1", 0, 1},
                                             {"--allow-skipped 3", 0, 3},
                                             {"--allow-skipped 0.19", kAnswerIsNo, 0},
                                             {"--allow-skipped 0.2", 0, 1},
                                             {"--allow-skipped 20%", 0, 1}}) {
        const CommandResult run = aphotic(correct(one.option));
        const std::string about = testing::PrintToString(one.option);
        EXPECT_EQ(run.status, one.status) << about << run.err;
        const std::string said = fmt::format(
            "aphotic: 1 of 5 images skipped; allowed: {} (--allow-skipped)\n", one.allowed);
        EXPECT_TRUE(has(run.err, said)) << about;
    }
    for (const std::string wrong : {"-1", "some", "1.5", "101%", "", "3 images", "nan", "%"}) {
        refused(correct({"--allow-skipped", wrong}),
                "--allow-skipped: found '" + wrong +
                    "'; allowed: a number of images, or a share such as 0.01 or 1%");
    }
}

// The same floor in another dive, at half the exposure: by one gain it is half as bright.
TEST_F(CorrectCommand, TheGainOfAnotherDiveKeepsBothOnOneScale) {
    const std::vector<Sled> sleds = take_survey();
    done(correct("--format exr", "one"));
    fs::rename(path("raw"), path("raw-one"));
    fs::create_directories(path("raw"));
    exposure_ /= 2.0;
    take("second.tif", sleds[0]);
    done(correct("--format exr --gain-from one --strict", "two"), ", that of one");
    const auto notes = [&](const std::string& folder) {
        return json_in(folder + "/correction.json");
    };
    EXPECT_EQ(notes("two")["gain"], notes("one")["gain"]);
    EXPECT_EQ(notes("two")["settings"]["middle"], notes("one")["settings"]["middle"]);
    EXPECT_EQ(notes("two")["gain_folder"], "one");
    const std::vector<float> one = read_exr(path("one/0.exr"));
    const std::vector<float> two = read_exr(path("two/second.exr"));
    const std::size_t middle = kPixels / 2 + kWidth / 2;
    for (std::size_t c = 0; c < kChannels; ++c) {
        const std::size_t i = c * kPixels + middle;
        const double rounding = 2.0 / (seen(sleds[0], 0.0)[i]);  // half a number, of both
        EXPECT_NEAR(two[i] / one[i], 0.5, rounding) << c;
    }

    // Another rig is told of, with --strict refused; another camera is refused.
    const std::string rig = text_of("rig.toml");
    write_file(path("rig.toml"), rig + "# of the second dive\n");
    EXPECT_TRUE(has(done(correct("--gain-from one", "three")).err,
                    "looks wrong: gain-from: one: made with a different rig"));
    EXPECT_EQ(notes("three")["looks_wrong"][0]["about"], "gain-from");
    EXPECT_EQ(aphotic(correct("--gain-from one --strict", "three")).status, kBadInput);
    write_file(path("rig.toml"), rig);
    const CommandResult levels = aphotic(correct("--gain-from one --black-level 1", "levels"));
    EXPECT_TRUE(has(levels.err, "looks wrong: gain-from: one: the black_level there is "));
    EXPECT_TRUE(has(levels.err, ", here 1.0"));
    write_file(path("camera.csv"),
               "wavelength_nm,red,green,blue\n380,0.1,0.2,0.4\n780,0.3,0.2,0.1\n");
    write_file(path("rig.toml"),
               with(rig, {{"response", R"({ table = "camera.csv", kind = "energy" })"}}));
    refused(correct("--gain-from one", "four"),
            "--gain-from: one: the rig there has a camera with another response; allowed: results "
            "of the same camera");
    write_file(path("rig.toml"), rig);
    for (const char* folder : {"no-gain", "no-json"}) fs::create_directories(path(folder));
    write_file(path("no-gain/correction.json"), R"({"gain": [1, 0, 1]})");
    write_file(path("no-json/correction.json"), "no notes");
    for (const auto& [options, why] :
         Cases{{"raw",
                "--gain-from: raw: contains no correction.json; allowed: a folder that `correct` "
                "wrote"},
               {"no-gain",
                "--gain-from: no-gain: correction.json: contains no gain; allowed: as `correct` "
                "wrote it"},
               {"no-json", "--gain-from: no-json: correction.json: not valid JSON"},
               {"one --gain 2", "--gain"},
               {"one --middle 0.2", "--middle"}})
        refused(correct("--gain-from" + options, "four"), why);
}

// By the standard's formula from the linear result, the matrix and the exposure that are noted.
TEST_F(CorrectCommand, SrgbIsTheLinearImageByMatrixExposureAndCurve) {
    take_survey();
    const Json srgb =
        json_by(correct("--encode srgb --format png --bits 16 --json", "png")).at("srgb");
    done(correct("--format exr", "exr"));
    EXPECT_GT(srgb["mean_delta_e"].get<double>(), 0.0);
    EXPECT_LT(srgb["largest_delta_e"].get<double>(), 20.0);
    const PerChannel floor = floor_colour(rig_at({2.0, 0.0, 0.0}));
    // By numpy: int rho E Q over int E Q of the sand, after 4 m of water over that before.
    const PerChannel balance = srgb["balance"].get<PerChannel>();
    const PerChannel numpy{0.955466, 0.982269, 0.99454};
    for (std::size_t c = 0; c < kChannels; ++c) EXPECT_NEAR(balance[c], numpy[c], 1e-4) << c;
    const std::array<double, kChannels> luminance{0.2126, 0.7152, 0.0722};
    double middle = 0.0;
    for (std::size_t row = 0; row < kChannels; ++row) {
        double sum = 0.0;
        for (std::size_t c = 0; c < kChannels; ++c) {
            sum += srgb["matrix"][row][c].get<double>();
            middle += luminance[row] * srgb["matrix"][row][c].get<double>() * balance[c] * floor[c];
        }
        EXPECT_NEAR(sum, 1.0, 1e-12) << "grey stays grey";
    }
    const double exposure = srgb["exposure"].get<double>();
    EXPECT_NEAR(exposure, 0.2 / middle, 1e-9);
    const std::vector<float> linear = read_exr(path("exr/0.exr"));
    const DecodedPng shown = decode_png(text_of("png/srgb/0.png"));
    ASSERT_EQ(shown.width, kWidth);
    for (std::size_t p = 0; p < kPixels; ++p) {
        for (std::size_t row = 0; row < kChannels; ++row) {
            double value = 0.0;
            for (std::size_t c = 0; c < kChannels; ++c) {
                value += exposure * srgb["matrix"][row][c].get<double>() * balance[c] *
                         linear[c * kPixels + p];
            }
            value = std::clamp(value, 0.0, 1.0);
            const double curve =
                value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1.0 / 2.4) - 0.055;
            // Rounded to 16 bits, of which the decoder keeps the upper 8.
            const auto byte = static_cast<double>(shown.pixels[p] >> (16 - 8 * row) & 0xFFU);
            EXPECT_NEAR(byte, std::floor(curve * 65535.0 / 256.0), 1.0) << p;
        }
    }
}

// A JPEG by default, beside the linear TIFF, and it says what it is.
TEST_F(CorrectCommand, SrgbFilesSayThatTheyAreSrgb) {
    take("a.tif", {2.0, 5.0 * kDegree, 0.0});
    const auto made = [&](const Arguments& format, const std::string& folder) {
        done(correct("--encode srgb" + format, folder), "sRGB in " + folder + "/srgb: exposure ");
        return files_in(folder);
    };
    EXPECT_TRUE(made({}, "jpeg").contains("srgb/a.jpg"));
    EXPECT_TRUE(fs::exists(path("jpeg/a.tif")));
    auto named = made("--format jpeg", "named");
    for (const char* file : {"a.tif", "srgb/a.jpg"}) {
        EXPECT_TRUE(named[file] == files_in("jpeg")[file]) << file;
    }
    EXPECT_TRUE(made("--format png", "png").contains("srgb/a.png"));
    EXPECT_TRUE(made("--format tiff", "tiff").contains("srgb/a.tif"));
    EXPECT_TRUE(made("--format exr", "exr").contains("srgb/a.jpg"));
    EXPECT_LT(made("--quality 40", "small").at("srgb/a.jpg").size(),
              files_in("jpeg").at("srgb/a.jpg").size());
    // JPEG blurs colours over 2 x 2 pixels: at the patch's rim by up to half of its own
    // step, 1.5-fold and some 1.2-fold once encoded.
    done("compare jpeg/srgb/a.jpg png/srgb/a.png --bound 0.2 --black 0.5");
    done("compare tiff/srgb/a.tif png/srgb/a.png --bound 0");

    // Exif's ColorSpace, tag 0xA001, one short number, is 1 for sRGB; in either order of bytes. A
    // PNG has a chunk of that name.
    const auto is_tagged = [](const std::string& file) {
        const std::string little("\x01\xA0\x03\0\x01\0\0\0\x01\0", 10);
        const std::string big("\xA0\x01\0\x03\0\0\0\x01\0\x01", 10);
        return file.find(little) != std::string::npos || file.find(big) != std::string::npos;
    };
    const std::string jpeg = files_in("jpeg").at("srgb/a.jpg");
    EXPECT_TRUE(is_tagged(jpeg));
    EXPECT_TRUE(is_tagged(files_in("tiff").at("srgb/a.tif")));
    EXPECT_FALSE(is_tagged(files_in("tiff").at("a.tif")));
    EXPECT_TRUE(has(files_in("png").at("srgb/a.png"), "sRGB"));
    EXPECT_FALSE(has(files_in("png").at("a.png"), "sRGB"));

    // Repeated, all is kept; without its JPEG, an image is made again.
    const auto again = [&] {
        return json_by(correct("--encode srgb --json", "jpeg"))["kept"].get<int>();
    };
    EXPECT_EQ(again(), 1);
    fs::remove(path("jpeg/srgb/a.jpg"));
    EXPECT_EQ(again(), 0);
    EXPECT_EQ(files_in("jpeg").at("srgb/a.jpg"), jpeg);

    // Brighter by a stop.
    const auto exposure = [&](const std::string& folder) {
        return json_in(folder + "/correction.json")["srgb"]["exposure"].get<double>();
    };
    made("--stops 1", "bright");
    EXPECT_NEAR(exposure("bright") / exposure("jpeg"), 2.0, 1e-12);
}

TEST_F(CorrectCommand, WhatCannotBeEncodedIsRefused) {
    take("a.tif", {2.0, 5.0 * kDegree, 0.0});
    fs::create_directories(path("raw/srgb"));
    fs::copy(path("raw/a.tif"), path("raw/srgb/a.tif"));
    for (const auto& [options, why] : Cases{
             {"--format jpeg",
              "--format: found jpeg, which holds no linear image; allowed: tiff, png, exr, or jpeg "
              "with --encode srgb"},
             {"--quality 90", "--quality: found linear images; allowed: with --encode srgb"},
             {"--encode srgb --bits 16",
              "--bits: found 16 of jpeg; allowed: 8, or --format png or tiff"},
             {"--encode srgb --bits 12", "--bits"},
             {"--encode srgb --quality 101", "--quality: found 101; allowed: 1 to 100"},
             {"--encode srgb --format png --quality 90",
              "--quality: found 90 of png; allowed: with --format jpeg"},
             {"--encode srgb --stops nan", "--stops: found nan; allowed: a number"},
             {"--encode adobe", "--encode: adobe not in {linear,srgb}"},
             {"--encode srgb --format tiff",
              "raw/a.tif and raw/srgb/a.tif would both become out/srgb/a.tif"}})
        refused(correct(options), why);
}

// 2 may have been 2.55; the images cannot tell, but whoever copied the file can.
TEST_F(CorrectCommand, ACutNavigationIsWarnedOf) {
    take("a.tif", {2.0, 0.0, 0.0});
    write_file(path("nav.eic"), "image,pitch_deg,roll_deg,altitude_m\na.tif,0,0,2");
    EXPECT_TRUE(has(done(correct({})).err,
                    "looks wrong: navigation: nav.eic:2: the file ends within this line"));
    refused(correct("--strict"), "navigation: nav.eic:2");
}

// Numbers that the images contradict: a warning, with --strict an error, and no gain that outlives
// them.
TEST_F(CorrectCommand, WhatLooksWrongIsToldAndByStrictAnEnd) {
    has_patch_ = false;
    take_dive();
    const std::string right = lines_;
    const auto told = [&](const std::string& navigation, const Arguments& more) {
        write_file(path("nav.eic"), navigation);
        const CommandResult run = done(correct(more));
        std::string about;
        const Json notes = json_in("out/correction.json");
        for (const Json& one : notes["looks_wrong"]) {
            about += one["about"];
            EXPECT_TRUE(has(run.err,
                            "aphotic: looks wrong: " + one["about"].get<std::string>() + ": " +
                                one["what"].get<std::string>()));
        }
        return about;
    };
    const auto changed = [&](double altitude_m, double tilt) {
        std::string lines;
        std::istringstream all(right);
        std::string name;
        for (double h = 0, pitch = 0, roll = 0; all >> name >> h >> pitch >> roll;) {
            lines += fmt::format("{} {} {} {}\n", name, h + altitude_m, tilt * pitch, tilt * roll);
        }
        return lines;
    };
    const std::string high = changed(50.0, 1.0);
    write_file(path("nav.eic"), high);
    refused(correct("--strict"), "--strict: suspicious survey: altitude: ");

    EXPECT_EQ(told(high, {}), "altitude");
    EXPECT_EQ(told(right, "--strict"), "") << "the gain is taken anew";

    // Given again, with a gain that is kept.
    const std::string notes = text_of("out/correction.json");
    write_file(path("nav.eic"), high);
    EXPECT_EQ(aphotic(correct("--strict")).status, kBadInput);
    EXPECT_EQ(text_of("out/correction.json"), notes);
    EXPECT_EQ(told(high, {}), "altitude");
    EXPECT_EQ(told(high, "--gain-images 3"), "altitude");
    EXPECT_EQ(told(changed(0.0, kDegree), "--middle 0.3"), "attitude");
    EXPECT_EQ(told(right, "--bayer RGGB"), "bayer");
    EXPECT_EQ(told(right, "--gain 1 --bayer GBRG"), "bayer");
    has_patch_ = true;
    // The lowest image set the exposure: nearer still, the patch is saturated.
    take("low.tif", {1.2, 0.0, 0.0});
    EXPECT_EQ(told(lines_, "--strict"), "");
    EXPECT_EQ(told(lines_, "--white-level 65535"), "white-level");
}

// No floor has the same patch in each image: it is the light's.
TEST_F(CorrectCommand, WhatStaysInPlaceIsTheLights) {
    take_dive();
    const CommandResult run = done(correct("--report"));
    const Json notes = json_in("out/correction.json");
    ASSERT_EQ(notes["looks_wrong"].size(), 1U);
    EXPECT_EQ(notes["looks_wrong"][0]["about"], "pattern");
    EXPECT_EQ(notes["pattern"]["images"], 14);
    EXPECT_TRUE(has(run.out, "  a fixed pattern of "));
    EXPECT_TRUE(has(text_of("out/report.html"), "What stays in place"));
    const double share = 64.0 / kPixels;
    // The patch's edge lies within cells, and in the dark stray light is allowed for.
    constexpr double kOfCells = 0.3;
    const double rms = std::log(kPatch) * std::sqrt(share * (1.0 - share));
    EXPECT_NEAR(notes["pattern"]["rms"].get<double>(), rms, kOfCells * rms);
    // It hardly moves medians: the gain is kept for images that come later.
    take("later.tif", {2.0, 0.0, 0.0});
    EXPECT_TRUE(has(done(correct({})).out, "1 image corrected"));
}

// Of a dive of 400 images, those that it repeats, a twentieth is searched: more than are examined
// anyway.
TEST_F(CorrectCommand, ALargeSurveyIsSearchedForAPatternInATwentieth) {
    take_dive();
    std::istringstream all(lines_);
    std::vector<std::string> lines;
    for (std::string line; std::getline(all, line);) lines.push_back(line);
    std::string navigation;
    for (int i = 0; i < 400; ++i) {
        const std::string& line = lines[static_cast<std::size_t>(i) % lines.size()];
        const std::string name = fmt::format("d{:03}.tif", i);
        fs::create_hard_link(path("raw/" + line.substr(0, 6)), path("raw/" + name));
        navigation += name + line.substr(6) + "\n";
    }
    for (const std::string& line : lines) fs::remove(path("raw/" + line.substr(0, 6)));
    write_file(path("nav.eic"), navigation);
    done(correct({}));
    EXPECT_EQ(json_in("out/correction.json")["pattern"]["images"], 20);
}

// What each option makes of poses is NavigationFile's concern: here each reaches it, and is noted.
// Other poses are another survey: the gain is taken anew, and every image done.
TEST_F(CorrectCommand, OptionsOfNavigationReachItsReader) {
    take("20240309.120000000.1.tif", {2.0, 0.0, 0.0});
    write_file(path("track.csv"), "timestamp,alt,theta\n1709989200,1.5,0\n1709989203,1.5,0\n");
    const auto corrected = [&](const Arguments& options) {
        return json_by(correct("--nav track.csv --json" + options));
    };
    const Arguments all =
        "--columns altitude_m=alt,pitch_deg=theta --angles-in rad --altitude-is nearest "
        "--clock-offset-s 3600 --longest-gap-s 4";
    const Json noted = corrected(all + "--altitude-offset-m 0.5")["settings"]["navigation"];
    EXPECT_EQ(noted["columns"]["altitude_m"], "alt");
    EXPECT_EQ(noted["angles_in"], "rad");
    EXPECT_EQ(noted["altitude_is"], "nearest");
    EXPECT_EQ(noted["altitude_offset_m"], 0.5);
    EXPECT_EQ(noted["clock_offset_s"], 3600.0);
    EXPECT_EQ(noted["longest_gap_s"], 4.0);
    EXPECT_EQ(corrected(all + "--altitude-offset-m 0.5")["kept"], 1);
    EXPECT_EQ(corrected(all + "--altitude-offset-m 0.4")["kept"], 0);
}

// Whichever thread comes first.
TEST_F(CorrectCommand, TheFirstImageThatCannotBeReadIsNamed) {
    constexpr int kImages = 16;
    for (int i = 0; i < kImages; ++i) {
        const std::string name = fmt::format("{:02}.tif", i);
        // The first takes longest: it has a directory to be read.
        write_file(path("raw/" + name),
                   i == 0 ? tiff_of(std::vector<std::uint16_t>(1U << 20U), 1U << 10U, 1U << 10U, "")
                          : "no image");
        note(name, {2.0, 0.0, 0.0});
    }
    refused(correct("--jobs 8"),
            "none of the 16 images examined can be corrected; 00: found 1024 x 1024 pixels");
}

// What was noted is believed only as far as it makes sense: the rest is done again.
TEST_F(CorrectCommand, NotesEditedByHandSpoilNothing) {
    take_survey();
    done(correct({}));
    const std::string journal = text_of("out/corrected.jsonl");
    const std::string notes = text_of("out/correction.json");
    const auto after = [&](const std::string& edited_journal, const std::string& edited_notes) {
        write_file(path("out/corrected.jsonl"), edited_journal);
        write_file(path("out/correction.json"), edited_notes);
        const Json summary = json_by(correct("--json"));
        EXPECT_EQ(summary["gain"], Json::parse(notes)["gain"]);
        EXPECT_EQ(summary["doubtful"], Json::parse(notes)["doubtful"]);
        return summary["corrected"].get<int>();
    };
    const auto first = [](const std::string& text, const char* what, const char* by) {
        return std::regex_replace(
            text, std::regex(what), by, std::regex_constants::format_first_only);
    };
    EXPECT_EQ(after(first(journal, R"("counts":\{[^}]*\})", R"("counts":"many")"), notes), 1);
    EXPECT_EQ(after(first(journal, R"("counts":\{[^}]*\})", R"("counts":{"dark":"few"})"), notes),
              1);
    EXPECT_EQ(after(first(journal, R"("files":\{[^}]*\})", R"("files":{})"), notes), 1);
    EXPECT_EQ(after(first(journal, R"("name":"[^"]*")", R"("name":7)"), notes), 1);
    EXPECT_EQ(after("[]\n7\n" + journal, notes), 0);
    for (const char* gain : {"-", "0.0,", "null,", "1e999,"}) {
        EXPECT_EQ(
            after(journal, first(notes, R"("gain": \[\s*)", ("$&" + std::string(gain)).c_str())), 0)
            << gain;
    }
}

TEST_F(CorrectCommand, KilledAnywhereItGoesOnToTheSameImages) {
    take_survey();
    const std::string image = text_of("raw/1.tif");
    constexpr int kMore = 60;
    for (int i = 0; i < kMore; ++i) {
        const std::string name = fmt::format("more{:02}.tif", i);
        write_file(path("raw/" + name), image);
        note(name, {2.0 + 0.01 * i, 0.0, 0.0});
    }
    const Arguments settings("--mask --gain-images 4 --jobs 2");
    done(correct(settings, "whole"));
    {
        Process process({.executable = APHOTIC_COMMAND,
                         .arguments = kCorrect + ("-o out" + settings),
                         .folder = folder_.path(),
                         .environment = {},
                         .log = path("log")});
        const auto has_begun = [&] {
            std::error_code error;
            const auto size = fs::file_size(path("out/corrected.jsonl"), error);
            return !error && size > 0;
        };
        while (!has_begun() && !process.poll()) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }  // killed
    abandon(path("out/more07.tif"));
    const Json summary = json_by(correct(settings + "--json"));
    EXPECT_GE(summary["kept"], 1);
    EXPECT_EQ(summary["kept"].get<int>() + summary["corrected"].get<int>(), kMore + 4);
    auto whole = files_in("whole");
    auto out = files_in("out");
    for (auto* files : {&whole, &out}) {
        files->erase("corrected.jsonl");  // in the order in which they were done
        files->erase("correction.json");  // holds the seconds
    }
    EXPECT_EQ(out.size(), 2U * (kMore + 4));
    EXPECT_TRUE(out == whole);
}

// Its light would be that of the other strobes alone.
TEST_F(CorrectCommand, APoseWithAStrobeUnderTheFloorIsSkipped) {
    take_survey();
    fs::copy_file(path("raw/0.tif"), path("raw/tilted.tif"));
    note("tilted.tif", {0.02, 30.0 * kDegree, 0.0});
    const Json summary = json_by(correct("--json"), kAnswerIsNo);
    EXPECT_EQ(summary["corrected"], 4);
    EXPECT_EQ(summary["gain_from"].size(), 4U);
    const std::map<std::string, std::string> why{
        {"raw/tilted.tif",
         "altitude 0.02 m, pitch 30, roll 0 degrees: strobe 'aft' is 0.2327 m below the sea floor; "
         "allowed: at least 0.001 m above it"}};
    EXPECT_EQ(skipped(summary), why);
}

// A name that leads nowhere when its turn comes, be it a link or a file that went meanwhile, and a
// pipe, which one would wait for without end: each is one bad image, whichever way it was named.
TEST_F(CorrectCommand, WhatIsNoFileWhenItsTurnComesCostsNoOther) {
    take_survey();
    fs::create_symlink("moved-away.tif", path("raw/gone.tif"));
    fs::create_symlink("itself.tif", path("raw/itself.tif"));
    ASSERT_EQ(::mkfifo(path("raw/pipe.tif").c_str(), 0600), 0);
    ASSERT_EQ(::mkfifo(path("named.tif").c_str(), 0600), 0);
    for (const char* name : {"gone.tif", "itself.tif", "pipe.tif", "named.tif"}) {
        note(name, {2.0, 0.0, 0.0});
    }
    const Json summary = json_by(correct("named.tif --json --gain 1"), kAnswerIsNo);
    EXPECT_EQ(summary["corrected"], 4);
    auto why = skipped(summary);
    EXPECT_EQ(why.size(), 4U) << summary.dump(2);
    EXPECT_EQ(why["raw/gone.tif"], "found a broken link; allowed: a file");
    EXPECT_EQ(why["raw/itself.tif"], "found a broken link; allowed: a file");
    EXPECT_EQ(why["raw/pipe.tif"], "found a pipe, device or folder; allowed: a file");
    EXPECT_EQ(why["named.tif"], "found a pipe, device or folder; allowed: a file");
}

// Of many images the last is taken away when the first ones are done.
TEST_F(CorrectCommand, AnImageThatVanishesMeanwhileIsOneThatIsSkipped) {
    constexpr int kMany = 200;
    take("000.tif", {2.0, 0.0, 0.0});
    for (int i = 1; i < kMany; ++i) {
        const std::string name = fmt::format("{:03}.tif", i);
        fs::copy_file(path("raw/000.tif"), path("raw/" + name));
        note(name, {2.0, 0.0, 0.0});
    }
    const std::string last = fmt::format("raw/{:03}.tif", kMany - 1);
    std::jthread thief([&](const std::stop_token& ended) {
        std::error_code none;
        const auto noted = [&] { return fs::file_size(path("out/corrected.jsonl"), none); };
        while (!ended.stop_requested() && (noted() == 0 || none)) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        fs::remove(path(last));
    });
    const Json summary = json_by(correct("--json --gain 1 --jobs 1"), kAnswerIsNo);
    EXPECT_EQ(summary["corrected"], kMany - 1);
    const std::map<std::string, std::string> why{{last, "the file no longer exists"}};
    EXPECT_EQ(skipped(summary), why);
}

// One map for all: here the rig's own, so that the results are the same.
TEST_F(CorrectCommand, AMapTakesThePlaceOfRigAndNavigation) {
    const Sled sled{2.0, 5.0 * kDegree, 0.0};  // as the rig file has it
    take("a.tif", sled);
    const Tracer tracer(rig_at(sled), {.signals = true, .planes_nm = {}, .threads = 1});
    std::vector<double> map = tracer.rows(0, kHeight);
    map[100] = std::numeric_limits<double>::quiet_NaN();  // as where nothing was observed
    write_exr(path("map.exr"), kWidth, std::vector<float>(map.begin(), map.end()));
    const Arguments common("--format exr --keep-mosaic --gain 0.001");
    done(correct(common, "by-rig"));
    done(
        "correct raw --map map.exr -o by-map --bayer GRBG --black-level 60 --white-level 4095 "
        "--middle 0.3 --mask" +
        common);
    const std::vector<float> by_map = read_exr(path("by-map/a.exr"), {"Y"});
    const std::vector<float> by_rig = read_exr(path("by-rig/a.exr"), {"Y"});
    const DecodedPng mask = decode_png(text_of("by-map/a.mask.png"));
    const std::vector<std::uint8_t> edges = ConeEdges(rig_at(sled)).mask(sled, 1);
    for (std::size_t p = 0; p < kPixels; ++p) {
        EXPECT_TRUE(std::isfinite(by_map[p]));
        if (edges[p] == 0 && (mask.pixels[p] & 0xFFU) == 0) {
            EXPECT_NEAR(by_map[p] / by_rig[p], 1.0, kMapError) << p;
        }
    }
}

TEST_F(CorrectCommand, WhatIsWrongIsSaidBeforeAnythingIsWritten) {
    take("a.tif", {2.0, 0.0, 0.0});
    refused("correct raw -o out", "--rig with --nav, or --map");
    refused("correct raw -o out --rig rig.toml", "--rig needs --nav");
    refused("correct raw -o out --map none.exr", "none.exr");
    for (const char* folder : {"mine", "dark", "empty"}) fs::create_directories(path(folder));
    for (const char* name : {"mine/a.tif", "mine/a.mask.png"})
        write_file(path(name), "an image of the user's");
    const std::vector<std::uint16_t> black(kPixels, static_cast<std::uint16_t>(kBlackLevel));
    write_file(path("dark/a.tif"), tiff_of(black, kWidth, kHeight, ""));
    const Arguments by_rig("correct --rig rig.toml --nav nav.eic");
    for (const auto& [options, why] :
         Cases{{"rew -o out", "rew: no such file or folder"},
               {"raw raw/a.tif -o out", "would both become out/a"},
               {"raw -o out --bayer RGB", "--bayer: found 'RGB'"},
               {"raw -o out --gain 1,2", "--gain: found 2 numbers"},
               {"raw -o out --compression lzw", "--compression"},
               {"raw -o out --altitudes-m 4,1", "--altitude: found 4,1"},
               {"raw/a.tif -o raw", "would be overwritten by the result"},
               {"mine/a.tif mine/a.mask.png -o mine --format exr --mask",
                "mine/a.mask.png: would be overwritten by the result"},
               {"raw -o raw", "found the output folder"},
               {"dark -o out --bayer GRBG --black-level 60",
                "no gain can be derived from these images"},
               {"raw -o out",
                "the only image examined cannot be corrected; a: found one channel and no --bayer; "
                "allowed: R, G, B, a mosaic whose pattern --bayer names, or --bayer mono"},
               {"empty -o out", "empty: the folder contains no images"}})
        refused(by_rig + options, why);
    write_file(path("nav.eic"), "a.tif two 0 0\n");
    refused(by_rig + "raw -o out", "nav.eic:1: altitude_m: found 'two'; allowed: a number");
}

// Poses and results by an iFDO alone: heights are plumb, so pitch and roll count.
TEST_F(CorrectCommand, TakesAnIfdoAndLeavesThatOfTheResults) {
    const std::vector<Sled> sleds = take_survey();
    Json set{{"image-set-header", {{"image-set-name", "a survey"}, {"image-altitude-meters", -60}}},
             {"image-set-items", Json::object()}};
    for (std::size_t i = 0; i < sleds.size(); ++i) {
        const Sled& sled = sleds[i];
        set["image-set-items"][fmt::format("{}.tif", i)] = {
            {"image-meters-above-ground",
             sled.altitude_m * std::cos(sled.pitch_rad) * std::cos(sled.roll_rad)},
            {"image-camera-pitch-degrees", sled.pitch_rad / kDegree},
            {"image-camera-roll-degrees", sled.roll_rad / kDegree}};
    }
    write_file(path("set.json"), set.dump());
    done(correct({}));
    done(correct("--nav set.json --ifdo set.json --encode srgb", "by-ifdo"));
    const Json results = json_in("by-ifdo/set.json");
    EXPECT_EQ(results["image-set-header"]["image-set-name"], "a survey");
    EXPECT_EQ(results["image-set-header"]["image-quality"], "processed");
    ASSERT_EQ(results["image-set-items"].size(), 4U);
    for (const auto& [name, item] : results["image-set-items"].items()) {
        EXPECT_EQ(item["image-hash-sha256"], sha256_of_file(path("by-ifdo/" + name)));
        EXPECT_EQ(text_of("by-ifdo/" + name), text_of("out/" + name));
    }
    // What annotators look at.
    const Json shown = json_in("by-ifdo/srgb/set.json");
    ASSERT_EQ(shown["image-set-items"].size(), 4U);
    for (const auto& [name, item] : shown["image-set-items"].items()) {
        EXPECT_EQ(item["image-hash-sha256"], sha256_of_file(path("by-ifdo/srgb/" + name)));
        EXPECT_NE(item["image-uuid"],
                  results["image-set-items"][fs::path(name).replace_extension(".tif").string()]
                         ["image-uuid"]);
    }
    write_file(path("set.json"), R"({"image-set-header": {}})");
    refused(correct("--ifdo set.json", "none"), "set.json: image-set-items: found none");
}

}  // namespace
}  // namespace aphotic::correct_test
