// SPDX-License-Identifier: BSD-3-Clause
//
// What is said of a camera: parts of its files, and exposures by the ratios that they stand for.
#include "survey/images/camera_numbers.h"

#include "base/error.h"
#include "support/refusal.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <functional>
#include <string>

namespace aphotic::camera_numbers_test {
namespace {

// HabCam's two cameras in one file.
constexpr PlaneSize kPair{2720, 1024};

TEST(CameraNumbers, HalvesAreEqualPartsSideBySide) {
    EXPECT_EQ(crop_of({}, kPair), (Crop{0, 0, 2720, 1024}));
    EXPECT_EQ(crop_of({.half = Half::Left}, kPair), (Crop{0, 0, 1360, 1024}));
    EXPECT_EQ(crop_of({.half = Half::Right}, kPair), (Crop{1360, 0, 1360, 1024}));
    EXPECT_EQ(refusal_of([] {
                  (void)crop_of({.half = Half::Right}, {2721, 1024});
              }),
              "--half: found an image of 2721 x 1024 pixels; allowed: an even width");
}

TEST(CameraNumbers, ACropLiesWithinTheFile) {
    const auto fault = [](const Crop& crop) {
        return refusal_of([&] { EXPECT_EQ(crop_of({.crop = crop}, kPair), crop); });
    };
    EXPECT_EQ(fault({1360, 0, 1360, 1024}), kAccepted);
    EXPECT_EQ(fault({1361, 0, 1360, 1024}),
              "--crop 1361,0,1360,1024: reaches beyond the image; allowed: within 2720 x 1024 "
              "pixels");
    EXPECT_NE(fault({0, 1, 1, 1024}), kAccepted);
    EXPECT_NE(fault({2147483647, 0, 2147483647, 1}), kAccepted);
}

TEST(CameraNumbers, ACropIsFourWholeNumbers) {
    EXPECT_EQ(crop_named("1,2,30,40"), (Crop{1, 2, 30, 40}));
    for (const char* wrong : {"",
                              "1",
                              "1,2,3",
                              "1,2,3,4,",
                              "1,2,3,4,5",
                              " 1,2,3,4",
                              "1.0,2,3,4",
                              "-1,2,3,4",
                              "1,-2,3,4",
                              "1,2,0,4",
                              "1,2,3,0",
                              "1,2,3,99999999999"})
        EXPECT_EQ(crop_named(wrong), std::nullopt) << wrong;
}

// A stop is a factor of two: of time, of ISO, and of the square root of two in f-number.
TEST(CameraNumbers, AStopMoreOfAnyIsTwiceTheExposure) {
    constexpr double kRounding = 1e-12;
    const CameraNumbers camera{.exposure_by = ExposureBy::Exif,
                               .reference = {.time_s = 0.004, .iso = 100.0, .f_number = 5.6}};
    const auto exposure = [&](double time_s, double iso, double f_number) {
        return relative_exposure({.time_s = time_s, .iso = iso, .f_number = f_number}, camera);
    };
    EXPECT_EQ(exposure(0.004, 100.0, 5.6), 1.0);
    EXPECT_NEAR(exposure(0.008, 100.0, 5.6), 2.0, kRounding);
    EXPECT_NEAR(exposure(0.004, 200.0, 5.6), 2.0, kRounding);
    EXPECT_NEAR(exposure(0.004, 100.0, 5.6 / std::sqrt(2.0)), 2.0, kRounding);
}

TEST(CameraNumbers, OnlyWhatTheReferenceTellsCounts) {
    const CameraNumbers camera{.exposure_by = ExposureBy::Flash, .reference = {.iso = 100.0}};
    EXPECT_EQ(relative_exposure({.time_s = 8.0, .iso = 400.0, .f_number = 2.0}, camera), 4.0);
    EXPECT_EQ(refusal_of([&] { (void)relative_exposure({.time_s = 8.0}, camera); }),
              "--exposure: its Exif has no ISO number");
}

TEST(CameraNumbers, AreNotedAsTheOptionsNameThem) {
    const auto json = to_json(CameraNumbers{.mosaic = Mosaic::Grbg,
                                            .black_level = 64.0F,
                                            .white_level = 4095.0F,
                                            .crop = Crop{1, 2, 3, 4}});
    EXPECT_EQ(json["bayer"], "GRBG");
    EXPECT_EQ(json["crop"], "1,2,3,4");
    EXPECT_EQ(json["black_level"], 64.0);
    EXPECT_EQ(json["white_level"], 4095.0);
    EXPECT_TRUE(json["half"].is_null());
    EXPECT_TRUE(json["exposure"].is_null());
    EXPECT_EQ(to_json(CameraNumbers{.half = Half::Right})["half"], "right");
}

TEST(CameraNumbers, HaveTheNoiseThatTheRigTells) {
    EXPECT_EQ(electrons_per_number({}), 0.0) << "not told";
    EXPECT_EQ(dark_noise_dn({}), std::nullopt);
    EXPECT_EQ(dark_noise_dn({.read_noise_e = 8.0}), std::nullopt) << "in which numbers?";
    const Readout told{.gain_dn_per_e = 0.25, .read_noise_e = 8.0};
    EXPECT_EQ(electrons_per_number(told), 4.0);
    EXPECT_DOUBLE_EQ(dark_noise_dn(told).value(), std::sqrt(4.0 + 1.0 / 12.0));
}

}  // namespace
}  // namespace aphotic::camera_numbers_test
