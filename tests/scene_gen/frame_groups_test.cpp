// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/frame_groups.h"

#include "light/dispersion.h"
#include "rig/file/rig_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace aphotic::frame_groups_test {
namespace {

constexpr unsigned kSeed = 20240612;
// A few roundings of a wavelength in nm.
constexpr double kRounding = 1e-10;

Rig rig_of(const std::string& scene) {
    return read_rig(std::string(APHOTIC_SOURCE_DIR) + "/scenes/" + scene);
}

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

}  // namespace
}  // namespace aphotic::frame_groups_test
