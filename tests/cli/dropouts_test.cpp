// SPDX-License-Identifier: BSD-3-Clause
//
// Surveys of which some images are dark, as strobes left them: twelve mosaics of one even floor, of
// which three are without light and one at half of it.
#include "support/command_test.h"
#include "support/exr_file.h"
#include "support/scene_text.h"
#include "support/tiff.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numeric>

namespace aphotic::dropouts_test {
namespace {

constexpr std::uint32_t kWidth_px = 32;
constexpr std::uint32_t kHeight_px = 24;
constexpr double kFloor = 20000.0;
constexpr double kUnmoved = 0.01;  // the floor's texture is a tenth of it
const std::vector<std::string> kGood{"f00", "f01", "f02", "f04", "f05", "f07", "f10", "f11"};

class Dark : public CommandTest {
  protected:
    Dark() {
        std::filesystem::create_directories(path("raw"));
        std::string poses = "image,altitude_m,pitch_deg,roll_deg\n";
        for (std::uint32_t i = 0; i < 12; ++i) {
            const double light = i == 3 || i == 8 || i == 9 ? 300.0 : i == 6 ? 1e4 : kFloor;
            write(fmt::format("f{:02}", i), light, i);
            poses += fmt::format("f{:02}.tif,2.0,0,0\n", i);
        }
        write_file(path("nav.csv"), poses);
        write_exr(path("flat.exr"),
                  kWidth_px,
                  std::vector<float>(3 * std::size_t{kWidth_px} * kHeight_px, 1.0F));
    }
    // Texture of 15 in 20000, another in every image.
    void write(const std::string& name, double light, std::uint32_t seed) {
        std::vector<std::uint16_t> samples;
        for (std::uint32_t k = 0; k < kWidth_px * kHeight_px; ++k) {
            const double off = static_cast<double>((k * 7919U + seed * 104729U) % 31U) - 15.0;
            samples.push_back(static_cast<std::uint16_t>(light * (1.0 + off / kFloor)));
        }
        write_file(path("raw/" + name + ".tif"), tiff_of(samples, kWidth_px, kHeight_px, ""));
    }
    void keep_good() const {
        for (const char* bad : {"f03", "f06", "f08", "f09"})
            std::filesystem::remove(path(fmt::format("raw/{}.tif", bad)));
    }
    // Of what is known.
    [[nodiscard]] double mean_of(const std::string& file, const std::string& channel = "G") const {
        double sum = 0.0;
        double count = 0.0;
        for (const float sample : read_exr(path(file), {channel})) {
            if (std::isnan(sample)) continue;
            sum += sample;
            count += 1.0;
        }
        return sum / count;
    }
    static void names_all(const std::string& words) {
        for (const char* dark : {"f03.tif", "f08.tif", "f09.tif"})
            EXPECT_TRUE(has(words, fmt::format("{}: without light: 0.015 of the survey's", dark)))
                << words;
        EXPECT_TRUE(has(words, "f06.tif: lit by 0.5 of the survey's light")) << words;
    }
};
using CommandDropouts = Dark;

TEST_F(CommandDropouts, AreKeptOutOfObservedMaps) {
    const Arguments observe("observe raw --nav nav.csv --altitude 2 --bayer RGGB -o map.exr");
    for (const char* method : {"mean", "median", "trimmed"}) {
        names_all(done(observe + Arguments(fmt::format("--method {}", method)), "", 1).err);
        EXPECT_NEAR(mean_of("map.exr"), kFloor, kUnmoved * kFloor) << method;
    }
    names_all(done(observe + Arguments("--normalise --allow-skipped 3"), "8 images").err);
    EXPECT_NEAR(mean_of("map.exr"), 1.0, kUnmoved);
    const auto json = json_by(observe + Arguments("--allow-skipped 3 --json"));
    ASSERT_EQ(json["dropouts"].size(), 1U);
    EXPECT_NEAR(json["dropouts"][0]["share"].get<double>(), 0.5, kUnmoved);
}

// (8 x 20000 + 3 x 300 + 10000) / 12
TEST_F(CommandDropouts, CountWhereTheyAreIgnored) {
    done(Arguments(
             "observe raw --nav nav.csv --altitude 2 --bayer RGGB -o map.exr --dropouts ignore"),
         "12 images");
    EXPECT_NEAR(mean_of("map.exr"), 14241.67, kUnmoved * kFloor);
}

TEST_F(CommandDropouts, AreMarkedAndDoNotMoveTheGain) {
    const Arguments correct("correct raw --map flat.exr --bayer RGGB --middle 0.2 --format exr");
    const CommandResult run = done(correct + Arguments("-o out"), "0.5 of the survey's light", 1);
    names_all(run.err);
    EXPECT_NEAR(mean_of("out/f06.exr"), 0.1, 0.1 * kUnmoved);
    const nlohmann::json json = json_in("out/correction.json");
    EXPECT_EQ(json["skipped"].size(), 3U);
    ASSERT_EQ(json["dropouts"].size(), 1U);
    EXPECT_NEAR(json["dropouts"][0]["share"].get<double>(), 0.5, kUnmoved);
    // Done again, it is known from before.
    EXPECT_TRUE(
        has(done(correct + Arguments("-o out"), "9 kept", 1).err, "f06.tif: lit by 0.5 of the"));
    // By the light that was on.
    done(correct + Arguments("-o lit --dropouts correct"), "", 1);
    EXPECT_NEAR(mean_of("lit/f06.exr"), 0.2, 0.2 * kUnmoved);
    keep_good();
    done(correct + Arguments("-o good"));
    const double gain = json_in("good/correction.json")["gain"][1];
    EXPECT_NEAR(gain, 0.2 / kFloor, kUnmoved * gain);
    EXPECT_NEAR(json["gain"][1].get<double>(), gain, kUnmoved * gain);
}

TEST_F(CommandDropouts, AreNotLearnedFromByBaselines) {
    const Arguments baseline("baseline log-polynomial raw --bayer RGGB");
    names_all(done(baseline + Arguments("-o out"), "", 1).err);
    const double with_dark = mean_of("out/f00.exr");
    keep_good();
    done(baseline + Arguments("-o good"));
    EXPECT_NEAR(with_dark, mean_of("good/f00.exr"), kUnmoved * with_dark);
}

// By a rig. What an image without one strobe becomes by the light that was on is what it becomes
// with all of them by all of it, for the floor is one.
TEST_F(CommandDropouts, AStrobeOfARigIsNamedAndItsLightLeftOut) {
    std::filesystem::copy(scene_file("survey/grey-card.csv"), path("grey-card.csv"));
    write_file(path("rig.toml"),
               with(scene_text("survey/smooth.toml"),
                    {{"resolution", "[170, 128]"}, {"pixel_pitch_um", "51.6"}}));
    const Arguments survey("survey rig.toml --images 12 --no-noise --electrons-per-signal 2000");
    done(survey + Arguments("-o lit"));
    done(survey + Arguments("--set strobe.port.power=0 -o unlit"));
    std::filesystem::create_directories(path("mixed"));
    for (const auto& image : std::filesystem::directory_iterator(path("lit/raw")))
        std::filesystem::copy(image.path(), path("mixed") / image.path().filename());
    std::filesystem::copy(path("unlit/raw/000005.tif"),
                          path("mixed/000005.tif"),
                          std::filesystem::copy_options::overwrite_existing);
    const Arguments correct(
        "--rig rig.toml --nav lit/navigation.txt --bayer RGGB --format exr "
        "--black-level 64 --gain 0.0005 --dropouts correct");
    EXPECT_EQ(done("correct lit/raw -o all" + correct).err, "");
    const CommandResult run = done("correct mixed -o on" + correct);
    EXPECT_TRUE(has(run.err, "000005.tif: strobe port did not fire: lit by 0.7")) << run.err;
    EXPECT_EQ(json_in("on/correction.json")["dropouts"].size(), 1U);
    const std::vector<float> all = read_exr(path("all/000005.exr"), {"G"});
    const std::vector<float> on = read_exr(path("on/000005.exr"), {"G"});
    constexpr double kNumbers = 0.05;  // both are rounded to numbers, some twenty in corners
    for (std::size_t i = 0; i < all.size(); ++i) ASSERT_NEAR(on[i], all[i], kNumbers * all[i]) << i;
}

// Of exposures of 8, 4, 2 and 1 that nobody told, all images come out alike.
TEST_F(CommandDropouts, AnExposureByTheModelIsTheImagesOwnLevel) {
    for (std::uint32_t i = 0; i < 12; ++i)
        write(fmt::format("f{:02}", i), kFloor / (1U << i % 4U), i);
    done(Arguments("correct raw --map flat.exr --bayer RGGB --middle 0.2 --format exr "
                   "--exposure model -o out"),
         "each image to its own level");
    for (std::uint32_t i = 0; i < 12; ++i)
        EXPECT_NEAR(mean_of(fmt::format("out/f{:02}.exr", i)), 0.2, 0.2 * 2.0 * kUnmoved) << i;
    refused(Arguments("baseline homomorphic raw --exposure model -o out2"), "--exposure");
}

}  // namespace
}  // namespace aphotic::dropouts_test
