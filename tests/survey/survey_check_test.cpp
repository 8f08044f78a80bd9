// SPDX-License-Identifier: BSD-3-Clause
//
// What looks wrong about surveys that are wrong, and nothing about right ones: light that falls
// with the square of the altitude and with water, over floors that differ from image to image.
#include "survey/survey_check.h"

#include "support/has.h"

#include <fmt/format.h>
#include "support/effort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <random>

namespace aphotic::survey_check_test {
namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();
// Of clear water, over red, green and blue.
constexpr PerChannel kAttenuation_per_m{0.35, 0.07, 0.03};

PerChannel light_at(double altitude_m) {
    PerChannel light{};
    for (std::size_t c = 0; c < light.size(); ++c) {
        light[c] = std::exp(-2.0 * kAttenuation_per_m[c] * altitude_m) / (altitude_m * altitude_m);
    }
    return light;
}

using Told = std::function<double(double altitude_m)>;

// What images of that many altitudes show of floors that differ by these standard deviations of the
// logarithm, one in brightness and one in each channel by itself; told: what the navigation says.
std::vector<ImageLook> survey(std::uint32_t seed, std::size_t images, const Told& told) {
    constexpr double kBrightness = 0.3;
    constexpr double kColour = 0.1;
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> altitude(1.3, 3.2);
    std::vector<ImageLook> looks(images);
    for (ImageLook& look : looks) {
        const double altitude_m = altitude(random);
        look.altitude_m = told(altitude_m);
        look.map_mean = light_at(*look.altitude_m);
        look.white = 4095.0F;
        const PerChannel light = light_at(altitude_m);
        const double brightness = kBrightness * normal(random);
        for (std::size_t c = 0; c < light.size(); ++c) {
            look.quotient[c] = 1000.0 * std::exp(brightness + kColour * normal(random)) * light[c] /
                               look.map_mean[c];
        }
    }
    return looks;
}

std::vector<std::string> told_of(const std::vector<ImageLook>& looks,
                                 Mosaic mosaic = Mosaic::None) {
    std::vector<std::string> about;
    for (const Suspicion& one : suspicions(looks, mosaic)) about.push_back(one.about);
    return about;
}

const std::vector<std::string> kNothing;
const std::vector<std::string> kAltitude{"altitude"};
const std::vector<std::string> kBayer{"bayer"};

const auto kSurveys = static_cast<std::uint32_t>(campaign(100, 1000));

TEST(SurveyCheck, ARightSurveyLooksRight) {
    for (std::uint32_t seed = 0; seed < kSurveys; ++seed) {
        for (const std::size_t images : {1U, 3U, 12U, 16U}) {
            EXPECT_EQ(told_of(survey(seed, images, [](double h) { return h; })), kNothing)
                << seed << ": " << images;
        }
        // An altimeter that is off by some, or in error by a little.
        EXPECT_EQ(told_of(survey(seed, 16, [](double h) { return h + 0.1; })), kNothing) << seed;
    }
}

// As of a sled that stands, or hovers: rounding and the altimeter's noise are no slope.
TEST(SurveyCheck, ImagesOfOneAltitudeLookRight) {
    for (const double altitude_m : {0.3, 2.0, 2.1, 2.3, 51.7}) {
        ImageLook look;
        look.altitude_m = altitude_m;
        look.map_mean = light_at(altitude_m);
        look.quotient = {731.3, 997.1, 1013.7};
        const std::vector<ImageLook> looks(16, look);
        EXPECT_EQ(told_of(looks), kNothing) << altitude_m;
        EXPECT_TRUE(has(not_checked(looks), "16 images, all at one altitude"));
    }
    constexpr double kAltimeter_m = 0.02;
    for (std::uint32_t seed = 0; seed < kSurveys; ++seed) {
        std::mt19937 random(seed);
        std::normal_distribution<double> noise(0.0, kAltimeter_m);
        std::vector<ImageLook> looks(16);
        for (ImageLook& look : looks) {
            look.altitude_m = 2.0 + noise(random);
            look.map_mean = light_at(*look.altitude_m);
            for (std::size_t c = 0; c < 3; ++c) {
                look.quotient[c] = 1000.0 * light_at(2.0)[c] / look.map_mean[c];
            }
        }
        EXPECT_EQ(told_of(looks), kNothing) << seed;
    }
}

// As in air: red over blue is the same at every altitude, but for rounding.
TEST(SurveyCheck, MapsOfOneColourTellNothingOfRedAndBlue) {
    std::vector<ImageLook> looks(16);
    for (std::size_t i = 0; i < looks.size(); ++i) {
        const double altitude_m = 1.5 + 0.1 * static_cast<double>(i);
        const double light = 1.0 / (altitude_m * altitude_m);
        looks[i].altitude_m = altitude_m;
        looks[i].map_mean = {0.7 * light, 0.9 * light, 1.1 * light};
        looks[i].quotient = {731.3, 997.1, 1013.7};
    }
    EXPECT_EQ(told_of(looks), kNothing);
}

TEST(SurveyCheck, FewImagesAreSaidToBeUnchecked) {
    const auto right = [](double h) { return h; };
    EXPECT_EQ(not_checked(survey(1, 16, right)), "");
    EXPECT_EQ(not_checked(survey(1, 11, right)),
              "altitudes, red for blue, radians: 11 images with light; needed: 12");
}

// One map for all images has no altitude to speak of.
TEST(SurveyCheck, AMapOfAnotherColourIsToldWithoutAltitudes) {
    std::vector<ImageLook> looks(16);
    for (ImageLook& look : looks) {
        look.map_mean = {1.0, 1.0, 1.0};
        look.quotient = {1.0, 10.0, 1000.0};
    }
    const std::vector<Suspicion> found = suspicions(looks, Mosaic::None);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].about, "map");
    EXPECT_EQ(found[0].what,
              "the map and the images differ in colour: R, G and B need gains of 1, 0.1 and 0.001. "
              "Wrong water or camera response?");
    EXPECT_EQ(not_checked(looks), "");
}

TEST(SurveyCheck, AltitudesOfAnotherColumnAreToldFrom) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> heading(1.0, 360.0);
    for (std::uint32_t seed = 0; seed < kSurveys; ++seed) {
        EXPECT_EQ(told_of(survey(seed, 16, [](double h) { return h + 50.0; })).front(), "altitude")
            << seed;
        EXPECT_EQ(told_of(survey(seed, 16, [&](double) { return heading(random); })).front(),
                  "altitude")
            << seed;
        // By colour alone where there are few.
        EXPECT_EQ(told_of(survey(seed, 2, [](double h) { return h + 50.0; })), kAltitude) << seed;
    }
}

TEST(SurveyCheck, RedAndBlueThatAreSwappedAreTold) {
    const auto changed = [](std::uint32_t seed) {
        std::vector<ImageLook> looks = survey(seed, 16, [](double h) { return h; });
        for (ImageLook& look : looks) {
            PerChannel image{};
            for (std::size_t c = 0; c < 3; ++c) image[c] = look.quotient[c] * look.map_mean[c];
            std::swap(image[0], image[2]);
            for (std::size_t c = 0; c < 3; ++c) look.quotient[c] = image[c] / look.map_mean[c];
        }
        return looks;
    };
    for (std::uint32_t seed = 0; seed < kSurveys; ++seed) {
        EXPECT_EQ(told_of(changed(seed), Mosaic::Bggr), kBayer) << seed;
    }
    EXPECT_TRUE(has(suspicions(changed(1), Mosaic::Bggr)[0].what, "--bayer RGGB corrects this"));
    // Where even the greens are wrong, another order of red and blue is no remedy.
    std::vector<ImageLook> no_greens = changed(1);
    for (ImageLook& look : no_greens) look.sites = {{100.0, 180.0, 182.0, 60.0}};
    const std::vector<Suspicion> told = suspicions(no_greens, Mosaic::Grbg);
    ASSERT_EQ(told.size(), 1);
    EXPECT_TRUE(has(told[0].what, "the pattern is RGGB or BGGR"));
}

// Poses of other images turn brightness and colours alike, and no pattern puts them right.
TEST(SurveyCheck, PosesOfOtherImagesAreNoSwappedColours) {
    std::vector<ImageLook> right = survey(1, 16, [](double h) { return h; });
    EXPECT_FALSE(turned_brightness(right));
    EXPECT_FALSE(red_for_blue(right, Mosaic::Rggb));
    std::vector<ImageLook> reversed = right;
    for (std::size_t i = 0; i < right.size(); ++i) {
        const ImageLook& other = right[right.size() - 1 - i];
        for (std::size_t c = 0; c < 3; ++c) {
            reversed[i].quotient[c] =
                other.quotient[c] * other.map_mean[c] / reversed[i].map_mean[c];
        }
    }
    const auto turned = turned_brightness(reversed);
    ASSERT_TRUE(turned);
    EXPECT_EQ(turned->about, "altitude");
    EXPECT_TRUE(has(turned->what, "poses of other images"));
    EXPECT_FALSE(red_for_blue(reversed, Mosaic::Rggb));
}

TEST(SurveyCheck, GreenSitesThatDifferAreNoGreenSites) {
    ImageLook look;
    look.sites = {{100.0, 180.0, 182.0, 60.0}};
    for (const Mosaic right : {Mosaic::Rggb, Mosaic::Bggr})
        EXPECT_EQ(told_of({look}, right), kNothing);
    for (const Mosaic wrong : {Mosaic::Grbg, Mosaic::Gbrg})
        EXPECT_EQ(told_of({look}, wrong), kBayer);
    EXPECT_EQ(
        suspicions(std::vector{look}, Mosaic::Grbg)[0].what,
        "the two sites that GRBG makes green differ by 67 %, the other two by 1.1 %: the pattern "
        "is RGGB or BGGR");
    look.sites = {{100.0, 101.0, 100.0, 100.0}};  // grey: all patterns alike
    EXPECT_EQ(told_of({look}, Mosaic::Grbg), kNothing);
}

RawImage mosaic_of(const std::function<double(std::size_t)>& number) {
    RawImage raw{.width_px = 100, .height_px = 100, .mosaic = Mosaic::Rggb, .samples = {}};
    for (std::size_t i = 0; i < raw.pixels(); ++i) {
        raw.samples.push_back(static_cast<float>(std::floor(number(i))));
    }
    return raw;
}

// A sensor of 12 bits whose file could hold 16.
TEST(SurveyCheck, ALargestNumberThatManySamplesHaveIsAWhiteLevel) {
    std::mt19937 random(1);
    std::normal_distribution<double> light(2500.0, 900.0);
    const auto seen = [&](double most) {
        return mosaic_of([&](std::size_t) { return std::clamp(light(random), 0.0, most); });
    };
    const auto look_of = [&](double most) {
        ImageLook look;
        look.top = top_of(seen(most), true);
        look.white = 65535.0F;
        return look;
    };
    ImageLook look = look_of(4095.0);
    const ImageLook dark = look_of(1e4);
    // The share of a normal distribution from 1.772 standard deviations on: 3.8 %.
    const std::vector<Suspicion> found = suspicions(std::vector{look}, Mosaic::None);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].about, "white-level");
    EXPECT_TRUE(has(found[0].what, "samples are 4095, the largest number of all"));
    EXPECT_NEAR(look.top.at_top / look.top.samples, 0.038, 0.006);
    EXPECT_EQ(told_of({dark}), kNothing) << "none is saturated";
    look.white = 4095.0F;
    EXPECT_EQ(told_of({look}), kNothing) << "it is known";
    look.white = kInfinite;
    EXPECT_TRUE(
        has(suspicions(std::vector{look}, Mosaic::None)[0].what, "there is no white level"));
}

// Light that grows to the right by a tilt, and a floor of patches.
TEST(SurveyCheck, TiltsThatAreRadiansAreTold) {
    std::mt19937 random(1);
    std::normal_distribution<double> patch(0.0, 0.3);
    const auto map_of = [](double tilt) {
        Lightmap map{.width_px = 100, .height_px = 100, .samples = {}};
        for (std::size_t i = 0; i < 30000; ++i) {
            map.samples.push_back(
                static_cast<float>(std::exp(tilt * (static_cast<double>(i % 100) / 100.0 - 0.5))));
        }
        return map;
    };
    const auto looks = [&](bool is_radians) {
        std::vector<ImageLook> all(16);
        for (ImageLook& look : all) {
            const double tilt = patch(random);
            std::vector<double> floor;
            for (int i = 0; i < 100; ++i) floor.push_back(std::exp(patch(random)));
            const Lightmap light = map_of(is_radians ? tilt : tilt / 57.3);
            const RawImage raw = mosaic_of([&](std::size_t i) {
                return 1000.0 * static_cast<double>(light.samples[i]) *
                       floor[i / 1000 * 10 + i % 100 / 10];
            });
            look.as_radians = likeness(raw, SensorLevels{}, map_of(tilt / 57.3), map_of(tilt));
        }
        return all;
    };
    EXPECT_EQ(told_of(looks(true)), std::vector<std::string>{"attitude"});
    EXPECT_EQ(told_of(looks(false)), kNothing) << "a sled as steady as that";
}

// Of floors with patches, the light by the depth maps' other convention, or on the plane where maps
// are other images'; and depths that go with the altitudes, or are those of the next image.
TEST(SurveyCheck, DepthMapsOfAnotherConventionOrOfOtherImagesAreTold) {
    constexpr double kPatches = 0.05;
    enum class Maps { Right, OtherConvention, OtherImages };
    const auto looks = [&](Maps maps) {
        std::mt19937 random(3);
        std::normal_distribution<double> normal(0.0, kPatches);
        std::vector<ImageLook> all(16);
        const auto like = [&](double slope) {
            constexpr double kSpread = 0.1;  // between the two lights, of each of 192 blocks
            constexpr std::size_t kBlocks = 192;
            const double xx = kBlocks * kSpread * kSpread;
            return Likeness{
                .xx = xx, .xy = slope * xx + std::sqrt(xx) * normal(random), .blocks = kBlocks};
        };
        for (std::size_t i = 0; i < all.size(); ++i) {
            all[i].as_other_convention = like(maps == Maps::OtherConvention ? 1.0 : 0.0);
            all[i].as_plane = like(0.0);
            all[i].altitude_m = 2.0 + 0.5 * std::sin(static_cast<double>(i));
            const std::size_t of = maps == Maps::OtherImages ? (i + 2) % all.size() : i;
            all[i].depth_m = 2.0 + 0.5 * std::sin(static_cast<double>(of)) + 0.1 * normal(random);
        }
        return all;
    };
    EXPECT_EQ(told_of(looks(Maps::Right)), kNothing);
    EXPECT_EQ(told_of(looks(Maps::OtherConvention)), std::vector<std::string>{"depth"});
    EXPECT_EQ(told_of(looks(Maps::OtherImages)), std::vector<std::string>{"depth"});
    std::vector<ImageLook> planes = looks(Maps::Right);
    for (ImageLook& look : planes) look.as_plane = look.as_other_convention = {};
    for (ImageLook& look : planes) look.as_plane = {.xx = 1.0, .xy = 0.95, .blocks = 192};
    EXPECT_EQ(told_of(planes), std::vector<std::string>{"depth"});
}

// --- Images of whole frames ----------------------------------------------------------------------

constexpr int kWidth_px = 64;
constexpr int kHeight_px = 48;

// Four lamps' light as a rig has it: it falls off from the middle, less from higher up.
Lightmap frame_map(double altitude_m, double fall_off) {
    Lightmap map{.width_px = kWidth_px, .height_px = kHeight_px, .samples = {}};
    const PerChannel light = light_at(altitude_m);
    for (const double of_channel : light) {
        for (int row = 0; row < kHeight_px; ++row) {
            for (int column = 0; column < kWidth_px; ++column) {
                const double x = (column + 0.5) / kWidth_px - 0.5;
                const double y = ((row + 0.5) / kHeight_px - 0.5) * 0.75;
                const double tan2 = x * x + y * y + 0.05 / altitude_m;
                map.samples.push_back(
                    static_cast<float>(of_channel * std::pow(1.0 + tan2, -fall_off)));
            }
        }
    }
    return map;
}

// How a survey is flown, and what the camera makes of its light.
struct Flown {
    double brightness = 0.3;  // of floors: standard deviations of logarithms
    double texture = 0.2;
    double colour = 0.1;
    double fall_off = 4.0;
    double lens = 0.0;         // of cos^4, which the rig does not know
    double altimeter_m = 0.0;  // its offset
    double exposure = 0.0;     // of an automatic one: standard deviation of its logarithm
    double black = 0.0;        // that is left out
    double gamma = 1.0;
    bool is_corrected = false;
    bool says_srgb = false;
    double least_m = 1.3;
    double most_m = 3.2;
    std::size_t images = 16;
};

ImageLook flown_look(std::mt19937& random, const Flown& flown) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> altitude(flown.least_m, flown.most_m);
    constexpr double kElectronsPerNumber = 4.0;
    constexpr double kFull = 2500.0;  // numbers of the brightest floor
    const double altitude_m = altitude(random);
    const Lightmap light = frame_map(altitude_m, flown.fall_off);
    const Lightmap map = frame_map(altitude_m + flown.altimeter_m, flown.fall_off);
    const double brightest = light_at(flown.least_m)[2];
    const double exposure = std::exp(flown.brightness * normal(random)) * kFull / brightest *
                            std::exp(flown.exposure * normal(random));
    RawImage raw{
        .width_px = kWidth_px, .height_px = kHeight_px, .mosaic = Mosaic::None, .samples = {}};
    std::vector<double> floor;
    for (int i = 0; i < 12 * 16; ++i) floor.push_back(std::exp(flown.texture * normal(random)));
    for (std::size_t c = 0; c < 3; ++c) {
        const double colour = 0.3 * std::exp(flown.colour * normal(random));
        for (std::size_t i = 0; i < raw.pixels(); ++i) {
            const std::size_t column = i % kWidth_px;
            const std::size_t row = i / kWidth_px;
            const double x = (static_cast<double>(column) + 0.5) / kWidth_px - 0.5;
            const double y = ((static_cast<double>(row) + 0.5) / kHeight_px - 0.5) * 0.75;
            const double seen = colour * floor[row / 4 * 16 + column / 4] *
                                std::pow(1.0 + x * x + y * y, -2.0 * flown.lens);
            const double lit =
                flown.is_corrected
                    ? 1000.0 * seen
                    : exposure * seen * static_cast<double>(light.samples[c * raw.pixels() + i]);
            const double noisy =
                std::max(0.0, lit + std::sqrt(lit / kElectronsPerNumber + 4.0) * normal(random));
            const double number = flown.gamma == 1.0
                                      ? noisy + flown.black
                                      : 255.0 * std::pow(noisy / 4000.0, 1.0 / flown.gamma);
            raw.samples.push_back(static_cast<float>(std::round(number)));
        }
    }
    const SensorLevels levels{.black = 0.0F, .white = 65535.0F};
    ImageLook look;
    look.altitude_m = altitude_m + flown.altimeter_m;
    look.white = levels.white;
    look.map_mean = means_of(map);
    look.quotient = middle_quotient(raw, map, levels, 0.0);
    look.frame = frame_look(raw, levels, map);
    look.says_srgb = flown.says_srgb;
    return look;
}

std::vector<std::string> told_of_flown(std::uint32_t seed, const Flown& flown) {
    std::mt19937 random(seed);
    std::vector<ImageLook> looks;
    for (std::size_t i = 0; i < flown.images; ++i) looks.push_back(flown_look(random, flown));
    return told_of(looks);
}

// docs/guides/correct.md has what came of the night's.
std::uint32_t surveys_to_fly() {
    return static_cast<std::uint32_t>(campaign(6, 100));
}

// Of how many is this told, and nothing else.
double share_told(const Flown& flown, const std::vector<std::string>& about) {
    std::uint32_t told = 0;
    for (std::uint32_t seed = 0; seed < surveys_to_fly(); ++seed) {
        const std::vector<std::string> found = told_of_flown(seed, flown);
        if (found == about) {
            ++told;
        } else if (surveys_to_fly() < 100) {
            std::string all;
            for (const std::string& one : found) all += one + " ";
            ADD_FAILURE() << "seed " << seed << ": " << all;
        }
    }
    return static_cast<double>(told) / surveys_to_fly();
}

void expect_told(const char* name, const Flown& flown, const std::vector<std::string>& about) {
    SCOPED_TRACE(name);
    constexpr double kNearlyAll = 0.99;
    const double share = share_told(flown, about);
    EXPECT_GE(share, kNearlyAll);
    testing::Test::RecordProperty(name, std::to_string(share));
    if (surveys_to_fly() >= 100) fmt::print("{}: {}\n", name, share);
}

TEST(SurveyCheck, FramesOfRightSurveysLookRight) {
    expect_told("as the rig says", {}, kNothing);
    expect_told("even floors", {.brightness = 0.05, .texture = 0.05, .colour = 0.02}, kNothing);
    expect_told("rough floors", {.brightness = 0.4, .texture = 0.5, .colour = 0.2}, kNothing);
    expect_told("an unknown lens", {.lens = 1.0}, kNothing);
    expect_told("an altimeter that is off", {.altimeter_m = 0.15}, kNothing);
    expect_told("narrow beams", {.fall_off = 10.0}, kNothing);
    expect_told("wide beams", {.fall_off = 1.0}, kNothing);
    expect_told("one altitude", {.least_m = 2.0, .most_m = 2.05}, kNothing);
    expect_told("JPEG of linear numbers", {.says_srgb = true}, kNothing);
}

TEST(SurveyCheck, ABlackLevelThatIsLeftOutIsTold) {
    const std::vector<std::string> black{"black-level"};
    expect_told("64 of 4095", {.black = 64.0}, black);
    expect_told("240 of 4095", {.black = 240.0}, black);
    expect_told("64, narrow beams", {.fall_off = 10.0, .black = 64.0}, black);
    expect_told("64, automatic exposure", {.exposure = 0.3, .black = 64.0}, black);
}

// Where there is a dark part.
TEST(SurveyCheck, ABlackLevelThatIsTooHighIsTold) {
    const std::vector<std::string> black{"black-level"};
    expect_told("36 too high", {.fall_off = 10.0, .black = -36.0}, black);
    expect_told("64 too high", {.fall_off = 10.0, .black = -64.0}, black);
}

TEST(SurveyCheck, GammaEncodedImagesAreTold) {
    const std::vector<std::string> encoding{"encoding"};
    expect_told("sRGB", {.gamma = 2.2, .says_srgb = true}, encoding);
    expect_told("gamma, and no file says so", {.gamma = 2.2}, encoding);
    expect_told("sRGB, one altitude",
                {.gamma = 2.2, .says_srgb = true, .least_m = 2.0, .most_m = 2.05},
                encoding);
    expect_told("sRGB, few images", {.gamma = 2.2, .says_srgb = true, .images = 4}, encoding);
}

TEST(SurveyCheck, ImagesThatAreCorrectedAlreadyAreTold) {
    const std::vector<std::string> corrected{"corrected"};
    expect_told("corrected", {.is_corrected = true}, corrected);
    expect_told("corrected, one altitude",
                {.is_corrected = true, .least_m = 2.0, .most_m = 2.05},
                corrected);
}

// Floors whose patterns are as wide as the frame hide tilts of some degrees: sums as of 192 blocks
// with x of that spread, and y with a slope of the truth and a pattern of the floor, 0.2 wide,
// whose share along x is that of a few independent patterns.
double share_of_tilts_told(double truth) {
    constexpr int kPatterns = 12;
    constexpr double kFloor = 0.14;  // as in one simulated survey of 25 % contrast
    std::uint32_t told = 0;
    const std::uint32_t surveys = 50 * static_cast<std::uint32_t>(is_night() ? 100 : 6);
    for (std::uint32_t seed = 0; seed < surveys; ++seed) {
        std::mt19937 random(seed);
        std::normal_distribution<double> normal;
        std::vector<ImageLook> looks(24);
        for (ImageLook& look : looks) {
            const double spread = 0.035 * std::abs(normal(random));
            const double x = spread * std::sqrt(192.0);
            const double along = kFloor * std::sqrt(192.0 / kPatterns) * normal(random);
            look.as_radians = {.xx = x * x, .xy = x * (truth * x + along), .blocks = 192};
        }
        if (!told_of(looks).empty()) ++told;
    }
    return static_cast<double>(told) / surveys;
}

TEST(SurveyCheck, TiltsInRadiansAreToldOfTwentyFourImages) {
    constexpr double kFewFalse = 0.01;
    constexpr double kMost = 0.75;
    const double right = share_of_tilts_told(0.0);
    const double wrong = share_of_tilts_told(1.0);
    EXPECT_LE(right, kFewFalse);
    EXPECT_GE(wrong, kMost);
    if (surveys_to_fly() >= 100) fmt::print("degrees {}, radians {}\n", right, wrong);
}

// Of 24 images between 2.14 and 3.2 m, by a rig at 2 m.
TEST(SurveyCheck, AltitudesInAnotherUnitThanTheRigsAreTold) {
    const auto told = [](double factor, double rig_m) {
        const std::vector<ImageLook> looks = survey(1, 16, [&](double h) { return factor * h; });
        const std::vector<Suspicion> found = suspicions(looks, Mosaic::None, rig_m);
        return found.empty() ? "" : found[0].about + ": " + found[0].what;
    };
    EXPECT_EQ(told(1.0, 2.0), "");
    EXPECT_EQ(told(1.0, 1.0), "");
    EXPECT_TRUE(has(told(1.0 / 0.3048, 2.0), "if they are in feet"));
    EXPECT_TRUE(has(told(1000.0, 2.0), "if they are in millimetres"));
    EXPECT_TRUE(has(told(100.0, 2.0), "if they are in centimetres"));
    EXPECT_TRUE(has(told(27.0, 2.0), "another column"));
    EXPECT_TRUE(has(told(1.0, 40.0), "another column or rig?"));
}

// Exposures of 8, 4, 2 and 1 ms that need factors of 1, 1.14, 1.4 and 2: levels go as their cube
// root, for 2 = 8^(1/3).
TEST(SurveyCheck, ExposuresThatLevelsDoNotFollowAreTold) {
    std::vector<ImageLook> looks(16);
    for (std::size_t i = 0; i < looks.size(); ++i) {
        constexpr std::array kFactors{1.0, 1.14, 1.4, 2.0};
        looks[i].stated_exposure = 8.0 / static_cast<double>(1U << i % 4);
        looks[i].level = -std::log(kFactors.at(i % 4));
    }
    const auto doubt = exposure_doubt(looks, ExposureBy::Model);
    ASSERT_TRUE(doubt.has_value());
    EXPECT_TRUE(has(doubt->what, "vary 8-fold, but the images' levels go as their power 0.3"));
    for (ImageLook& look : looks) look.level = std::log(*look.stated_exposure);
    EXPECT_FALSE(exposure_doubt(looks, ExposureBy::Model).has_value());
    for (ImageLook& look : looks) look.stated_exposure.reset();
    EXPECT_FALSE(exposure_doubt(looks, ExposureBy::Model).has_value());
}

// Floors that vary by 20 %; every other image is of another dive, with twice the exposure. A
// shutter does not change the light of a flash.
TEST(SurveyCheck, ExposuresThatAreNotUsedAreTold) {
    std::mt19937 random(3);
    std::normal_distribution<double> floor(0.0, 0.2);
    std::vector<ImageLook> looks(16);
    for (std::size_t i = 0; i < looks.size(); ++i) {
        looks[i].stated_exposure = i % 2 == 0 ? 4.0 : 8.0;
        looks[i].quotient.fill(*looks[i].stated_exposure * std::exp(floor(random)));
    }
    const auto doubt = exposure_doubt(looks, ExposureBy::Nothing);
    ASSERT_TRUE(doubt.has_value());
    EXPECT_TRUE(has(doubt->what, "the Exif exposures vary 2-fold"));
    EXPECT_TRUE(has(doubt->what, "--exposure exif"));
    EXPECT_FALSE(exposure_doubt(looks, ExposureBy::Exif).has_value());
    for (ImageLook& look : looks)
        for (double& quotient : look.quotient) quotient /= *look.stated_exposure;
    EXPECT_FALSE(exposure_doubt(looks, ExposureBy::Nothing).has_value());
}

}  // namespace
}  // namespace aphotic::survey_check_test
