// SPDX-License-Identifier: BSD-3-Clause
//
// What is added to POV-Ray's frames against light/veil.h's, whose own tests hold it against closed
// forms: with twice the points, at the pixel itself, and R, G and B by a rule of their own.
#include "scene_gen/veil_planes.h"

#include "base/error.h"
#include "image/exr.h"
#include "light/veil.h"
#include "light/veil_map.h"
#include "scene_gen/render_plan.h"
#include "scene_gen/scene_set.h"
#include "support/refusal.h"
#include "support/temp_folder.h"
#include "support/thread_sanitizer.h"
#include "support/veil_rig.h"

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <vector>

namespace aphotic::veil_planes_test {
namespace {

std::atomic<int> threads_begun = 0;

}  // namespace
}  // namespace aphotic::veil_planes_test

#ifndef APHOTIC_THREAD_SANITIZER
// In place of the C library's, which all of this program calls.
extern "C" int pthread_create(pthread_t* thread,
                              const pthread_attr_t* attributes,
                              void* (*work)(void*),
                              void* argument) noexcept {
    ++aphotic::veil_planes_test::threads_begun;
    static const auto create =
        reinterpret_cast<decltype(&pthread_create)>(::dlsym(RTLD_NEXT, "pthread_create"));
    return create(thread, attributes, work, argument);
}
#endif

namespace aphotic::veil_planes_test {
namespace {

// What a plane is off by, of the veil alone: nothing is known of the floor when it is made.
constexpr double kOfVeil = 1e-4;

// Frames of three wavelengths and of one.
Manifest manifest_of(const Rig& rig) {
    Manifest manifest;
    manifest.width_px = rig.camera.width_px;
    manifest.height_px = rig.camera.height_px;
    const std::vector<double> lambda_nm{450.0, 520.0, 600.0, 680.0};
    for (std::size_t j = 0; j < lambda_nm.size(); ++j) {
        manifest.wavelengths.push_back({.lambda_nm = lambda_nm[j],
                                        .frame = j / kChannels,
                                        .channel = j % kChannels,
                                        .index_nm = lambda_nm[j]});
    }
    return manifest;
}

// By Simpson's rule over the radiance.
std::array<double, kChannels> signals_at(const Rig& rig, const Veil& veil, const VeilSight& sight) {
    constexpr int kSteps = 320;
    const WavelengthRange range = rig.camera.range;
    const double step_nm = (range.last_nm - range.first_nm) / kSteps;
    std::array<double, kChannels> sum{};
    for (int k = 0; k <= kSteps; ++k) {
        const double nm = range.first_nm + k * step_nm;
        const double rule = (k == 0 || k == kSteps ? 1.0 : k % 2 == 1 ? 4.0 : 2.0) / 3.0;
        const double A = veil.radiance(sight.ray, sight.length_m, nm);
        for (std::size_t c = 0; c < kChannels; ++c)
            sum[c] += rule * step_nm * A * rig.camera.sensor.response(static_cast<int>(c), nm);
    }
    return sum;
}

TEST(VeilPlanes, AreTheVeilOfEachPixel) {
    const Rig rig = coast(68, 51);
    const Manifest manifest = manifest_of(rig);
    const TempFolder folder;
    ASSERT_TRUE(write_veil(folder.path(), rig, manifest, 2));
    ExrReader reader(veil_path(folder.path()));
    const std::vector<float> planes = reader.planes(veil_channels(manifest));
    const std::size_t plane = planes.size() / (kChannels + manifest.wavelengths.size());
    const Veil veil(rig, 2 * kVeilPoints);
    for (int row = 2; row < 51; row += 9) {
        for (int column = 1; column < 68; column += 11) {
            const auto at = static_cast<std::size_t>(row * 68 + column);
            const VeilSight sight = sight_of(rig, column + 0.5, row + 0.5, 550.0);
            for (std::size_t j = 0; j < manifest.wavelengths.size(); ++j) {
                const double A =
                    veil.radiance(sight.ray, sight.length_m, manifest.wavelengths[j].lambda_nm);
                EXPECT_NEAR(planes[(kChannels + j) * plane + at], A, kOfVeil * A)
                    << column << ' ' << row << ' ' << j;
            }
            const auto signals = signals_at(rig, veil, sight);
            for (std::size_t c = 0; c < kChannels; ++c)
                EXPECT_NEAR(planes[c * plane + at], signals[c], kOfVeil * signals[c])
                    << column << ' ' << row << ' ' << kChannelNames[c];
        }
    }
}

// More rows than a block has.
TEST(VeilPlanes, BlocksOfRowsJoin) {
    const Rig rig = coast(24, 600);
    const TempFolder folder;
    Manifest manifest = manifest_of(rig);
    manifest.wavelengths.clear();
    ASSERT_TRUE(write_veil(folder.path(), rig, manifest, 2));
    ExrReader reader(veil_path(folder.path()));
    const std::vector<float> planes = reader.planes(veil_channels(manifest));
    const Veil veil(rig, 2 * kVeilPoints);
    for (const int row : {0, 254, 255, 256, 257, 511, 512, 599}) {
        const auto expected = signals_at(rig, veil, sight_of(rig, 12.5, row + 0.5, 550.0));
        EXPECT_NEAR(
            planes[static_cast<std::size_t>(row * 24 + 12)], expected[0], kOfVeil * expected[0])
            << row;
    }
}

TEST(VeilPlanes, ClearWaterHasNone) {
    Rig rig = coast(68, 51);
    rig.water.scatterers.clear();
    const TempFolder folder;
    EXPECT_FALSE(write_veil(folder.path(), rig, manifest_of(rig), 2));
    EXPECT_FALSE(std::filesystem::exists(veil_path(folder.path())));
}

TEST(VeilPlanes, WithoutFramesOnlyTheBareFloorHasThem) {
    Rig rig = coast(68, 51);
    rig.objects.push_back({.name = "rock",
                           .shape = Sphere{.centre_m = {0.0, 0.0, 1.8}, .radius_m = 0.1},
                           .reflectance = rig.seafloor.reflectance});
    EXPECT_EQ(refusal_of([&] { require_bare_floor_under_veil(rig); }),
              "found the object 'rock'; allowed with water that scatters: the bare floor");
}

// A plan's promise holds what the planes are off by, and keeps the tolerance all the same.
TEST(VeilPlanes, TheirErrorIsPartOfThePromise) {
    const Rig rig = coast(68, 51);
    const RenderPlan plan = plan_render(rig, {});
    EXPECT_GE(plan.veil_error, kVeilOfSignal);
    for (const RuleQuality& quality : plan.quality) EXPECT_GE(quality.error, plan.veil_error);
    EXPECT_LE(plan.promise(), plan.tolerance);
}

TEST(VeilPlanes, TakeAsManyThreadsAsTheyMay) {
    const Rig rig = coast(24, 64);
    Manifest manifest = manifest_of(rig);
    manifest.wavelengths.clear();
    const TempFolder folder;
    const auto begun_by = [&](int threads) {
        threads_begun = 0;
        EXPECT_TRUE(write_veil(folder.path(), rig, manifest, threads));
        return threads_begun.load();
    };
    EXPECT_EQ(begun_by(1), 0);
    if (kHasThreadSanitizer) return;  // whose threads are not counted
    EXPECT_GT(begun_by(2), 0);
}

}  // namespace
}  // namespace aphotic::veil_planes_test
