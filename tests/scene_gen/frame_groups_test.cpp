// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/frame_groups.h"

#include "rig/geometry.h"
#include "rig/rig_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace aphotic::frame_groups_test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr unsigned kSeed = 20240612;
// A few roundings of a wavelength in nm.
constexpr double kRounding = 1e-10;
// A pixel covers 1/n of the floor that it covers without a port, and n of 400 nm is 1.1 % more than
// that of 720 nm: so much it matters whose pixels are counted. A third of it again, for pixels
// towards the corner cover ever less.
constexpr double kWhosePixels = 0.015;

Rig rig_of(const std::string& scene) {
    return read_rig(std::string(APHOTIC_SOURCE_DIR) + "/scenes/" + scene);
}

// --- Shift of a corner -----------------------------------------------------------------------

TEST(CornerShift, IsZeroWithoutAPort) {
    const Rig rig = rig_of("habcam.toml");
    EXPECT_EQ(corner_shift_px(rig, 400.0, 720.0), 0.0);
    EXPECT_EQ(corner_shift_px(rig, 650.0, 450.0), 0.0);
}

TEST(CornerShift, IsZeroBetweenEqualWavelengths) {
    const Rig rig = rig_of("port.toml");
    for (const double nm : {400.0, 550.0, 720.0}) {
        EXPECT_EQ(corner_shift_px(rig, nm, nm), 0.0) << nm;
    }
}

// A rig so far from the floor that the port's size does not matter, and whose image's corner looks
// along this angle in the water at 550 nm. By Snell sin(air) = n sin(water), at whole pixels.
Rig far_rig_with_corner_at(double angle_deg) {
    Rig rig = rig_of("port.toml");
    rig.sled.altitude_m = 1000.0;
    const double sin_air = seawater_index(550.0, 35.0, 10.0) * std::sin(angle_deg * kDegree);
    const double radius_px =
        rig.camera.focal_length_m * std::tan(std::asin(sin_air)) / rig.camera.pixel_pitch_m;
    rig.camera.width_px = static_cast<int>(std::lround(2.0 * 0.8 * radius_px));
    rig.camera.height_px = static_cast<int>(std::lround(2.0 * 0.6 * radius_px));
    return rig;
}

// Lateral colour of a flat port for a far object, blue (450 nm) against red (650 nm), f = 12 mm,
// 6.45 um pixels, 35 psu, 10 C: published to two digits.
TEST(CornerShift, HasTheLateralColourOfAFlatPort) {
    constexpr double kTwoDigits = 0.05;
    struct Figure {
        double angle_deg;
        double pixels;
    };
    for (const Figure& figure : {Figure{5.0, 1.4}, {10.0, 2.9}, {15.0, 4.8}, {20.0, 7.5}}) {
        const Rig rig = far_rig_with_corner_at(figure.angle_deg);
        EXPECT_NEAR(corner_shift_px(rig, 450.0, 650.0),
                    figure.pixels,
                    kTwoDigits + kWhosePixels * figure.pixels)
            << figure.angle_deg << " degrees, " << rig.camera.width_px << " by "
            << rig.camera.height_px << " pixels";
    }
}

// docs/physics.md: 6.1 pixels in the corners of scenes/port.toml, on a level floor at 2 m.
TEST(CornerShift, HasTheFigureOfTheManual) {
    constexpr double kTwoDigits = 0.05;
    EXPECT_NEAR(corner_shift_px(rig_of("port.toml"), 450.0, 650.0), 6.1, kTwoDigits);
}

// Column at which the ray of a wavelength meets the plane at the altitude this far from the axis,
// along the image's diagonal, by bisection; in pixels from the middle.
double radius_px(const Rig& rig, double from_axis_m, double lambda_nm) {
    const Camera& camera = rig.camera;
    const double half_px = 0.5 * std::hypot(camera.width_px, camera.height_px);
    double low = 0.0;
    double high = 2.0 * half_px;
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        const double share = middle / half_px;
        const WaterRay ray = pixel_ray(rig,
                                       0.5 * camera.width_px * (1.0 - share),
                                       0.5 * camera.height_px * (1.0 - share),
                                       lambda_nm);
        const double down_m = (rig.sled.altitude_m - ray.origin_m.z()) / ray.direction.z();
        const Eigen::Vector3d point_m = ray.origin_m + down_m * ray.direction;
        (point_m.head<2>().norm() < from_axis_m ? low : high) = middle;
    }
    return low;
}

// What the formula stands for: how many pixels apart a floor point appears in the two.
TEST(CornerShift, IsHowFarApartAPointAppears) {
    const Rig rig = rig_of("port.toml");
    for (const double blue_nm : {400.0, 450.0, 520.0}) {
        for (const double red_nm : {560.0, 650.0, 720.0}) {
            const WaterRay corner = pixel_ray(rig, 0.0, 0.0, red_nm);
            const double down_m =
                (rig.sled.altitude_m - corner.origin_m.z()) / corner.direction.z();
            const double from_axis_m =
                (corner.origin_m + down_m * corner.direction).head<2>().norm();
            const double apart_px =
                radius_px(rig, from_axis_m, blue_nm) - radius_px(rig, from_axis_m, red_nm);
            EXPECT_NEAR(corner_shift_px(rig, blue_nm, red_nm) / apart_px, 1.0, kWhosePixels)
                << blue_nm << " against " << red_nm << " nm: " << apart_px << " pixels";
        }
    }
}

TEST(CornerShift, IsNearlyTheSameEitherWay) {
    const Rig rig = rig_of("port.toml");
    for (const double a_nm : {400.0, 500.0}) {
        for (const double b_nm : {520.0, 720.0}) {
            const double there = corner_shift_px(rig, a_nm, b_nm);
            EXPECT_GT(there, 0.0);
            EXPECT_NEAR(corner_shift_px(rig, b_nm, a_nm) / there, 1.0, kWhosePixels)
                << a_nm << " and " << b_nm << " nm: " << there << " pixels";
        }
    }
}

// Indices fall all the way, so shifts along one line add up.
TEST(CornerShift, AddsUpOverTheRange) {
    const Rig rig = rig_of("port.toml");
    const double whole = corner_shift_px(rig, 400.0, 720.0);
    const double parts = corner_shift_px(rig, 400.0, 480.0) + corner_shift_px(rig, 480.0, 600.0) +
                         corner_shift_px(rig, 600.0, 720.0);
    EXPECT_NEAR(parts / whole, 1.0, kWhosePixels) << whole << " pixels";
    double last = 0.0;
    for (double nm = 410.0; nm <= 720.0; nm += 10.0) {
        const double shift = corner_shift_px(rig, 400.0, nm);
        EXPECT_GT(shift, last) << nm;
        last = shift;
    }
}

// Coarser pixels over the same field of view.
TEST(CornerShift, CountsPixels) {
    // The pixel that counts reaches farther from the corner: by 1.5 fine ones, of 3e-4 each.
    constexpr double kOnePixelIn = 1e-3;
    const Rig fine = rig_of("port.toml");
    Rig coarse = fine;
    coarse.camera.width_px /= 4;
    coarse.camera.height_px /= 4;
    coarse.camera.pixel_pitch_m *= 4.0;
    EXPECT_NEAR(corner_shift_px(coarse, 450.0, 650.0) / corner_shift_px(fine, 450.0, 650.0) * 4.0,
                1.0,
                kOnePixelIn);
}

// --- Groups ----------------------------------------------------------------------------------

std::vector<double> even(double first_nm, double last_nm, int count) {
    std::vector<double> lambda_nm;
    for (int i = 0; i < count; ++i) {
        lambda_nm.push_back(std::lerp(first_nm, last_nm, i / (count - 1.0)));
    }
    return lambda_nm;
}

std::vector<std::size_t> counts_of(const std::vector<FrameGroup>& groups) {
    std::vector<std::size_t> counts;
    for (const FrameGroup& group : groups) counts.push_back(group.count);
    return counts;
}

using Counts = std::vector<std::size_t>;

TEST(FrameGroups, EveryThreeShareWithoutAPort) {
    const Rig rig = rig_of("habcam.toml");
    const auto groups = frame_groups(rig, even(400.0, 720.0, 8), 3, kPixelShift);
    EXPECT_EQ(counts_of(groups), (Counts{3, 3, 2}));
    EXPECT_EQ(counts_of(frame_groups(rig, even(400.0, 720.0, 8), 3, 0.0)), (Counts{3, 3, 2}));
    EXPECT_EQ(counts_of(frame_groups(rig, even(400.0, 720.0, 5), 2, 0.0)), (Counts{2, 2, 1}));
    EXPECT_EQ(counts_of(frame_groups(rig, even(400.0, 720.0, 3), 1, 9.0)), (Counts{1, 1, 1}));
}

TEST(FrameGroups, OfNothingAreNone) {
    EXPECT_TRUE(frame_groups(rig_of("port.toml"), {}, 3, kPixelShift).empty());
}

TEST(FrameGroups, OfABoundOfNothingAreOneEach) {
    const Rig rig = rig_of("port.toml");
    EXPECT_EQ(counts_of(frame_groups(rig, even(400.0, 720.0, 7), 3, 0.0)), Counts(7, 1));
    EXPECT_EQ(counts_of(frame_groups(rig, even(550.0, 550.01, 2), 3, 0.0)), Counts(2, 1));
}

TEST(FrameGroups, OfAHugeBoundAreThrees) {
    const auto groups = frame_groups(rig_of("port.toml"), even(400.0, 720.0, 7), 3, 1e6);
    EXPECT_EQ(counts_of(groups), (Counts{3, 3, 1}));
}

// The frame of one wavelength has its own indices; of several, those halfway from the first to the
// last.
TEST(FrameGroups, HaveTheIndicesOfTheWavelengthHalfway) {
    const std::vector<double> lambda_nm{410.0, 430.0, 470.0, 500.0, 600.0, 650.0};
    const auto threes = frame_groups(rig_of("port.toml"), lambda_nm, 3, 1e6);
    ASSERT_EQ(threes.size(), 2U);
    EXPECT_NEAR(threes[0].index_nm, 440.0, kRounding);
    EXPECT_NEAR(threes[1].index_nm, 575.0, kRounding);
    const auto ones = frame_groups(rig_of("port.toml"), lambda_nm, 3, 0.0);
    ASSERT_EQ(ones.size(), lambda_nm.size());
    for (std::size_t i = 0; i < ones.size(); ++i) EXPECT_EQ(ones[i].index_nm, lambda_nm[i]);
}

// Shift per nanometre at the corner of scenes/port.toml: 6.1 pixels over 200 nm, some 0.03 px/nm.
// So a bound of a quarter lets 5 nm share and 50 not.
TEST(FrameGroups, ShareFramesWhereWavelengthsAreClose) {
    const Rig rig = rig_of("port.toml");
    const std::vector<double> lambda_nm{500.0, 501.0, 502.0, 503.0, 550.0, 600.0, 602.0};
    EXPECT_EQ(counts_of(frame_groups(rig, lambda_nm, 3, kPixelShift)), (Counts{3, 1, 1, 2}));
    EXPECT_EQ(counts_of(frame_groups(rig, lambda_nm, 2, kPixelShift)), (Counts{2, 2, 1, 2}));
}

// All at random: the groups follow each other and hold every wavelength once; none is larger or
// spread farther than allowed, and none ends before it must.
TEST(FrameGroups, AreAsLargeAsTheyMayBe) {
    std::mt19937_64 random(kSeed);
    const auto between = [&](double least, double most) {
        return std::uniform_real_distribution<double>(least, most)(random);
    };
    Rig rig = rig_of("port.toml");
    int shared = 0;
    int parted_by_bound = 0;
    for (int n = 0; n < 200; ++n) {
        rig.sled.altitude_m = between(0.5, 5.0);
        rig.camera.focal_length_m = between(0.008, 0.03);
        std::vector<double> lambda_nm;
        for (double nm = between(400.0, 420.0); nm < 720.0; nm += between(0.1, 30.0)) {
            lambda_nm.push_back(nm);
        }
        const int per_frame = 1 + n % 3;
        const double bound = between(0.0, 1.0);
        const auto groups = frame_groups(rig, lambda_nm, per_frame, bound);
        std::size_t next = 0;
        for (const FrameGroup& group : groups) {
            ASSERT_EQ(group.first, next);
            ASSERT_GE(group.count, 1U);
            ASSERT_LE(group.count, static_cast<std::size_t>(per_frame));
            next += group.count;
            ASSERT_LE(next, lambda_nm.size());
            const double first_nm = lambda_nm[group.first];
            const double last_nm = lambda_nm[next - 1];
            EXPECT_LE(corner_shift_px(rig, first_nm, last_nm), bound)
                << first_nm << " to " << last_nm << " nm";
            EXPECT_NEAR(group.index_nm, 0.5 * (first_nm + last_nm), kRounding);
            shared += group.count > 1 ? 1 : 0;
            if (next == lambda_nm.size() || group.count == static_cast<std::size_t>(per_frame)) {
                continue;
            }
            ++parted_by_bound;
            EXPECT_GT(corner_shift_px(rig, first_nm, lambda_nm[next]), bound)
                << "the group from " << first_nm << " nm ends before " << lambda_nm[next] << " nm";
        }
        EXPECT_EQ(next, lambda_nm.size());
    }
    EXPECT_GT(shared, 100);
    EXPECT_GT(parted_by_bound, 100);
}

// The bound is for the frame's own indices, too: halfway, each is shifted by half as much.
TEST(FrameGroups, ShiftNoWavelengthByMoreThanTheBound) {
    const Rig rig = rig_of("port.toml");
    const std::vector<double> lambda_nm = even(400.0, 720.0, 200);
    for (const double bound : {0.1, kPixelShift, 1.0}) {
        double worst = 0.0;
        for (const FrameGroup& group : frame_groups(rig, lambda_nm, 3, bound)) {
            for (std::size_t i = group.first; i < group.first + group.count; ++i) {
                worst = std::max(worst, corner_shift_px(rig, lambda_nm[i], group.index_nm));
            }
        }
        EXPECT_LE(worst, 0.6 * bound) << "half, and a little for the dispersion's own slope";
        EXPECT_GT(worst, 0.0);
    }
}

}  // namespace
}  // namespace aphotic::frame_groups_test
