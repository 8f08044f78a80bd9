// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/wavelength_search.h"

#include "base/error.h"
#include "spectral/bands.h"
#include "spectral/curve_loader.h"
#include "support/dice.h"
#include "support/light_family.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace aphotic::wavelength_search_test {
namespace {

constexpr WavelengthRange kRange{400.0, 720.0};
// Between two of kCheckPaths paths an error may peak higher than at both.
constexpr double kBetweenPaths = 0.02;
// The stated error of the grid that a fitter compares with, and what Simpson's rule misses.
constexpr double kGridError = 1e-9 + 2e-9;
// Wavelengths closer together than this could not be told apart by the names of their channels.
constexpr double kLeastDistance_nm = 0.01;

// Nothing but a triangle of 0.1 nm.
Spectrum narrow_line(double nm) {
    return {"line", {300.0, nm - 0.05, nm, nm + 0.05, 800.0}, {0.0, 0.0, 1.0, 0.0, 0.0}};
}

Sensor camera() {
    return builtin_sensor("nikon-d5100");
}

const std::vector<std::string> kSand{"sand"};
const std::vector<std::string> kAll{"sand", "green-algae", "brown-algae", "red-algae"};

FittedRule fitted_at(const QuadratureFitter& fitter, const std::vector<double>& lambda_nm) {
    return fitter.fit(frames_at(fitter, lambda_nm), kFrameError);
}

FittedRule planned(const Sensor& sensor, const LightFamily& family, const PlanTarget& target) {
    return plan_wavelengths(QuadratureFitter(sensor, family, kRange), kRange, target);
}

double largest_amplification(const FittedRule& rule) {
    return std::ranges::max(rule.quality, {}, &RuleQuality::amplification).amplification;
}

// What every plan is: increasing, within the range, no wavelength twice, and finite.
void expect_sound(const FittedRule& rule, const std::string& what) {
    EXPECT_FALSE(rule.wavelengths.empty()) << what;
    double last_nm = 0.0;
    for (const WeightedWavelength& w : rule.wavelengths) {
        EXPECT_TRUE(kRange.contains(w.lambda_nm)) << what << ": " << w.lambda_nm;
        EXPECT_GE(w.lambda_nm - last_nm, kLeastDistance_nm) << what << ": " << w.lambda_nm;
        last_nm = w.lambda_nm;
        for (const double weight : w.weight) EXPECT_TRUE(std::isfinite(weight)) << what;
    }
    for (const RuleQuality& quality : rule.quality) {
        EXPECT_TRUE(std::isfinite(quality.error)) << what;
        EXPECT_TRUE(std::isfinite(quality.amplification)) << what;
    }
}

// --- Integrals of the test's own --------------------------------------------------------------

// Which light: source, share of the tilt, path.
struct Member {
    std::size_t source = 0;
    double tilt = 0.0;
    double path_m = 0.0;
};

// Simpson's rule on every stretch between knots of any table, in so many panels that light falls by
// no more than exp(-1/32) over one of them: of a panel over which it falls by exp(-d) Simpson's
// rule misses d^4 / 2880, here 3e-10. And no fewer than kSmooth or kRough, for the product of the
// tables alone: of t^4 from 0 to 1, the roughest of products of four, n panels miss 1 / (120 n^4),
// 2e-9 of it if n is 64; what real tables do over a few nm is smoother by far.
//
// Like the fitter it leaves the common factor exp(-K_0 l) away, or black water would be zero.
constexpr int kSmooth = 8;
constexpr int kRough = 64;

class Simpson {
  public:
    Simpson(const Sensor& sensor, const LightFamily& family, WavelengthRange range, int panels)
        : family_(family) {
        std::set<double> knots_nm{range.first_nm, range.last_nm};
        const auto note = [&](const Spectrum& curve) {
            for (const double nm : curve.lambda_nm()) {
                if (range.contains(nm)) knots_nm.insert(nm);
            }
        };
        for (const Spectrum* curve : sensor.curves()) note(*curve);
        for (const auto& source : family.sources) std::ranges::for_each(source, note);
        if (family.water.multiple != 0.0) note(family.water.absorption_per_m);
        if (family.tilt) note(*family.tilt);
        const auto K_per_m = [&](double nm) { return family.water.attenuation_per_m(nm); };
        for (const double nm : knots_nm) least_K_per_m_ = std::min(least_K_per_m_, K_per_m(nm));
        for (auto it = knots_nm.begin(); std::next(it) != knots_nm.end(); ++it) {
            const double first_nm = *it;
            const double last_nm = *std::next(it);
            const double fall =
                std::abs(K_per_m(last_nm) - K_per_m(first_nm)) * family.longest_path_m;
            const double depth = (std::min(K_per_m(first_nm), K_per_m(last_nm)) - least_K_per_m_) *
                                 family.shortest_path_m;
            // What is as dark as exp(-60) beside the brightest needs no care.
            const bool is_dark = depth > 60.0;
            const int n = is_dark
                              ? panels
                              : std::max(panels, static_cast<int>(std::ceil(kPanelsPerE * fall)));
            for (int i = 0; i <= 2 * n; ++i) {
                const double share = i == 0 || i == 2 * n ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
                const double nm = std::lerp(first_nm, last_nm, i / (2.0 * n));
                add(sensor, nm, share * (last_nm - first_nm) / (6.0 * n));
            }
        }
    }

    [[nodiscard]] std::array<double, kChannels> signals(const Member& member) const {
        std::array<double, kChannels> sum{};
        for (const Node& node : nodes_) {
            const double f =
                node.sources[member.source] *
                std::exp((least_K_per_m_ - node.K_per_m) * member.path_m + member.tilt * node.tilt);
            for (std::size_t c = 0; c < kChannels; ++c) sum[c] += node.weight[c] * f;
        }
        return sum;
    }

    [[nodiscard]] double in_frame(const FrameLight& frame, const Member& member) const {
        return frame.sources[member.source] *
               std::exp((least_K_per_m_ - frame.attenuation_per_m) * member.path_m +
                        member.tilt * frame.tilt);
    }

    // The relative error of a rule on a member; 0 where there is no signal.
    [[nodiscard]] std::array<double, kChannels> errors(const std::vector<WeightedWavelength>& rule,
                                                       const std::vector<FrameLight>& frames,
                                                       const Member& member) const {
        const auto right = signals(member);
        std::array<double, kChannels> errors{};
        for (std::size_t c = 0; c < kChannels; ++c) {
            double found = 0.0;
            for (std::size_t j = 0; j < rule.size(); ++j) {
                found += rule[j].weight[c] * in_frame(frames[j], member);
            }
            if (right[c] > 0.0) errors[c] = found / right[c] - 1.0;
        }
        return errors;
    }

  private:
    static constexpr double kPanelsPerE = 32.0;

    struct Node {
        std::array<double, kChannels> weight{};
        std::vector<double> sources;
        double K_per_m = 0.0;
        double tilt = 0.0;
    };

    void add(const Sensor& sensor, double nm, double width_nm) {
        Node node{.sources = {},
                  .K_per_m = family_.water.attenuation_per_m(nm),
                  .tilt = family_.tilt ? family_.tilt->at(nm) : 0.0};
        for (std::size_t c = 0; c < kChannels; ++c) {
            node.weight[c] = width_nm * sensor.response(static_cast<int>(c), nm);
        }
        for (const auto& curves : family_.sources) {
            double value = 1.0;
            for (const Spectrum& curve : curves) value *= curve.at(nm);
            node.sources.push_back(value);
        }
        nodes_.push_back(std::move(node));
    }

    LightFamily family_;
    std::vector<Node> nodes_;
    double least_K_per_m_ = std::numeric_limits<double>::infinity();
};

class Dice : public aphotic::Dice {
  public:
    using aphotic::Dice::Dice;
    Spectrum curve(double least, double most) {
        std::vector<double> lambda_nm;
        std::vector<double> value;
        const double spacing_nm = between(8.0, 80.0);
        double nm = kRange.first_nm - between(0.0, 5.0);
        while (true) {
            lambda_nm.push_back(nm);
            value.push_back(between(least, most));
            if (nm >= kRange.last_nm) return {"random", lambda_nm, value};
            nm += between(0.1, 2.0) * spacing_nm;
        }
    }
    // Sources and water of random lines; now and then all paths are of one length.
    LightFamily family() {
        LightFamily family{.sources = {},
                           .water = {.absorption_per_m = curve(0.0, 0.4),
                                     .multiple = between(0.0, 5.0),
                                     .uniform_loss_per_m = between(0.0, 0.3)},
                           .shortest_path_m = std::pow(10.0, between(-1.0, 0.7)),
                           .longest_path_m = 0.0,
                           .tilt = {}};
        family.longest_path_m = family.shortest_path_m * std::max(1.0, between(0.5, 5.0));
        const auto sources = static_cast<int>(between(1.0, 4.0));
        const Spectrum lamp = curve(0.1, 5.0);
        for (int s = 0; s < sources; ++s) family.sources.push_back({lamp, curve(0.0, 0.5)});
        return family;
    }
    Member member(const LightFamily& family) {
        const auto sources = static_cast<double>(family.sources.size());
        return {.source = static_cast<std::size_t>(between(0.0, sources)),
                .tilt = family.tilt ? between(-1.0, 1.0) : 0.0,
                .path_m = between(family.shortest_path_m, family.longest_path_m)};
    }
};

// Random pixels, a sum of members each with factors that are not negative, never err by more than
// the rule says; nor, with every frame off in the worst direction, by more than it promises.
void expect_promise_kept(const Sensor& sensor,
                         const LightFamily& family,
                         const FittedRule& rule,
                         const std::vector<FrameLight>& frames,
                         Dice& dice,
                         const std::string& what,
                         int panels = kSmooth) {
    constexpr int kPixels = 25;
    const Simpson simpson(sensor, family, kRange, panels);
    for (int pixel = 0; pixel < kPixels; ++pixel) {
        const int members = 1 + pixel % 4;
        std::array<double, kChannels> right{};
        std::array<double, kChannels> found{};
        std::array<double, kChannels> off{};
        for (int m = 0; m < members; ++m) {
            const Member member = dice.member(family);
            const double factor = std::pow(10.0, dice.between(-2.0, 2.0));
            const auto signals = simpson.signals(member);
            for (std::size_t c = 0; c < kChannels; ++c) {
                right[c] += factor * signals[c];
                for (std::size_t j = 0; j < frames.size(); ++j) {
                    const double light = rule.wavelengths[j].weight[c] * factor *
                                         simpson.in_frame(frames[j], member);
                    found[c] += light;
                    off[c] += std::abs(light) * kFrameError;
                }
            }
        }
        for (std::size_t c = 0; c < kChannels; ++c) {
            if (right[c] == 0.0) continue;
            const double error = std::abs(found[c] - right[c]) / right[c];
            const RuleQuality& quality = rule.quality[c];
            EXPECT_LE(error, quality.error * (1.0 + kBetweenPaths) + kGridError)
                << what << ", pixel " << pixel << ", channel " << c;
            EXPECT_LE(error + off[c] / right[c],
                      quality.promise(kFrameError) * (1.0 + kBetweenPaths) + kGridError)
                << what << ", pixel " << pixel << ", channel " << c;
        }
    }
}

// --- What is known to be feasible -------------------------------------------------------------

// So many wavelengths can be chosen so that no path and no material errs by more than this: a
// search is to do as well.
struct Feasible {
    const std::vector<std::string>& materials;
    double shortest_path_m;
    double longest_path_m;
    int count;
    double error;
};

TEST(Planner, DoesAsWellAsIsKnownToBeFeasible) {
    constexpr double kMostAmplification = 1.7;
    Dice dice(31);
    for (const Feasible& row : {Feasible{kSand, 3.9, 5.2, 3, 4e-7},
                                Feasible{kSand, 2.0, 16.0, 3, 9.5e-4},
                                Feasible{kSand, 2.0, 16.0, 6, 1.3e-7},
                                Feasible{kSand, 0.3, 40.0, 3, 1.6e-2},
                                Feasible{kAll, 3.9, 5.2, 6, 5.6e-4}}) {
        const std::string what = std::to_string(row.materials.size()) + " materials, " +
                                 std::to_string(row.shortest_path_m) + " to " +
                                 std::to_string(row.longest_path_m) + " m, " +
                                 std::to_string(row.count) + " wavelengths";
        const LightFamily family =
            sea_floor(row.materials, row.shortest_path_m, row.longest_path_m);
        const QuadratureFitter fitter(camera(), family, kRange);
        const auto lambda_nm = best_wavelengths(fitter, kRange, row.count, kFrameError);
        ASSERT_EQ(lambda_nm.size(), static_cast<std::size_t>(row.count)) << what;
        const auto frames = frames_at(fitter, lambda_nm);
        const FittedRule rule = fitter.fit(frames, kFrameError);
        expect_sound(rule, what);
        EXPECT_LE(rule.error(), row.error) << what;
        EXPECT_LT(largest_amplification(rule), kMostAmplification) << what;
        expect_promise_kept(camera(), family, rule, frames, dice, what);
    }
}

TEST(Planner, TakesOneFrameForSandAtOneThousandth) {
    const FittedRule rule = planned(camera(), sea_floor(kSand, 3.9, 5.2), {.tolerance = 1e-3});
    expect_sound(rule, "sand");
    EXPECT_EQ(rule.wavelengths.size(), 3U);
    EXPECT_LE(rule.promise(kFrameError), 1e-3);
}

// What the equal bands' own wavelengths can do with the best of weights, the best wavelengths
// can too.
TEST(Planner, IsNoWorseThanEqualBands) {
    constexpr double kConverged = 0.01;  // of Lawson's iteration, in either
    for (const auto& materials : {kSand, std::vector<std::string>{"sand", "brown-algae"}}) {
        const QuadratureFitter fitter(camera(), sea_floor(materials, 1.0, 8.0), kRange);
        for (const int count : {1, 2, 4, 6, 9}) {
            std::vector<double> bands_nm;
            for (const WeightedWavelength& w : equal_bands(camera(), kRange, count)) {
                bands_nm.push_back(w.lambda_nm);
            }
            const double found =
                fitted_at(fitter, best_wavelengths(fitter, kRange, count, kFrameError)).error();
            EXPECT_LE(found, fitted_at(fitter, bands_nm).error() * (1.0 + kConverged) + kGridError)
                << count << " wavelengths, " << materials.size() << " materials";
        }
    }
}

// Every fourth nanometre of the range tried in turn, and every 16th with every 16th.
TEST(Planner, LeavesNoBetterPlaceForOneOrTwoWavelengths) {
    // It looks at quick costs, in places an eighth of a nm apart.
    constexpr double kNear = 0.05;
    const QuadratureFitter fitter(camera(), sea_floor(kSand, 1.0, 8.0), kRange);
    double best_of_one = std::numeric_limits<double>::infinity();
    for (double nm = kRange.first_nm; nm <= kRange.last_nm; nm += 4.0) {
        best_of_one = std::min(best_of_one, fitted_at(fitter, {nm}).error());
    }
    const double one = fitted_at(fitter, best_wavelengths(fitter, kRange, 1, kFrameError)).error();
    EXPECT_LE(one, best_of_one * (1.0 + kNear));

    double best_of_two = std::numeric_limits<double>::infinity();
    for (double nm = kRange.first_nm; nm <= kRange.last_nm; nm += 16.0) {
        for (double other_nm = nm + 16.0; other_nm <= kRange.last_nm; other_nm += 16.0) {
            best_of_two = std::min(best_of_two, fitted_at(fitter, {nm, other_nm}).error());
        }
    }
    const double two = fitted_at(fitter, best_wavelengths(fitter, kRange, 2, kFrameError)).error();
    EXPECT_LE(two, best_of_two * (1.0 + kNear));
}

// --- The fewest -------------------------------------------------------------------------------

TEST(Planner, TakesOneWavelengthInClearWater) {
    LightFamily family = sea_floor(kSand, 1.0, 10.0);
    family.water.multiple = 0.0;
    for (const double loss_per_m : {0.0, 0.4}) {
        family.water.uniform_loss_per_m = loss_per_m;
        const FittedRule rule = planned(camera(), family, {});
        expect_sound(rule, "clear water");
        EXPECT_EQ(rule.wavelengths.size(), 1U) << loss_per_m << " 1/m";
        EXPECT_LT(rule.error(), 2.0 * kGridError) << loss_per_m << " 1/m";
        EXPECT_NEAR(largest_amplification(rule), 1.0, 2.0 * kGridError);
    }
}

TEST(Planner, TakesOneWavelengthForOnePath) {
    const FittedRule rule = planned(camera(), sea_floor(kSand, 4.2, 4.2), {});
    expect_sound(rule, "one path");
    EXPECT_EQ(rule.wavelengths.size(), 1U);
    EXPECT_LT(rule.error(), 2.0 * kGridError);
}

// One number to match for each of two sources.
TEST(Planner, TakesTwoWavelengthsForTwoMaterialsAtOnePath) {
    const FittedRule rule = planned(camera(), sea_floor({"sand", "brown-algae"}, 4.2, 4.2), {});
    expect_sound(rule, "one path");
    EXPECT_EQ(rule.wavelengths.size(), 2U);
    EXPECT_LT(rule.promise(kFrameError), 1e-3);
}

void expect_no_fewer_for_less(int step) {
    const QuadratureFitter fitter(camera(), sea_floor(kSand, 0.5, 30.0), kRange);
    std::size_t last = 0;
    for (const double tolerance : {0.5, 0.1, 0.03, 0.01, 3e-3, 1e-3, 7e-4}) {
        const FittedRule rule =
            plan_wavelengths(fitter, kRange, {.tolerance = tolerance, .step = step});
        expect_sound(rule, "tolerance " + std::to_string(tolerance));
        EXPECT_LE(rule.promise(kFrameError), tolerance) << "step " << step;
        EXPECT_GE(rule.wavelengths.size(), last) << tolerance << ", step " << step;
        last = rule.wavelengths.size();
    }
    EXPECT_GT(last, static_cast<std::size_t>(step));
}

TEST(Planner, NeverTakesFewerForLess) {
    expect_no_fewer_for_less(1);
}

TEST(Planner, NeverTakesFewerFramesForLess) {
    expect_no_fewer_for_less(3);
}

TEST(Planner, FillsFramesUnlessOneCanBeSmaller) {
    const QuadratureFitter fitter(camera(), sea_floor({"sand", "brown-algae"}, 2.0, 6.0), kRange);
    for (const int step : {2, 4, 5}) {
        const FittedRule rule = plan_wavelengths(fitter, kRange, {.tolerance = 2e-3, .step = step});
        EXPECT_EQ(rule.wavelengths.size() % static_cast<std::size_t>(step), 0U) << "step " << step;
        EXPECT_LE(rule.promise(kFrameError), 2e-3) << "step " << step;
    }
}

TEST(Planner, TakesNoMoreInStepsOfOneThanOfThree) {
    for (const double tolerance : {0.05, 1e-3}) {
        for (const double longest_m : {5.0, 40.0}) {
            const QuadratureFitter fitter(camera(), sea_floor(kSand, 2.0, longest_m), kRange);
            const auto in_steps_of = [&](int step) {
                return plan_wavelengths(fitter, kRange, {.tolerance = tolerance, .step = step})
                    .wavelengths.size();
            };
            EXPECT_LE(in_steps_of(1), in_steps_of(3))
                << "tolerance " << tolerance << " to " << longest_m << " m";
        }
    }
}

// --- Determinism and invariance ---------------------------------------------------------------

void expect_identical(const FittedRule& one, const FittedRule& other, const std::string& what) {
    ASSERT_EQ(one.wavelengths.size(), other.wavelengths.size()) << what;
    for (std::size_t j = 0; j < one.wavelengths.size(); ++j) {
        EXPECT_EQ(one.wavelengths[j].lambda_nm, other.wavelengths[j].lambda_nm) << what;
        EXPECT_EQ(one.wavelengths[j].weight, other.wavelengths[j].weight) << what;
    }
    for (std::size_t c = 0; c < kChannels; ++c) {
        EXPECT_EQ(one.quality[c].error, other.quality[c].error) << what;
        EXPECT_EQ(one.quality[c].amplification, other.quality[c].amplification) << what;
    }
}

TEST(Planner, PlansTheSameEveryTime) {
    const LightFamily family = sea_floor({"sand", "red-algae"}, 2.0, 9.0);
    expect_identical(planned(camera(), family, {}), planned(camera(), family, {}), "again");
}

// Neither the lamp's scale nor the metre's is any of its business; powers of two do not round.
TEST(Planner, DoesNotKnowHowBrightALampOrHowLongAMetreIs) {
    const LightFamily family = sea_floor(kSand, 2.0, 9.0);
    const FittedRule rule = planned(camera(), family, {});
    for (const double scale : {0x1p-99, 0x1p99}) {
        LightFamily brighter = family;
        for (auto& source : brighter.sources) source[0] = times(source[0], scale);
        expect_identical(planned(camera(), brighter, {}), rule, "lamp");
    }
    for (const double s : {0x1p-5, 0x1p9}) {
        LightFamily longer = family;
        longer.shortest_path_m *= s;
        longer.longest_path_m *= s;
        longer.water.absorption_per_m = times(longer.water.absorption_per_m, 1.0 / s);
        expect_identical(planned(camera(), longer, {}), rule, "metre");
    }
}

// --- Awkward light ----------------------------------------------------------------------------

TEST(Planner, FindsALineOfATenthOfANanometre) {
    constexpr double kHalfLine_nm = 0.05;
    Dice dice(32);
    for (const double line_nm : {431.7, 589.0, 719.0}) {
        LightFamily family = sea_floor(kSand, 1.0, 20.0);
        family.sources = {{narrow_line(line_nm)}};
        const QuadratureFitter fitter(camera(), family, kRange);
        const FittedRule rule = plan_wavelengths(fitter, kRange, {});
        const std::string what = "line at " + std::to_string(line_nm) + " nm";
        expect_sound(rule, what);
        EXPECT_LE(rule.promise(kFrameError), 1e-3) << what;
        for (const WeightedWavelength& w : rule.wavelengths) {
            EXPECT_NEAR(w.lambda_nm, line_nm, kHalfLine_nm) << what;
        }
        expect_promise_kept(
            camera(), family, rule, frames_of(fitter, rule.wavelengths), dice, what);
    }
}

// Two lines of mercury, and water that tells them apart: two wavelengths, one on each.
TEST(Planner, FindsTwoLines) {
    LightFamily family = sea_floor(kSand, 1.0, 20.0);
    family.sources = {{Spectrum("mercury",
                                {300.0, 435.78, 435.83, 435.88, 546.02, 546.07, 546.12, 800.0},
                                {0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0})}};
    const QuadratureFitter fitter(camera(), family, kRange);
    const FittedRule rule = plan_wavelengths(fitter, kRange, {.step = 2});
    expect_sound(rule, "mercury");
    ASSERT_EQ(rule.wavelengths.size(), 2U);
    EXPECT_NEAR(rule.wavelengths[0].lambda_nm, 435.83, 0.05);
    EXPECT_NEAR(rule.wavelengths[1].lambda_nm, 546.07, 0.05);
    EXPECT_LE(rule.promise(kFrameError), 1e-3);
}

// However many are asked for where there is little to choose from.
TEST(Planner, NeverTakesAWavelengthTwice) {
    LightFamily line = sea_floor(kSand, 1.0, 20.0);
    line.sources = {{narrow_line(550.0)}};
    LightFamily plain = line;
    plain.sources = {{flat(1.0)}};
    plain.water = {.absorption_per_m = flat(1.0), .multiple = 0.0};
    const Sensor flat_sensor({flat(1.0), flat(1.0), flat(1.0)}, ResponseKind::Energy);
    for (const int count : {2, 3, 4, 6, 9}) {
        for (const LightFamily& family : {line, plain}) {
            const QuadratureFitter fitter(flat_sensor, family, kRange);
            const auto lambda_nm = best_wavelengths(fitter, kRange, count, kFrameError);
            for (std::size_t j = 1; j < lambda_nm.size(); ++j) {
                EXPECT_GE(lambda_nm[j] - lambda_nm[j - 1], kLeastDistance_nm * (1.0 - 1e-9))
                    << count << " wavelengths, number " << j << " at " << lambda_nm[j] << " nm";
            }
        }
    }
}

TEST(Planner, TakesAnyOneWavelengthWhereThereIsNoLight) {
    LightFamily family = sea_floor(kSand, 1.0, 20.0);
    family.sources = {{flat(0.0)}};
    for (const int step : {1, 3}) {
        const FittedRule rule = planned(camera(), family, {.step = step});
        expect_sound(rule, "no light");
        ASSERT_EQ(rule.wavelengths.size(), 1U);
        for (const double weight : rule.wavelengths[0].weight) EXPECT_EQ(weight, 0.0);
        EXPECT_EQ(rule.error(), 0.0);
        EXPECT_EQ(rule.promise(kFrameError), 0.0);
    }
}

// A lamp that is out beside one that is on changes nothing.
TEST(Planner, IgnoresALampThatIsOut) {
    LightFamily family = sea_floor(kSand, 2.0, 9.0);
    const FittedRule alone = planned(camera(), family, {});
    family.sources.push_back({flat(0.0)});
    const FittedRule with = planned(camera(), family, {});
    EXPECT_EQ(with.wavelengths.size(), alone.wavelengths.size());
    EXPECT_LE(with.promise(kFrameError), 1e-3);
}

TEST(Planner, KeepsItsPromiseInBlackWater) {
    Dice dice(33);
    for (const double multiple : {10.0, 1000.0}) {
        LightFamily family = sea_floor(kSand, 3.9, 5.2);
        family.water.multiple = multiple;
        const QuadratureFitter fitter(camera(), family, kRange);
        const FittedRule rule = plan_wavelengths(fitter, kRange, {.tolerance = 2e-3});
        const std::string what = std::to_string(multiple) + " of the water";
        expect_sound(rule, what);
        EXPECT_LE(rule.promise(kFrameError), 2e-3) << what;
        expect_promise_kept(
            camera(), family, rule, frames_of(fitter, rule.wavelengths), dice, what);
    }
}

// From the lamp's own window, and to a hundred times the shortest.
TEST(Planner, KeepsItsPromiseFromNoPathAtAll) {
    Dice dice(34);
    const LightFamily family = sea_floor(kSand, 0.0, 12.0);
    const QuadratureFitter fitter(camera(), family, kRange);
    const FittedRule rule = plan_wavelengths(fitter, kRange, {.tolerance = 1e-2});
    expect_sound(rule, "from 0 m");
    EXPECT_LE(rule.promise(kFrameError), 1e-2);
    expect_promise_kept(
        camera(), family, rule, frames_of(fitter, rule.wavelengths), dice, "from 0 m");
}

TEST(Planner, KeepsItsPromiseBehindAPort) {
    Dice dice(35);
    LightFamily family = sea_floor({"sand", "green-algae"}, 2.0, 6.0);
    family.tilt = Spectrum("tilt", {380.0, 500.0, 560.0, 780.0}, {-0.03, -0.004, 0.004, 0.02});
    const QuadratureFitter fitter(camera(), family, kRange);
    const FittedRule rule = plan_wavelengths(fitter, kRange, {.tolerance = 5e-3});
    expect_sound(rule, "port");
    EXPECT_LE(rule.promise(kFrameError), 5e-3);
    expect_promise_kept(camera(), family, rule, frames_of(fitter, rule.wavelengths), dice, "port");
}

// --- Tolerances that nothing keeps --------------------------------------------------------------

double promise_of(const QuadratureFitter& fitter, const PlanTarget& target) {
    return plan_wavelengths(fitter, kRange, target).promise(kFrameError);
}

TEST(Planner, ReturnsTheBestRuleWhereNoneKeepsTheTolerance) {
    const QuadratureFitter fitter(camera(), sea_floor(kSand, 3.9, 5.2), kRange);
    // Under the frames' own rounding, 2^-11.
    const double best = promise_of(fitter, {.tolerance = 1e-4, .most = 9});
    EXPECT_GE(best, 0x1p-11);
    EXPECT_LT(best, 2.0 * 0x1p-11);
    // And it can be had.
    EXPECT_LE(promise_of(fitter, {.tolerance = best, .most = 9}), best);
}

// What a plan has kept can be asked for: with as many wavelengths, and not refused.
TEST(Planner, KeepsWhatItHasKeptBefore) {
    constexpr double kALittle = 1.01;
    for (const LightFamily& family : {sea_floor(kSand, 3.9, 5.2),
                                      sea_floor(kSand, 0.3, 40.0),
                                      sea_floor({"sand", "brown-algae"}, 1.0, 8.0)}) {
        const QuadratureFitter fitter(camera(), family, kRange);
        const FittedRule rule = plan_wavelengths(fitter, kRange, {.tolerance = 1e-3});
        const PlanTarget again{.tolerance = rule.promise(kFrameError) * kALittle,
                               .most = static_cast<int>(rule.wavelengths.size())};
        EXPECT_LE(promise_of(fitter, again), again.tolerance)
            << family.shortest_path_m << " to " << family.longest_path_m << " m: kept "
            << rule.promise(kFrameError) << " with " << rule.wavelengths.size() << " wavelengths";
    }
}

// Three wavelengths keep 1.6 % of sand from 0.3 to 40 m, as above, and cannot keep a tenth of that.
TEST(Planner, TakesNoMoreWavelengthsThanItMay) {
    const QuadratureFitter fitter(camera(), sea_floor(kSand, 0.3, 40.0), kRange);
    const FittedRule few = plan_wavelengths(fitter, kRange, {.tolerance = 1.6e-3, .most = 3});
    EXPECT_LE(few.wavelengths.size(), 3U);
    EXPECT_GT(few.promise(kFrameError), 0.01);
    EXPECT_LE(promise_of(fitter, {.tolerance = 1.6e-3, .most = 9}), 1.6e-3);
}

// Frames without error leave the tolerance to the rule alone.
TEST(Planner, KeepsATinyToleranceWithExactFrames) {
    const QuadratureFitter fitter(camera(), sea_floor(kSand, 2.0, 16.0), kRange);
    const FittedRule rule =
        plan_wavelengths(fitter, kRange, {.tolerance = 1e-6, .frame_error = 0.0});
    expect_sound(rule, "exact frames");
    EXPECT_LE(rule.error(), 1e-6);
    EXPECT_EQ(rule.wavelengths.size(), 6U);  // 1.3e-7 is feasible with six, 9.5e-4 with three
}

// --- Beside frames that are there -------------------------------------------------------------

// Half the water's frames are there: the sum of them and some of its own errs less.
TEST(Planner, AddsWavelengthsToFramesOfAnotherWater) {
    Dice dice(36);
    const LightFamily family = sea_floor({"sand", "brown-algae"}, 2.0, 9.0);
    const QuadratureFitter fitter(camera(), family, kRange);
    const std::vector<double> given_nm{450.0, 550.0, 610.0};
    std::vector<FrameLight> given = frames_at(fitter, given_nm);
    for (FrameLight& frame : given) frame.attenuation_per_m *= 0.5;
    const double before = fitter.fit(given, kFrameError).error();
    double last = before;
    for (const int count : {1, 2, 3}) {
        const auto added_nm = best_wavelengths(fitter, kRange, count, kFrameError, given);
        // Only its own, not those that are given.
        ASSERT_EQ(added_nm.size(), static_cast<std::size_t>(count));
        std::vector<FrameLight> frames = given;
        for (std::size_t j = 0; j < added_nm.size(); ++j) {
            EXPECT_TRUE(kRange.contains(added_nm[j])) << added_nm[j];
            if (j > 0) {
                EXPECT_LT(added_nm[j - 1], added_nm[j]);
            }
            for (const double nm : given_nm) {
                EXPECT_GE(std::abs(added_nm[j] - nm), kLeastDistance_nm);
            }
            frames.push_back(fitter.frame_at(added_nm[j]));
        }
        const FittedRule rule = fitter.fit(frames, kFrameError);
        EXPECT_LT(rule.error(), last) << count << " added to an error of " << before;
        last = rule.error();
        expect_promise_kept(camera(), family, rule, frames, dice, std::to_string(count) + " added");
    }
    EXPECT_LT(last, 0.1 * before);
}

// Frames of the water itself leave less to do than none.
TEST(Planner, NeedsNoMoreBesideFramesOfItsOwn) {
    const QuadratureFitter fitter(camera(), sea_floor({"sand", "brown-algae"}, 2.0, 9.0), kRange);
    const auto three_nm = best_wavelengths(fitter, kRange, 3, kFrameError);
    const double three = fitted_at(fitter, three_nm).error();
    const auto given = frames_at(fitter, three_nm);
    auto frames = given;
    for (const double nm : best_wavelengths(fitter, kRange, 3, kFrameError, given)) {
        frames.push_back(fitter.frame_at(nm));
    }
    EXPECT_LT(fitter.fit(frames, kFrameError).error(), three);
}

// --- Random families --------------------------------------------------------------------------

class PlannerOfAnyLight : public testing::TestWithParam<unsigned> {};

TEST_P(PlannerOfAnyLight, KeepsItsPromiseToAnyPixel) {
    Dice dice(1000 + GetParam());
    const Sensor sensor = GetParam() % 2 == 0
                              ? camera()
                              : Sensor({dice.curve(0.0, 1.0), dice.curve(0.0, 1.0), flat(1.0)},
                                       ResponseKind::Quantum);
    const LightFamily family = dice.family();
    const QuadratureFitter fitter(sensor, family, kRange);
    const int count = 1 + static_cast<int>(GetParam() % 7);
    const FittedRule best = fitted_at(fitter, best_wavelengths(fitter, kRange, count, kFrameError));
    const std::string what =
        "family " + std::to_string(GetParam()) + ", " + std::to_string(count) + " wavelengths";
    expect_sound(best, what);
    EXPECT_EQ(best.wavelengths.size(), static_cast<std::size_t>(count)) << what;
    expect_promise_kept(
        sensor, family, best, frames_of(fitter, best.wavelengths), dice, what, kRough);

    constexpr double kTolerance = 0.02;
    const FittedRule plan = plan_wavelengths(fitter, kRange, {.tolerance = kTolerance});
    expect_sound(plan, what + ", plan");
    EXPECT_LE(plan.promise(kFrameError), kTolerance) << what;
    expect_promise_kept(
        sensor, family, plan, frames_of(fitter, plan.wavelengths), dice, what + ", plan", kRough);
}

INSTANTIATE_TEST_SUITE_P(Random, PlannerOfAnyLight, testing::Range(0U, 30U));

}  // namespace
}  // namespace aphotic::wavelength_search_test
