// SPDX-License-Identifier: BSD-3-Clause
//
// Frames of random rigs by POV-Ray: each pixel is the reference's, within the rounding of half
// floats; so what tests/validation/tracer_properties_test.cpp says of every image holds of them.
#include "scene_gen/resource_needs.h"
#include "support/random_rig.h"
#include "support/rendered.h"
#include "validation/tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace aphotic::render_properties_test {
namespace {

constexpr std::uint64_t kSeed = 6'200;
constexpr int kRigs = 6;  // each image is a run of POV-Ray for each wavelength behind a port
constexpr int kSide_px = 9;
constexpr LampGrid kLamps{.across = 3, .along = 2};

std::vector<double> wavelengths_of(const Rig& rig) {
    const WavelengthRange& range = rig.camera.range;
    std::vector<double> lambda_nm;
    for (const double share : {0.1, 0.5, 0.9}) {
        lambda_nm.push_back(std::lerp(range.first_nm, range.last_nm, share));
    }
    return lambda_nm;
}

TEST(RenderedFrames, OfRandomRigsAreTheReferences) {
    int lit = 0;
    for (const std::uint64_t seed : rig_seeds(kSeed, 100 * kRigs)) {
        const Rig rig = with_pixels(random_full_rig(seed), kSide_px, kSide_px);
        SCOPED_TRACE(in_words(seed, rig));
        const Tracer tracer(rig,
                            {.signals = false,
                             .planes_nm = wavelengths_of(rig),
                             .lamps_across = kLamps.across,
                             .lamps_along = kLamps.along});
        const std::vector<double> traced = tracer.rows(0, kSide_px);
        if (std::ranges::max(traced) == 0.0) continue;
        const std::vector<unsigned char> on_edge = tracer.on_edges(rig.camera.range);
        const TempFolder folder;
        // A frame for each wavelength whose rays are its own.
        const SceneSet set =
            scenes_of(rig, wavelengths_of(rig), {.pixel_shift = 0.0, .emitter_lamps = kLamps});
        const Manifest manifest =
            render(find_povray(""), folder.path(), set, {.jobs = 1, .report = {}}).manifest;
        for (std::size_t j = 0; j < manifest.wavelengths.size(); ++j) {
            const PlannedWavelength& w = manifest.wavelengths[j];
            const auto file = image_path(folder.path(), manifest.frames[w.frame]);
            EXPECT_LE(std::filesystem::file_size(file),
                      largest_files({.width_px = kSide_px, .height_px = kSide_px, .wavelengths = 3})
                          .frame_bytes);
            const auto samples =
                ExrReader(file).planes(std::vector{std::string(kChannelNames[w.channel])});
            for (std::size_t i = 0; i < samples.size(); ++i) {
                if (on_edge[i] != 0) continue;
                const double expected = std::ldexp(traced[j * samples.size() + i], w.exposure_log2);
                EXPECT_NEAR(
                    samples[i], expected, kHalfFloatError * std::max(expected, kSmallestNormalHalf))
                    << w.lambda_nm << " nm, pixel " << i;
            }
        }
        if (++lit == kRigs || testing::Test::HasFailure()) return;
    }
    ADD_FAILURE() << "only " << lit << " of the rigs light what they see";
}

}  // namespace
}  // namespace aphotic::render_properties_test
