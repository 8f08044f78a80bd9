// SPDX-License-Identifier: BSD-3-Clause
//
// What must hold of every rig's image, whatever the rig, by the reference: laws of scale, of power
// and of sums, symmetries, what is never and what is always dark. The rigs are random; the laws
// come from the formula at the head of validation/tracer.h, and need no expected image.
//
// The exposures of POV-Ray's frames are held against the same images at the end.
#include "image/frame_check.h"
#include "scene_gen/pov_scene.h"
#include "scene_gen/render_plan.h"
#include "support/effort.h"
#include "support/random_rig.h"
#include "support/rig_changes.h"
#include "validation/comparison.h"
#include "validation/tracer.h"
#include "validation/validation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace aphotic::tracer_properties_test {
namespace {

constexpr std::uint64_t kSeed = 71'000;
constexpr int kRigs = cases(400);
constexpr int kRigsOfSignals =
    cases(120);  // the grid of wavelengths of one is as long as ten images

constexpr int kWidth_px = 9;
constexpr int kHeight_px = 7;
// For the wavelengths at which radiance is looked at, as shares of the camera's range.
constexpr std::array kShares{0.05, 0.5, 0.93};

// A sample takes some hundred operations on doubles, 1.1e-16 each; its exponent K l, up to 150
// here, takes them along as 150 more. On a ball at a glance the distance is a root of a difference,
// which off the outline (kEdgePx) costs up to four digits.
constexpr double kRounding = 1e-12;
constexpr double kRoundingOfObjects = 1e-9;
// The same terms, all of one sign, summed in another order: up to six lamps of six strobes, each
// sum rounded to 1.1e-16 in both images.
constexpr double kReordered = 1e-14;
// Both images have a grid of wavelengths of their own, each exact to kSpectralError.
constexpr double kTwoGrids = 2.0 * kSpectralError;
// One rounding of exp() and of the product and sum that follow: it need not fall with every last
// digit of its argument.
constexpr double kOfExponential = 1e-15;

// Doubles end at 2.2e-308, and lose digits before they do: what is under this has none to compare.
constexpr double kLeastOfAllDigits = 1e-290;

using Image = std::vector<double>;

enum class Planes { Radiance, RadianceAndSignals };

std::vector<double> wavelengths_of(const Rig& rig) {
    std::vector<double> lambda_nm;
    for (const double share : kShares) {
        lambda_nm.push_back(std::lerp(rig.camera.range.first_nm, rig.camera.range.last_nm, share));
    }
    return lambda_nm;
}

// Few lamps stand for an emitter: the laws hold for any number.
TraceOptions options_for(const Rig& rig, Planes planes) {
    return {.signals = planes == Planes::RadianceAndSignals,
            .planes_nm = wavelengths_of(rig),
            .threads = 1,
            .lamps_across = 3,
            .lamps_along = 2};
}

Image traced(const Rig& rig, Planes planes = Planes::Radiance) {
    return Tracer(rig, options_for(rig, planes)).rows(0, rig.camera.height_px);
}

void for_each_rig(int rigs, const std::function<void(const Rig&)>& claim) {
    for (const std::uint64_t seed : rig_seeds(kSeed, rigs)) {
        const Rig rig = with_pixels(random_full_rig(seed), kWidth_px, kHeight_px);
        SCOPED_TRACE(in_words(seed, rig));
        claim(rig);
        // One rig's failure says it; the others would bury it.
        if (testing::Test::HasFailure()) return;
    }
}

double rounding_of(const Rig& rig) {
    return rig.objects.empty() ? kRounding : kRoundingOfObjects;
}

// Sample by sample, relative to the larger of the expected one and black, a share of the brightest
// of its plane: where light is no more than that, it came so far that roundings of its way count.
void expect_same(const Image& image,
                 const Image& expected,
                 double tolerance,
                 const std::vector<unsigned char>& on_edge) {
    ASSERT_EQ(image.size(), expected.size());
    const std::size_t pixels = on_edge.size();
    for (std::size_t first = 0; first < image.size(); first += pixels) {
        const auto plane = std::span(expected).subspan(first, pixels);
        const double black = kBlackShare * std::ranges::max(plane);
        if (black == 0.0) {
            for (std::size_t i = 0; i < pixels; ++i) EXPECT_EQ(image[first + i], 0.0);
            continue;
        }
        for (std::size_t i = 0; i < pixels; ++i) {
            if (on_edge[i] != 0) continue;
            EXPECT_LE(std::abs(relative_error(image[first + i], plane[i], black)), tolerance)
                << "plane " << first / pixels << ", pixel " << i << ": " << image[first + i]
                << " for " << plane[i];
        }
    }
}

// To the last bit.
void expect_equal(const Image& image, const Image& expected) {
    ASSERT_EQ(image.size(), expected.size());
    for (std::size_t i = 0; i < image.size(); ++i) {
        if (image[i] < kLeastOfAllDigits && expected[i] < kLeastOfAllDigits) continue;
        EXPECT_EQ(image[i], expected[i]) << "sample " << i;
    }
}

std::vector<unsigned char> edges_of(const Rig& rig) {
    return Tracer(rig, options_for(rig, Planes::Radiance)).on_edges(rig.camera.range);
}

std::vector<unsigned char> no_edges(const Rig& rig) {
    return std::vector<unsigned char>(static_cast<std::size_t>(rig.camera.width_px) *
                                      static_cast<std::size_t>(rig.camera.height_px));
}

// Of an image of Planes::RadianceAndSignals, the one or the other.
Image signals_of(const Image& image) {
    const auto planes = static_cast<std::ptrdiff_t>(kChannels + kShares.size());
    const auto size = static_cast<std::ptrdiff_t>(image.size());
    return {image.begin(), image.begin() + size / planes * kChannels};
}
Image radiance_of(const Image& image) {
    return {image.begin() + static_cast<std::ptrdiff_t>(signals_of(image).size()), image.end()};
}

// The image whose pixel (column, row) is the given one's `from(column, row)`.
Image rearranged(const Image& image,
                 int width_px,
                 int height_px,
                 const std::function<std::size_t(int column, int row)>& from) {
    Image result;
    const std::size_t pixels =
        static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
    for (std::size_t first = 0; first < image.size(); first += pixels) {
        for (int row = 0; row < height_px; ++row) {
            for (int column = 0; column < width_px; ++column) {
                result.push_back(image[first + from(column, row)]);
            }
        }
    }
    return result;
}

std::size_t pixel_of(int column, int row, int width_px) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_px) +
           static_cast<std::size_t>(column);
}

// --- Scale --------------------------------------------------------------------------------------

// A power of two moves no digit, of any length or loss: the same image to the last bit, edges
// included. So nothing in the tracer is a length of its own.
TEST(TracerScale, ByPowersOfTwoChangesNoDigit) {
    for_each_rig(kRigs, [](const Rig& rig) {
        const Image image = traced(rig);
        for (const int log2 : {-7, -1, 3, 7}) {
            Image expected = image;
            for (double& sample : expected) sample = std::ldexp(sample, -2 * log2);
            SCOPED_TRACE(log2);
            expect_equal(traced(scaled(rig, std::ldexp(1.0, log2))), expected);
        }
    });
}

TEST(TracerScale, ByAnyFactorFollowsTheInverseSquare) {
    for_each_rig(kRigs, [](const Rig& rig) {
        const Image image = traced(rig);
        for (const double s : {1e-2, 0.37, 5.3, 1e2}) {
            SCOPED_TRACE(s);
            Image expected = image;
            for (double& sample : expected) sample /= s * s;
            expect_same(traced(scaled(rig, s)), expected, rounding_of(rig), edges_of(rig));
        }
    });
}

// Focal length and pixel pitch have one meaning together: the same lens in another size.
TEST(TracerScale, OfFocalLengthAndPixelsTogetherChangesNothing) {
    for_each_rig(kRigs, [](const Rig& rig) {
        Rig other = rig;
        other.camera.focal_length_m *= 8.0;
        other.camera.pixel_pitch_m *= 8.0;
        expect_equal(traced(other), traced(rig));
    });
}

// --- Power --------------------------------------------------------------------------------------

TEST(TracerPower, IsAFactorOfTheImage) {
    for_each_rig(kRigsOfSignals, [](const Rig& rig) {
        const Image image = traced(rig, Planes::RadianceAndSignals);
        for (const double factor : {0x1p-20, 3.7, 0x1p20}) {
            Image expected = image;
            for (double& sample : expected) sample *= factor;
            const Image brighter = traced(with_power(rig, factor), Planes::RadianceAndSignals);
            // By a power of two it is exact.
            expect_same(brighter, expected, kReordered, no_edges(rig));
            if (factor != 3.7) {
                expect_equal(brighter, expected);
            }
        }
    });
}

TEST(TracerPower, OfOneStrobeNeverDarkens) {
    for_each_rig(kRigs, [](const Rig& rig) {
        const Image image = traced(rig);
        for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
            Rig brighter = rig;
            brighter.strobes[s].power = 1.5 * rig.strobes[s].power + 1.0;
            const Image lighter = traced(brighter);
            // Every term grows, and so does every rounded product and sum.
            for (std::size_t i = 0; i < image.size(); ++i) EXPECT_GE(lighter[i], image[i]);
        }
    });
}

// Behind a port a cone's edge may cross a pixel between two wavelengths, and no grid is exact
// there.
TEST(TracerSum, OfTheStrobesAloneIsTheImageOfAll) {
    for_each_rig(kRigsOfSignals, [](const Rig& rig) {
        const Image image = traced(rig, Planes::RadianceAndSignals);
        Image sum(image.size());
        for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
            const Image part = traced(only_strobe(rig, s), Planes::RadianceAndSignals);
            for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += part[i];
        }
        expect_same(signals_of(sum), signals_of(image), kTwoGrids, edges_of(rig));
        expect_same(radiance_of(sum), radiance_of(image), kReordered, no_edges(rig));
    });
}

// --- Loss ---------------------------------------------------------------------------------------

TEST(TracerLoss, NeverBrightensAndAlwaysDarkensWhatIsLit) {
    for_each_rig(kRigs, [](const Rig& rig) {
        // No lamp is within a centimetre of what it lights, and the loss of that way, 5e-5 of the
        // light, exceeds all rounding by far.
        const Image before = traced(rig);
        const Image after = traced(with_loss(rig, 0.005));
        for (std::size_t i = 0; i < before.size(); ++i) {
            if (before[i] == 0.0) {
                EXPECT_EQ(after[i], 0.0);
            } else {
                EXPECT_LT(after[i], before[i]) << "sample " << i;
            }
        }
    });
}

TEST(TracerLoss, AtOneWavelengthNeverBrightensAnother) {
    for_each_rig(kRigsOfSignals, [](const Rig& rig) {
        const double middle_nm = wavelengths_of(rig)[1];
        Rig murkier = rig;
        std::vector<double> values(rig.water.absorption_per_m.values().begin(),
                                   rig.water.absorption_per_m.values().end());
        const auto lambda_nm = rig.water.absorption_per_m.lambda_nm();
        for (std::size_t k = 0; k < values.size(); ++k) {
            if (std::abs(lambda_nm[k] - middle_nm) < 30.0) values[k] += 0.1;
        }
        murkier.water.absorption_per_m = {
            "murkier", {lambda_nm.begin(), lambda_nm.end()}, std::move(values)};
        const Image before = traced(rig, Planes::RadianceAndSignals);
        const Image after = traced(murkier, Planes::RadianceAndSignals);
        const std::vector<unsigned char> on_edge = edges_of(rig);
        const std::size_t signals = kChannels * on_edge.size();
        for (std::size_t i = 0; i < before.size(); ++i) {
            if (on_edge[i % on_edge.size()] != 0) continue;
            const double room = i < signals ? kTwoGrids : kOfExponential;
            EXPECT_LE(after[i], before[i] * (1.0 + room)) << "sample " << i;
        }
    });
}

// --- Symmetry -----------------------------------------------------------------------------------

TEST(TracerSymmetry, OfARandomRigMirroredIsTheMirroredImage) {
    for_each_rig(kRigsOfSignals, [](const Rig& rig) {
        const Image expected = rearranged(
            traced(rig, Planes::RadianceAndSignals),
            kWidth_px,
            kHeight_px,
            [](int column, int row) { return pixel_of(kWidth_px - 1 - column, row, kWidth_px); });
        const Image image = traced(mirrored(rig), Planes::RadianceAndSignals);
        // A sign moves no digit; an emitter's lamps come in another order, and a turned beam's
        // angles from the other side.
        const bool is_rounded = std::ranges::any_of(rig.strobes, [](const Strobe& strobe) {
            return strobe.emitter || strobe.beam.pattern.index() != 0;
        });
        if (is_rounded) {
            expect_same(image, expected, kRounding, edges_of(mirrored(rig)));
        } else {
            expect_equal(image, expected);
        }
    });
}

TEST(TracerSymmetry, OfARandomRigTurnedIsTheTurnedImage) {
    constexpr int kSide_px = 7;
    for_each_rig(kRigs, [](const Rig& any) {
        Rig rig = with_pixels(any, kSide_px, kSide_px);
        for (Strobe& strobe : rig.strobes) strobe.emitter.reset();
        const Image expected = rearranged(traced(rig), kSide_px, kSide_px, [](int column, int row) {
            return pixel_of(row, kSide_px - 1 - column, kSide_px);
        });
        expect_same(traced(turned(rig)), expected, rounding_of(rig), edges_of(turned(rig)));
    });
}

// --- Always, and never --------------------------------------------------------------------------

TEST(TracerImage, IsFiniteAndNeverNegative) {
    for_each_rig(kRigsOfSignals, [](const Rig& rig) {
        for (const double sample : traced(rig, Planes::RadianceAndSignals)) {
            EXPECT_TRUE(std::isfinite(sample) && sample >= 0.0) << sample;
        }
    });
}

TEST(TracerImage, OfLampsWithoutPowerOrWeightIsBlack) {
    for_each_rig(kRigsOfSignals, [](const Rig& rig) {
        Rig weightless = rig;
        for (Strobe& strobe : weightless.strobes) {
            for (Cone& cone : strobe.beam.cones) cone.weight = 0.0;
            strobe.beam.pattern = {};
        }
        for (const Rig& dark : {with_power(rig, 0.0), weightless}) {
            for (const double sample : traced(dark, Planes::RadianceAndSignals)) {
                EXPECT_EQ(sample, 0.0);
            }
        }
    });
}

// --- Exposures ----------------------------------------------------------------------------------

// A frame's brightest pixel is under the largest half float, and high over 2^-14, where half floats
// begin to lose digits. An object counts with all that might light it from as near as it comes,
// which may be far more than the image shows of it.
TEST(Exposure, PutsThePeakOfEveryFrameWithinTheHalfFloatsRange) {
    constexpr double kLeastPeak = 0x1p5;              // 2^6.7 was the least of 12000 rigs
    constexpr double kLeastPeakWithObjects = 0x1p-8;  // and 2^-6 here
    int lit = 0;
    for_each_rig(kRigs, [&](const Rig& any) {
        const Rig rig = with_pixels(any, 32, 24);
        const std::vector<double> lambda_nm = wavelengths_of(rig);
        SceneOptions options;
        options.emitter_lamps = LampGrid{.across = 3, .along = 2};
        const Image image = traced(rig);
        const std::size_t pixels = image.size() / lambda_nm.size();
        std::size_t plane = 0;
        std::vector<PlannedWavelength> wavelengths = in_frames(rig, lambda_nm, options);
        static_cast<void>(
            make_scenes(rig, scene_lamps(rig, wavelengths, options), options, wavelengths));
        for (const PlannedWavelength& w : wavelengths) {
            const double peak =
                std::ldexp(std::ranges::max(std::span(image).subspan(plane * pixels, pixels)),
                           w.exposure_log2);
            ++plane;
            EXPECT_LT(peak, kLargestHalf) << w.lambda_nm << " nm";
            if (peak == 0.0) continue;
            ++lit;
            EXPECT_GT(peak, rig.objects.empty() ? kLeastPeak : kLeastPeakWithObjects)
                << w.lambda_nm << " nm, exposure " << w.exposure_log2;
        }
        EXPECT_EQ(plane, lambda_nm.size());
    });
    EXPECT_GT(lit, 0);
}

}  // namespace
}  // namespace aphotic::tracer_properties_test
