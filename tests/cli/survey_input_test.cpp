// SPDX-License-Identifier: BSD-3-Clause
//
// What cameras and their owners hand in, at the door of correct, observe and baseline: parts of
// files, mono cameras, raw files, exposures, tags, and rigs of another scale.
#include "image/exr.h"
#include "support/command_test.h"
#include "support/dng.h"
#include "support/exiftool.h"
#include "support/exr_file.h"
#include "support/has.h"
#include "support/scene_text.h"
#include "support/tiff.h"
#include "survey/images/raw_image.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

namespace aphotic::survey_input_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr int kWidth = 64;  // LibRaw reads no smaller raw files
constexpr int kHeight = 48;
constexpr std::size_t kPixels = kWidth * kHeight;
constexpr int kBlack = 64;
constexpr int kWhite = 4095;

// Numbers of 16 bits are read as floats from 0 to 1.
constexpr double kShareOf16Bits = 65535.0 * 0x1p-23;

using Numbers = std::vector<std::uint16_t>;

class SurveyInput : public CommandTest {
  protected:
    void SetUp() override { fs::create_directories(path("raw")); }

    // Falls off to the right, in each channel from another height.
    static float light(std::size_t channel, int column, int row) {
        return 1.0F + 0.3F * static_cast<float>(channel) - 0.01F * static_cast<float>(column) -
               0.002F * static_cast<float>(row);
    }

    void write_map(bool is_grey) const {
        std::vector<float> planes;
        for (std::size_t c = 0; c < kChannels; ++c) {
            for (int i = 0; i < static_cast<int>(kPixels); ++i)
                planes.push_back(light(is_grey ? 0 : c, i % kWidth, i / kWidth));
        }
        write_exr(path("map.exr"), kWidth, planes);
    }

    // What the camera makes of that light: numbers over black of this many times it.
    static Numbers mosaic(Mosaic mosaic, double times) {
        Numbers numbers;
        for (int row = 0; row < kHeight; ++row) {
            for (int column = 0; column < kWidth; ++column) {
                const auto c = static_cast<std::size_t>(channel_at(mosaic, column, row));
                numbers.push_back(static_cast<std::uint16_t>(
                    std::lround(kBlack + times * light(c, column, row))));
            }
        }
        return numbers;
    }

    // The image within a larger file of other numbers.
    static Numbers placed(const Numbers& image, int left, int top, int width, int height) {
        Numbers file;
        for (int row = 0; row < height; ++row) {
            for (int column = 0; column < width; ++column) {
                const bool is_inside =
                    column >= left && column < left + kWidth && row >= top && row < top + kHeight;
                const int at = (row - top) * kWidth + column - left;
                file.push_back(is_inside ? image[static_cast<std::size_t>(at)]
                                         : static_cast<std::uint16_t>(column * 31 + row));
            }
        }
        return file;
    }

    void write_tiff(const std::string& name, const Numbers& numbers, int width, int height) const {
        write_file(path("raw/" + name),
                   tiff_of(numbers,
                           static_cast<std::uint32_t>(width),
                           static_cast<std::uint32_t>(height),
                           "lat=41.5"));
    }

    static Dng dng(double times) {
        return {.width = kWidth,
                .height = kHeight,
                .samples = mosaic(Mosaic::Rggb, times),
                .black = {kBlack},
                .white = kWhite};
    }
    void write_dng(const std::string& name, const Dng& dng) const {
        write_file(path("raw/" + name), dng_of(dng));
    }

    // By the map, into floats.
    static Arguments correct(const std::string& output, const Arguments& more) {
        return "correct raw --map map.exr --format exr -o " + output + more;
    }
    static Arguments levels(const Arguments& more) {
        return more + "--black-level 64 --white-level 4095";
    }

    [[nodiscard]] std::vector<float> samples(const std::string& file,
                                             const std::vector<std::string>& channels = {
                                                 "R", "G", "B"}) const {
        return read_exr(path(file), channels);
    }
};

// Bytes of a result: the same image gives the same.
TEST_F(SurveyInput, AHalfOrACropIsTreatedAsAFileOfItsOwn) {
    write_map(false);
    write_file(path("nav.csv"), "image,altitude_m\na,2\n");
    const Numbers image = mosaic(Mosaic::Rggb, 1000.0);
    const auto results = [&](const std::string& output, Arguments more) {
        more += "--black-level 64";
        done(correct(output, more));
        done(fmt::format("baseline illumination-reflectance raw -o {}-baseline", output) + more);
        done(fmt::format("observe raw --nav nav.csv --altitude 2 -o {}.exr", output) + more);
        return text_of(output + "/a.exr") + text_of(output + "-baseline/a.exr") +
               text_of(output + ".exr");
    };
    write_tiff("a.tif", image, kWidth, kHeight);
    const std::string whole = results("whole", "--bayer RGGB");
    write_tiff("a.tif", placed(image, kWidth, 0, 2 * kWidth, kHeight), 2 * kWidth, kHeight);
    EXPECT_EQ(results("right", "--bayer RGGB --half right"), whole);
    EXPECT_NE(results("left", "--bayer RGGB --half left"), whole);
    // At an odd column and row the pattern begins with another site.
    write_tiff("a.tif", placed(image, 3, 1, kWidth + 5, kHeight + 2), kWidth + 5, kHeight + 2);
    EXPECT_EQ(results("odd", "--bayer BGGR --crop 3,1,64,48"), whole);
    EXPECT_NE(results("wrong", "--bayer RGGB --crop 3,1,64,48"), whole);
    const Json notes = json_in("odd/correction.json");
    EXPECT_EQ(notes["settings"]["crop"], "3,1,64,48");
    EXPECT_EQ(notes["settings"]["bayer"], "BGGR");
}

// Levels of a 16-bit camera for files of 8 bits, as of another camera's rig.
TEST_F(SurveyInput, LevelsBeyondTheFilesNumbersAreRefused) {
    write_map(false);
    write_tiff("a.tif", mosaic(Mosaic::Rggb, 1000.0), kWidth, kHeight);
    refused(correct("out", "--bayer RGGB --white-level 65536"),
            "white level: found 65536; allowed: up to 65535, the file's largest number");
    refused(correct("out", "--bayer RGGB --black-level 4095 --white-level 4095"),
            "black level: found 4095; allowed: less than the white level, 4095");
    done(correct("out", "--bayer RGGB --white-level 65535"));
}

// Another crop is another result.
TEST_F(SurveyInput, ACropIsPartOfWhatIsKept) {
    write_map(false);
    write_tiff("a.tif",
               placed(mosaic(Mosaic::Rggb, 1000.0), 0, 0, kWidth + 2, kHeight),
               kWidth + 2,
               kHeight);
    const auto kept = [&](const std::string& crop) {
        return json_by(correct("out",
                               fmt::format("--bayer RGGB --crop {} --gain 1 --json", crop)))["kept"]
            .get<int>();
    };
    EXPECT_EQ(kept("0,0,64,48"), 0);
    EXPECT_EQ(kept("0,0,64,48"), 1);
    EXPECT_EQ(kept("2,0,64,48"), 0);
}

TEST_F(SurveyInput, PartsThatAreNotThereAreOneMistake) {
    write_map(false);
    write_file(path("nav.csv"), "image,altitude_m\na,2\nb,2\n");
    for (const char* name : {"a.tif", "b.tif"})
        write_tiff(name, Numbers((kWidth + 1) * kHeight, 100), kWidth + 1, kHeight);
    Cases cases{{"--bayer RGGB --crop 2,0,64,48",
                 "--crop 2,0,64,48: reaches beyond the image; allowed: within 65 x 48 pixels"},
                {"--bayer RGGB --crop 0,1,64,48", "within 65 x 48 pixels"},
                {"--bayer RGGB --crop 0,0,2147483647,48", "within 65 x 48 pixels"},
                {"--bayer RGGB --half left",
                 "--half: found an image of 65 x 48 pixels; allowed: an even width"},
                {"--half upper", "--half"},
                {"--exposure auto", "--exposure: found auto; allowed: exif, flash"},
                {"--half left --crop 0,0,5,5", "--half excludes --crop"},
                {"--bayer gray", "found 'gray'; allowed: RGGB, BGGR, GRBG, GBRG, mono"},
                {"--bayer RGGB --exposure exif", "no image's Exif has ExposureTime"}};
    for (const std::string wrong :
         {"1,2,3", "1,2,3,4,5", "-1,0,5,5", "0,0,0,5", "a,0,5,5", "0;0;5;5", ""})
        cases.push_back({{"--crop", wrong}, "--crop: found '" + wrong + "'; allowed: X,Y,WIDTH"});
    for (const auto& [options, why] : cases) {
        for (const Arguments& command :
             std::vector<Arguments>{"correct raw --map map.exr -o out",
                                    "baseline homomorphic raw -o out",
                                    "observe raw --nav nav.csv --altitude 2 -o out.exr"})
            EXPECT_FALSE(has(refused(command + options, why).err, "raw/b.tif"));
    }
}

TEST_F(SurveyInput, AMonoCamerasImagesAreOnePlaneUnderOneGain) {
    write_map(true);
    Numbers numbers;
    for (int i = 0; i < static_cast<int>(kPixels); ++i) {
        numbers.push_back(static_cast<std::uint16_t>(
            std::lround(kBlack + 2000.0 * light(0, i % kWidth, i / kWidth))));
    }
    write_tiff("a.tif", numbers, kWidth, kHeight);
    const CommandResult result = done(correct("out", levels("--bayer mono --middle 0.25")));
    EXPECT_TRUE(std::regex_search(result.out, std::regex("gain 0\\.000125[0-9]*, taken")))
        << result.out;
    EXPECT_EQ(ExrReader(path("out/a.exr")).channels(), std::vector<std::string>{"Y"});
    constexpr double kStep = 0.5 / 700.0;  // of whole numbers, where there is least light
    for (const float sample : samples("out/a.exr", {"Y"}))
        EXPECT_NEAR(sample / 0.25, 1.0, 2.0 * kStep);

    refused(correct("three", levels("--bayer mono --gain 1,2,3")),
            "--gain: found 3 numbers; allowed: 1, of a mono camera");

    write_file(path("nav.csv"), "image,altitude_m\na,2\n");
    done("observe raw --nav nav.csv --altitude 2 -o seen.exr --bayer mono --black-level 64");
    const std::vector<float> green = samples("seen.exr", {"G"});
    for (std::size_t i = 0; i < kPixels; ++i)
        EXPECT_NEAR(green[i], numbers[i] - kBlack, kShareOf16Bits) << i;
    EXPECT_EQ(samples("seen.exr", {"R", "count.B"}), [&] {
        std::vector<float> all = green;
        all.resize(2 * kPixels, 1.0F);
        return all;
    }());

    done("baseline homomorphic raw -o even --bayer mono");
    EXPECT_EQ(ExrReader(path("even/a.exr")).channels(), std::vector<std::string>{"Y"});

    write_map(false);
    refused(correct("colours", levels("--bayer mono")),
            "found a mono camera's image, and a map whose R, G and B differ");
}

TEST_F(SurveyInput, ARawFileSaysItsPatternAndLevelsItself) {
    write_map(false);
    write_tiff("a.tif", mosaic(Mosaic::Rggb, 1000.0), kWidth, kHeight);
    done(correct("tiff", levels("--bayer RGGB")));
    fs::remove(path("raw/a.tif"));
    write_dng("a.dng", dng(1000.0));
    done(correct("dng", {}));
    const std::vector<float> raw = samples("dng/a.exr");
    const std::vector<float> tiff = samples("tiff/a.exr");
    constexpr double kLeast = 200.0;  // number over black
    for (std::size_t i = 0; i < raw.size(); ++i)
        EXPECT_NEAR(raw[i] / tiff[i], 1.0, 2.0 * kShareOf16Bits / kLeast) << i;
    refused(correct("other", "--bayer GRBG"),
            "--bayer, or the rig's: found GRBG; allowed: RGGB, as the raw file says");
    const std::string bytes = text_of("raw/a.dng");
    write_file(path("raw/cut.dng"), bytes.substr(0, bytes.size() / 2));
    EXPECT_TRUE(has(done(correct("cut", "--gain 1"), "", kAnswerIsNo).err,
                    "raw/cut.dng: cannot be read: "));
}

// One floor in twice the light of exposure: one image, up to the camera's rounding.
TEST_F(SurveyInput, ImagesAreBroughtToOneExposureByTheirExif) {
    write_map(false);
    Dng once = dng(700.0);
    once.exposure_ms = 4;
    once.iso = 100;
    Dng twice = dng(1400.0);
    twice.exposure_ms = 8;
    twice.iso = 100;
    Dng loud = dng(1400.0);
    loud.exposure_ms = 4;
    loud.iso = 200;
    write_dng("a.dng", once);
    write_dng("b.dng", twice);
    write_dng("c.dng", loud);
    const auto ratio = [&](const std::string& folder, const std::string& name) {
        const std::vector<float> image = samples(folder + "/" + name, {"G"});
        const std::vector<float> first = samples(folder + "/a.exr", {"G"});
        return image[kPixels / 2] / first[kPixels / 2];
    };
    constexpr double kRounding = 2e-3;  // half a step of some 500
    done(correct("raw-out", {}));
    EXPECT_NEAR(ratio("raw-out", "b.exr"), 2.0, 2.0 * kRounding);
    done(correct("exif", "--exposure exif"), "brought to 4 ms, ISO 100");
    EXPECT_NEAR(ratio("exif", "b.exr"), 1.0, kRounding);
    EXPECT_NEAR(ratio("exif", "c.exr"), 1.0, kRounding);
    // A flash is as bright however long the shutter is open.
    done(correct("flash", "--exposure flash"));
    EXPECT_NEAR(ratio("flash", "b.exr"), 2.0, 2.0 * kRounding);
    EXPECT_NEAR(ratio("flash", "c.exr"), 1.0, kRounding);
    const std::string journal = text_of("exif/corrected.jsonl");
    EXPECT_TRUE(has(journal, "\"relative_exposure\":2.0"));
    const Json notes = json_in("exif/correction.json");
    EXPECT_EQ(notes["settings"]["exposure"]["time_s"], 0.004);

    done("baseline local-equalisation raw -o even --clip 1 --exposure exif");
    EXPECT_NEAR(ratio("even", "b.exr"), 1.0, kRounding);

    write_dng("d.dng", dng(700.0));
    EXPECT_TRUE(has(done(correct("untold", "--exposure exif"), "", kAnswerIsNo).err,
                    "raw/d.dng: --exposure: its Exif has no ExposureTime; skipped"));
}

TEST_F(SurveyInput, ResultsKeepTheTagsOfTheirSource) {
    if (!has_exiftool()) GTEST_SKIP() << "needs exiftool";
    write_map(false);
    write_tiff("a.tif", mosaic(Mosaic::Rggb, 1000.0), kWidth, kHeight);
    tag_by_exiftool(path("raw/a.tif"),
                    {"-GPSLatitude=41.5",
                     "-GPSLatitudeRef=N",
                     "-DateTimeOriginal=2012:07:01 12:13:14",
                     "-SubSecTimeOriginal=678",
                     "-SerialNumber=AB123",
                     "-XMP-dc:Creator=Jane Doe"});
    for (const std::string format : {"tiff", "png"}) {
        done(fmt::format("correct raw --map map.exr -o {0} --format {0}", format) +
             levels("--bayer RGGB --mask"));
        const Json found =
            tags_by_exiftool(path(format + (format == "tiff" ? "/a.tif" : "/a.png")));
        EXPECT_NEAR(found["GPS:GPSLatitude"].get<double>(), 41.5, 1e-6) << format;
        EXPECT_EQ(found["ExifIFD:DateTimeOriginal"], "2012:07:01 12:13:14") << format;
        EXPECT_EQ(found["ExifIFD:SubSecTimeOriginal"], 678) << format;
        EXPECT_EQ(found["ExifIFD:SerialNumber"], "AB123") << format;
        EXPECT_EQ(found["XMP-dc:Creator"], "Jane Doe") << format;
    }
    // Compared to what is written without them, pixel by pixel.
    done(correct("exr", levels("--bayer RGGB")));
    done("compare tiff/a.tif exr/a.exr --bound 1e-4");
    const ExrReader exr(path("exr/a.exr"));
    EXPECT_EQ(exr.attribute("Exif.GPSInfo.GPSLatitude"), "41/1 30/1 0/1");
    EXPECT_EQ(exr.attribute("Xmp.dc.creator"), "Jane Doe");
}

class RigOfSurvey : public SurveyInput {
  protected:
    // HabCam's in few pixels, with other lines of [camera].
    void write_rig(const std::string& resolution,
                   const std::string& pitch_um,
                   const std::string& more = "",
                   const std::string& response = "\"nikon-d5100\"") const {
        write_file(path("rig.toml"),
                   with(scene_text("habcam.toml"),
                        {{"resolution", resolution},
                         {"pixel_pitch_um", pitch_um},
                         {"response", response + "\n" + more}}));
    }

    static Arguments correct_by_rig(const std::string& output, const Arguments& more) {
        return "correct raw --rig rig.toml --nav nav.csv --format exr -o " + output + more;
    }
};

constexpr const char* kPitch_um = "137.0625";

TEST_F(RigOfSurvey, TellsItsCamerasNumbersAndOptionsWin) {
    write_rig("[64, 48]",
              kPitch_um,
              "bayer = \"RGGB\"\nblack_level_dn = 64\nwhite_level_dn = 4095\n"
              "exposure_ms = 2\niso = 100");
    write_file(path("nav.csv"), "image,altitude_m\na,2\n");
    write_tiff("a.tif", mosaic(Mosaic::Rggb, 1000.0), kWidth, kHeight);
    done(correct_by_rig("rig", {}), "camera: RGGB, black level 64, white level 4095\n");
    done(correct_by_rig("options", levels("--bayer RGGB")));
    EXPECT_EQ(text_of("rig/a.exr"), text_of("options/a.exr"));
    const Json other = json_by(correct_by_rig("other", "--black-level 60 --json"))["settings"];
    EXPECT_EQ(other["black_level"], 60.0);
    EXPECT_EQ(other["white_level"], 4095.0);
    EXPECT_EQ(
        json_by("baseline homomorphic raw -o even --json --rig rig.toml")["settings"]["bayer"],
        "RGGB");
    EXPECT_EQ(json_by("observe raw --nav nav.csv --altitude 2 -o seen.exr --json --rig rig.toml")
                  ["camera"]["black_level"],
              64.0);
}

// The rig's exposure is what images are brought to.
TEST_F(RigOfSurvey, TellsTheExposureThatImagesAreBroughtTo) {
    write_rig("[64, 48]", kPitch_um, "exposure_ms = 2\niso = 100");
    write_file(path("nav.csv"), "image,altitude_m\na,2\n");
    Dng image = dng(700.0);
    image.exposure_ms = 8;
    image.iso = 100;
    write_dng("a.dng", image);
    done(correct_by_rig("plain", "--gain 1"));
    done(correct_by_rig("exif", "--gain 1 --exposure exif"));
    const std::vector<float> plain = samples("plain/a.exr");
    const std::vector<float> exif = samples("exif/a.exr");
    for (std::size_t i = 0; i < plain.size(); ++i) EXPECT_FLOAT_EQ(exif[i], plain[i] / 4.0F) << i;
}

// The same view by half the pitch: the same correction.
TEST_F(RigOfSurvey, OfAnotherScaleIsScaledToTheImages) {
    write_file(path("nav.csv"), "image,altitude_m,pitch_deg\na,2,5\n");
    write_tiff("a.tif", mosaic(Mosaic::Rggb, 1000.0), kWidth, kHeight);
    write_rig("[64, 48]", kPitch_um);
    done(correct_by_rig("own", levels("--bayer RGGB")));
    write_rig("[128, 96]", "68.53125");
    done(correct_by_rig("scaled", levels("--bayer RGGB")),
         "rig of 128 x 96 pixels scaled to 64 x 48\n");
    EXPECT_EQ(text_of("own/a.exr"), text_of("scaled/a.exr"));
    const Json notes = json_in("scaled/correction.json");
    EXPECT_EQ(notes["settings"]["rig_scale"], 0.5);
    // A part of the rig's own image is not its whole one, smaller.
    write_rig("[64, 48]", kPitch_um);
    refused(correct_by_rig("part", levels("--bayer RGGB --crop 0,0,32,24")),
            "--crop: found 32 x 24 of files that have the rig's 64 x 48 pixels");
    write_rig("[32, 48]", kPitch_um);
    refused(correct_by_rig("stereo", levels("--bayer RGGB")),
            "found 64 x 48 pixels; allowed: 32 x 48, like the map; if two cameras' images are side "
            "by side, --half");
    write_rig("[128, 93]", "68.53125");
    refused(correct_by_rig("other", levels("--bayer RGGB")),
            "found 64 x 48 pixels; allowed: 128 x 93, like the map");
}

// --scale 0.2 makes 64 x 48 of 321 x 241 pixels, which is 64.2 x 48.2.
TEST_F(RigOfSurvey, ImagesOfAScaledSurveyAreOfItsRig) {
    write_file(path("nav.csv"), "image,altitude_m\na,2\n");
    write_tiff("a.tif", mosaic(Mosaic::Rggb, 1000.0), kWidth, kHeight);
    write_rig("[321, 241]", "27.4125");
    done(correct_by_rig("by_images", levels("--bayer RGGB")),
         "rig of 321 x 241 pixels scaled to 64 x 48\n");
    done(correct_by_rig("by_key", levels("--bayer RGGB --set camera.scale=0.2")));
    EXPECT_EQ(text_of("by_images/a.exr"), text_of("by_key/a.exr"));
}

TEST_F(RigOfSurvey, OfAMonoCameraCorrectsOnePlane) {
    write_file(path("qe.csv"), "wavelength_nm,quantum_efficiency\n400,0.3\n550,0.6\n720,0.2\n");
    write_rig("[64, 48]", kPitch_um, "", "{ quantum_efficiency = \"qe.csv\" }");
    write_file(path("nav.csv"), "image,altitude_m\na,2\n");
    done("lightmap rig.toml -o light.exr --altitude 2");
    const std::vector<float> red = samples("light.exr", {"R"});
    EXPECT_EQ(samples("light.exr", {"G"}), red);
    EXPECT_EQ(samples("light.exr", {"B"}), red);
    const double times = 3000.0 / *std::max_element(red.begin(), red.end());
    Numbers numbers;
    for (const float light : red) {
        numbers.push_back(static_cast<std::uint16_t>(std::lround(kBlack + times * light)));
    }
    write_tiff("a.tif", numbers, kWidth, kHeight);
    done(correct_by_rig("out", "--black-level 64 --white-level 4095 --middle 0.5"),
         "camera: mono, ");
    const std::vector<float> image = samples("out/a.exr", {"Y"});
    for (std::size_t i = 0; i < kPixels; ++i) {
        const double number = numbers[i] - kBlack;
        constexpr double kMapError = 1e-3;  // the middle image's own rounding among it
        if (number < 100.0) continue;       // held where it is dark
        EXPECT_NEAR(image[i], 0.5, 0.5 * (0.5 / number + kMapError)) << i;
    }
    refused(correct_by_rig("colours", "--bayer RGGB"),
            "--bayer: found RGGB, and the rig's camera has one response; allowed: mono");
    write_rig("[64, 48]", kPitch_um);
    refused(correct_by_rig("mono", "--bayer mono"),
            "the rig's camera has responses of red, green and blue");
}

}  // namespace
}  // namespace aphotic::survey_input_test
