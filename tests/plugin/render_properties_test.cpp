// SPDX-License-Identifier: BSD-3-Clause
//
// What must hold of every rig's frames by POV-Ray, whatever the rig: the laws of
// tests/validation/tracer_properties_test.cpp, on a few tiny images, within the rounding of half
// floats. The radiance is what the frames hold less their exposure.
#include "scene_gen/disk_estimate.h"
#include "support/random_rig.h"
#include "support/rendered.h"
#include "support/rig_changes.h"
#include "validation/tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

namespace aphotic::render_properties_test {
namespace {

constexpr std::uint64_t kSeed = 6'200;
constexpr int kRigs = 2;  // each image is a run of POV-Ray, 0.7 s
constexpr int kSide_px = 9;
constexpr std::size_t kPixels = std::size_t{kSide_px} * kSide_px;

// Two frames, each rounded by itself, and POV-Ray's arithmetic in single precision twice.
constexpr double kTwoFrames = 2.0 * kHalfFloatError;
// The sum of six frames at most, and that of all: each rounds relative to its own value, and they
// are positive, so the sum is right to one rounding.
constexpr double kSumOfFrames = 2.0 * kHalfFloatError;

struct Radiance {
    std::vector<double> samples;  // planes of three wavelengths
    std::vector<double> black;    // by sample: where the frame's half floats lose digits
    std::uintmax_t frame_bytes = 0;
};

std::vector<double> wavelengths_of(const Rig& rig) {
    const WavelengthRange& range = rig.camera.range;
    std::vector<double> lambda_nm;
    for (const double share : {0.1, 0.5, 0.9}) {
        lambda_nm.push_back(std::lerp(range.first_nm, range.last_nm, share));
    }
    return lambda_nm;
}

Radiance rendered(const Rig& rig) {
    const TempFolder folder;
    const SceneSet set =
        scenes_of(rig,
                  wavelengths_of(rig),
                  {.pixel_shift = 100.0, .emitter_lamps = LampGrid{.across = 3, .along = 2}});
    const RenderResult result =
        render(find_povray(""), folder.path(), set, {.jobs = 1, .report = {}});
    Radiance radiance;
    const auto pixels = static_cast<std::size_t>(rig.camera.width_px) *
                        static_cast<std::size_t>(rig.camera.height_px);
    for (const PlannedWavelength& w : result.manifest.wavelengths) {
        const std::filesystem::path file =
            image_path(folder.path(), result.manifest.frames[w.frame]);
        radiance.frame_bytes = std::filesystem::file_size(file);
        ExrReader frame(file);
        std::vector<float> samples(pixels);
        const std::string channel(kChannelNames[w.channel]);
        frame.read_rows(0, rig.camera.height_px, std::span(&channel, 1), samples);
        for (const float sample : samples) {
            radiance.samples.push_back(std::ldexp(static_cast<double>(sample), -w.exposure_log2));
            radiance.black.push_back(std::ldexp(kSmallestNormalHalf, -w.exposure_log2));
        }
    }
    return radiance;
}

std::vector<unsigned char> edges_of(const Rig& rig) {
    const Tracer tracer(
        rig,
        {.signals = false, .planes_nm = wavelengths_of(rig), .lamps_across = 3, .lamps_along = 2});
    return tracer.on_edges(rig.camera.range);
}

// The first seeds from kSeed on whose rigs light what they see.
void for_each_rig(const std::function<void(const Rig&, const Radiance&)>& claim) {
    int lit = 0;
    for (const std::uint64_t seed : rig_seeds(kSeed, 100 * kRigs)) {
        const Rig rig = with_pixels(random_full_rig(seed), kSide_px, kSide_px);
        SCOPED_TRACE(in_words(seed, rig));
        const Tracer tracer(rig, {.signals = false, .planes_nm = wavelengths_of(rig)});
        if (std::ranges::max(tracer.rows(0, kSide_px)) == 0.0) continue;
        claim(rig, rendered(rig));
        if (++lit == kRigs || testing::Test::HasFailure()) return;
    }
    ADD_FAILURE() << "only " << lit << " of the rigs light what they see";
}

// Relative to the expected sample, or to where the darker of both exposures loses digits.
void expect_same(const Radiance& image,
                 const std::vector<double>& expected,
                 const std::vector<double>& expected_black,
                 double tolerance,
                 const std::vector<unsigned char>& on_edge) {
    ASSERT_EQ(image.samples.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        if (on_edge[i % on_edge.size()] != 0) continue;
        const double black = std::max(image.black[i], expected_black[i]);
        EXPECT_NEAR(image.samples[i], expected[i], tolerance * std::max(expected[i], black))
            << "plane " << i / on_edge.size() << ", pixel " << i % on_edge.size();
    }
}

std::vector<double> times(std::vector<double> samples, double factor) {
    for (double& sample : samples) sample *= factor;
    return samples;
}

std::vector<double> rearranged(const std::vector<double>& samples,
                               const std::function<std::size_t(int column, int row)>& from) {
    std::vector<double> result;
    for (std::size_t first = 0; first < samples.size(); first += kPixels) {
        for (int row = 0; row < kSide_px; ++row) {
            for (int column = 0; column < kSide_px; ++column) {
                result.push_back(samples[first + from(column, row)]);
            }
        }
    }
    return result;
}

std::size_t pixel_of(int column, int row) {
    return static_cast<std::size_t>(row) * kSide_px + static_cast<std::size_t>(column);
}

TEST(RenderedFrames, ScaleWithTheInverseSquare) {
    for_each_rig([](const Rig& rig, const Radiance& image) {
        for (const double s : {0.4, 7.0}) {
            SCOPED_TRACE(s);
            expect_same(rendered(scaled(rig, s)),
                        times(image.samples, 1.0 / (s * s)),
                        times(image.black, 1.0 / (s * s)),
                        kTwoFrames,
                        edges_of(rig));
        }
    });
}

TEST(RenderedFrames, FollowThePower) {
    for_each_rig([](const Rig& rig, const Radiance& image) {
        constexpr double kFactor = 3.7;
        expect_same(rendered(with_power(rig, kFactor)),
                    times(image.samples, kFactor),
                    times(image.black, kFactor),
                    kTwoFrames,
                    edges_of(rig));
    });
}

TEST(RenderedFrames, AddUpOverTheStrobes) {
    for_each_rig([](const Rig& rig, const Radiance& image) {
        std::vector<double> sum(image.samples.size());
        std::vector<double> black(image.samples.size());
        for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
            const Radiance part = rendered(only_strobe(rig, s));
            for (std::size_t i = 0; i < sum.size(); ++i) {
                sum[i] += part.samples[i];
                black[i] += part.black[i];
            }
        }
        expect_same(image, sum, black, kSumOfFrames, edges_of(rig));
    });
}

TEST(RenderedFrames, AreMirroredWithTheRig) {
    for_each_rig([](const Rig& rig, const Radiance& image) {
        const auto from = [](int column, int row) { return pixel_of(kSide_px - 1 - column, row); };
        expect_same(rendered(mirrored(rig)),
                    rearranged(image.samples, from),
                    image.black,
                    kTwoFrames,
                    edges_of(mirrored(rig)));
    });
}

TEST(RenderedFrames, AreTurnedWithTheRig) {
    for_each_rig([](const Rig& any, const Radiance&) {
        Rig rig = any;
        for (Strobe& strobe : rig.strobes) strobe.emitter.reset();
        const Radiance image = rendered(rig);
        const auto from = [](int column, int row) { return pixel_of(row, kSide_px - 1 - column); };
        expect_same(rendered(turned(rig)),
                    rearranged(image.samples, from),
                    image.black,
                    kTwoFrames,
                    edges_of(turned(rig)));
    });
}

TEST(RenderedFrames, AreNotBrighterForMoreLoss) {
    for_each_rig([](const Rig& rig, const Radiance& image) {
        const Radiance murkier = rendered(with_loss(rig, 0.01));
        for (std::size_t i = 0; i < image.samples.size(); ++i) {
            EXPECT_LE(murkier.samples[i],
                      (1.0 + kTwoFrames) * std::max(image.samples[i], image.black[i]));
        }
    });
}

TEST(RenderedFrames, OfDarkLampsAreBlackAndNoFileIsLargerThanForetold) {
    for_each_rig([](const Rig& rig, const Radiance& image) {
        for (const double sample : image.samples) EXPECT_TRUE(std::isfinite(sample) && sample >= 0);
        EXPECT_LE(image.frame_bytes,
                  largest_files({.width_px = kSide_px, .height_px = kSide_px, .wavelengths = 3})
                      .frame_bytes);
        for (const double sample : rendered(with_power(rig, 0.0)).samples) EXPECT_EQ(sample, 0.0);
    });
}

}  // namespace
}  // namespace aphotic::render_properties_test
