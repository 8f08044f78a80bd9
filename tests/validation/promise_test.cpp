// SPDX-License-Identifier: BSD-3-Clause
//
// What a plan promises, against the reference, on rigs that nobody chose: random geometry, water,
// materials, lamps, sensors and ports. Frames as POV-Ray would render them are the reference's own
// radiance at the planned wavelengths, exposed and rounded to half floats as the manifest says; the
// rule's weights make signals of them; what these should be is the reference's full spectrum.
//
// POV-Ray itself, its single-precision colours and its way to the inverse square law, is not in
// it: kFrameError keeps 2e-6 for these (spectral/quadrature_fit.h).
#include "base/error.h"
#include "rig/file/rig_reader.h"
#include "scene_gen/render_plan.h"
#include "scene_gen/scene_set.h"
#include "support/effort.h"
#include "support/flat.h"
#include "support/random_rig.h"
#include "validation/comparison.h"
#include "validation/tracer.h"
#include "validation/validation.h"

#include <gtest/gtest.h>
#include <half.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace aphotic::promise_test {
namespace {

constexpr std::uint64_t kSeed = 20240613;

constexpr std::uint64_t kMostRigs = 500;
constexpr unsigned kThreads = 2;

// Of every rig so many pixels: the reference traces whole rows.
constexpr std::size_t kRows = 4;
constexpr std::size_t kPixelsPerRow = 10;

const double kTolerance = PlanRequest{}.tolerance;
// For rigs of which kTolerance asks too much: none of these 500, nor of 1900 more.
constexpr double kLooseTolerance = 1e-2;
constexpr double kRareShare = 0.01;
// The worst tables ask for more wavelengths than there may be now and then.
constexpr double kNastyRefusals = 0.01;
// Large emitters of many cones ask for more lamps than POV-Ray takes, and steep tables behind ports
// for more wavelengths than there may be: six of these thirty.
constexpr double kExtendedRefusals = 0.25;

// Promises are to be worth something: on half of the rigs no more than so many times the error.
constexpr double kMedianRatio = 5.0;

// A rule's error is the largest on kCheckPaths paths. Between these it may rise, but the error
// swings no faster than a sum of some ten falling exponentials can: by far less than this share.
constexpr double kBetweenPaths = 0.02;
// What the reference's own spectrum may miss.
constexpr double kReferenceError = kSpectralError;

// --- Frames -----------------------------------------------------------------------------------

// The rig whose light is at every wavelength as the given rig's at lambda_nm, so that a frame with
// the refractive indices of another wavelength is this rig's radiance at that one.
Rig in_the_light_of(Rig rig, double lambda_nm) {
    for (Strobe& strobe : rig.strobes) strobe.spectrum = flat(strobe.spectrum.at(lambda_nm));
    rig.seafloor.reflectance = flat(rig.seafloor.reflectance.at(lambda_nm));
    for (Object& object : rig.objects) object.reflectance = flat(object.reflectance.at(lambda_nm));
    rig.water.absorption_per_m = flat(rig.water.attenuation_per_m(lambda_nm));
    rig.water.multiple = 1.0;
    rig.water.uniform_loss_per_m = 0.0;
    return rig;
}

// The floor's light alone, in water that takes as much of it: frames hold no veil.
Rig without_veil(Rig rig) {
    if (!rig.water.scatters()) return rig;
    const std::vector<double> knots_nm = union_of_knots(rig.water.curves(), rig.camera.range);
    std::vector<double> loss_per_m;
    for (const double nm : knots_nm) loss_per_m.push_back(rig.water.attenuation_per_m(nm));
    rig.water.absorption_per_m = {"loss", knots_nm, std::move(loss_per_m)};
    rig.water.multiple = 1.0;
    rig.water.uniform_loss_per_m = 0.0;
    rig.water.scatterers.clear();
    return rig;
}

Rig random_extended_rig_without_veil(std::uint64_t seed) {
    return without_veil(random_extended_rig(seed));
}

std::vector<double> frame_of(const Rig& rig, const PlannedWavelength& w) {
    const Tracer tracer(in_the_light_of(rig, w.lambda_nm),
                        {.signals = false, .planes_nm = {w.index_nm}});
    return tracer.rows(0, rig.camera.height_px);
}

// What is left of a radiance that went through a frame: POV-Ray writes single precision to half
// floats, rounded to the nearest; the integrator takes the exposure out again.
double through_half(double radiance, int exposure_log2) {
    const half sample(static_cast<float>(std::ldexp(radiance, exposure_log2)));
    return std::ldexp(static_cast<double>(static_cast<float>(sample)), -exposure_log2);
}

enum class Frames { Exact, Halves };

// R, G, B of every pixel by the plan's rule.
using Signals = std::array<std::vector<double>, kChannels>;
Signals signals_of(const Rig& rig, const Manifest& manifest, Frames kind) {
    Signals signals;
    for (const PlannedWavelength& w : manifest.wavelengths) {
        const std::vector<double> frame = frame_of(rig, w);
        for (std::size_t c = 0; c < kChannels; ++c) {
            signals[c].resize(frame.size());
            for (std::size_t i = 0; i < frame.size(); ++i) {
                const double radiance =
                    kind == Frames::Exact ? frame[i] : through_half(frame[i], w.exposure_log2);
                signals[c][i] += w.weight[c] * radiance;
            }
        }
    }
    return signals;
}

// --- Trials -----------------------------------------------------------------------------------

struct Trial {
    double tolerance = 0.0;  // 0: none could be kept
    std::string refusal;     // what the planner said last
    std::size_t frames = 0;
    std::size_t wavelengths = 0;
    double plan_s = 0.0;
    bool has_port = false;
    bool has_highlight = false;
    bool has_horizon = false;
    int compared = 0;  // samples
    double frame_error = 0.0;
    std::array<RuleQuality, kChannels> quality{};
    std::array<double, kChannels> found{};  // the largest error
    std::string fault;

    [[nodiscard]] double promise(std::size_t c) const { return quality[c].promise(frame_error); }
    // The worst channel's.
    [[nodiscard]] double promise() const { return std::max({promise(0), promise(1), promise(2)}); }
    [[nodiscard]] double largest_found() const { return std::ranges::max(found); }
};

std::optional<RenderPlan> try_plan(const Rig& rig,
                                   double tolerance,
                                   const SceneOptions& scene,
                                   std::string& refusal) {
    PlanRequest request;
    request.scene = scene;
    request.tolerance = tolerance;
    try {
        return plan_render(rig, request);
    } catch (const InputError& error) {
        refusal = error.what();
        return std::nullopt;
    }
}

struct Row {
    int number = 0;
    std::vector<std::size_t> columns;  // with light in any channel, off the cones' edges
};

std::vector<Row> lit_rows(const Tracer& tracer,
                          const Signals& signals,
                          const std::array<double, kChannels>& black) {
    const Camera& camera = tracer.rig().camera;
    const std::vector<unsigned char> on_edge = tracer.on_edges(camera.range);
    std::vector<Row> rows;
    std::size_t i = 0;
    for (int number = 0; number < camera.height_px; ++number) {
        Row row{.number = number, .columns = {}};
        for (std::size_t column = 0; column < static_cast<std::size_t>(camera.width_px); ++column) {
            bool is_lit = false;
            for (std::size_t c = 0; c < kChannels; ++c) is_lit |= signals[c][i] > black[c];
            if (is_lit && on_edge[i] == 0) row.columns.push_back(column);
            ++i;
        }
        if (!row.columns.empty()) rows.push_back(std::move(row));
    }
    return rows;
}

enum class Pixels { Some, All };

// On random pixels of random rows in which there is light, or on all.
void compare(const Rig& rig,
             const Manifest& manifest,
             Frames kind,
             Pixels pixels,
             Dice& dice,
             Trial& trial) {
    const Signals signals = signals_of(rig, manifest, kind);
    std::array<double, kChannels> black{};
    for (std::size_t c = 0; c < kChannels; ++c) {
        black[c] = std::max(kBlackShare * std::ranges::max(signals[c]), manifest.black(c));
    }
    const Tracer tracer(rig, {.signals = true, .planes_nm = {}});
    const std::vector<Row> rows = lit_rows(tracer, signals, black);
    if (rows.empty()) return;
    const auto width = static_cast<std::size_t>(rig.camera.width_px);
    const bool is_all = pixels == Pixels::All;
    for (std::size_t k = 0; k < (is_all ? rows.size() : kRows); ++k) {
        const Row& row = is_all ? rows[k] : rows[dice.index_in(rows)];
        const std::vector<double> traced = tracer.rows(row.number, 1);
        for (std::size_t p = 0; p < (is_all ? row.columns.size() : kPixelsPerRow); ++p) {
            const std::size_t column =
                is_all ? row.columns[p] : row.columns[dice.index_in(row.columns)];
            const std::size_t i = static_cast<std::size_t>(row.number) * width + column;
            for (std::size_t c = 0; c < kChannels; ++c) {
                const double right = traced[c * width + column];
                if (!(right > black[c])) continue;
                const double e = std::abs(relative_error(signals[c][i], right, black[c]));
                ++trial.compared;
                // What is no number is the largest of errors.
                constexpr double kNoNumber = std::numeric_limits<double>::infinity();
                trial.found[c] = std::max(trial.found[c], std::isnan(e) ? kNoNumber : e);
            }
        }
    }
}

Trial try_out(const Rig& rig,
              Frames kind,
              Dice dice,
              const SceneOptions& scene = {},
              Pixels pixels = Pixels::Some) {
    Trial trial;
    trial.has_port = rig.camera.port.has_value();
    trial.has_highlight = rig.seafloor.phong > 0.0;
    const auto start = std::chrono::steady_clock::now();
    std::optional<RenderPlan> plan;
    for (const double tolerance : {kTolerance, kLooseTolerance}) {
        plan = try_plan(rig, tolerance, scene, trial.refusal);
        if (plan) {
            trial.tolerance = tolerance;
            break;
        }
    }
    trial.plan_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (!plan) return trial;
    trial.has_horizon = path_range(rig).has_horizon;
    const SceneSet set = make_scene_set(rig, *plan);
    trial.frames = set.manifest.frames.size();
    trial.wavelengths = set.manifest.wavelengths.size();
    trial.quality = set.manifest.quality;
    trial.frame_error = set.manifest.frame_error;
    compare(rig, set.manifest, kind, pixels, dice, trial);
    return trial;
}

using MakeRig = Rig(std::uint64_t seed);

std::vector<Trial> try_out_all(MakeRig& make_rig,
                               std::uint64_t first_seed,
                               int count,
                               Frames kind) {
    std::vector<Trial> trials(static_cast<std::size_t>(count));
    std::atomic<std::size_t> next = 0;
    const auto work = [&] {
        for (std::size_t i = next++; i < trials.size(); i = next++) {
            try {
                const std::uint64_t seed = first_seed + i;
                trials[i] = try_out(make_rig(seed), kind, Dice(~seed));
            } catch (const InputError& error) {
                trials[i].refusal = error.what();
            } catch (const std::exception& error) {
                trials[i].fault = error.what();
            }
        }
    };
    std::vector<std::jthread> others;
    for (unsigned t = 1; t < kThreads; ++t) others.emplace_back(work);
    work();
    others.clear();  // joins
    return trials;
}

// --- Figures ----------------------------------------------------------------------------------

std::string description_of(const std::vector<Trial>& trials, std::size_t i) {
    const Trial& t = trials[i];
    std::ostringstream text;
    text << "rig " << i << ", " << t.wavelengths << " wavelengths in " << t.frames << " frames";
    if (t.has_port) text << ", behind a port";
    if (t.has_highlight) text << ", floor with a highlight";
    if (t.has_horizon) text << ", horizon in view";
    return text.str();
}

std::string description_of(const std::vector<Trial>& trials, std::size_t i, std::size_t c) {
    const RuleQuality& quality = trials[i].quality[c];
    std::ostringstream text;
    text << description_of(trials, i) << "; " << kChannelNames[c] << ": error " << quality.error
         << ", amplification " << quality.amplification << ", promise " << trials[i].promise(c)
         << ", found " << trials[i].found[c];
    return text.str();
}

double median(std::vector<double> values) {
    std::ranges::sort(values);
    return values.empty() ? 0.0 : values[values.size() / 2];
}

double median_ratio(const std::vector<Trial>& trials) {
    std::vector<double> ratios;
    for (const Trial& t : trials) ratios.push_back(t.promise() / t.largest_found());
    return median(std::move(ratios));
}

// The largest error, as a share of what its channel may err.
template <typename Bound>
double largest_share(const std::vector<Trial>& trials, const Bound& bound) {
    double largest = 0.0;
    for (const Trial& t : trials) {
        for (std::size_t c = 0; c < kChannels; ++c) {
            if (bound(t, c) > 0.0) largest = std::max(largest, t.found[c] / bound(t, c));
        }
    }
    return largest;
}

std::string frames_taken(const std::vector<Trial>& trials) {
    std::map<std::size_t, int> rigs;
    for (const Trial& t : trials) ++rigs[t.frames];
    std::ostringstream text;
    for (const auto& [frames, count] : rigs) text << ' ' << count << " x " << frames;
    return text.str();
}

// Planned, traced, and within the tolerance that was asked for.
void expect_sound(const std::vector<Trial>& trials) {
    for (std::size_t i = 0; i < trials.size(); ++i) {
        EXPECT_EQ(trials[i].fault, "") << description_of(trials, i);
        EXPECT_GT(trials[i].tolerance, 0.0)
            << description_of(trials, i) << ": " << trials[i].refusal;
        EXPECT_LE(trials[i].promise(), trials[i].tolerance) << description_of(trials, i);
        EXPECT_GT(trials[i].compared, 0) << description_of(trials, i);
    }
    const auto refused =
        std::ranges::count_if(trials, [](const Trial& t) { return t.tolerance != kTolerance; });
    EXPECT_LE(static_cast<double>(refused), kRareShare * static_cast<double>(trials.size()))
        << "rigs of which " << kTolerance << " asks too much";
}

void expect_kept(const std::vector<Trial>& trials, std::size_t i) {
    for (std::size_t c = 0; c < kChannels; ++c) {
        EXPECT_LE(trials[i].found[c], trials[i].promise(c)) << description_of(trials, i, c);
    }
}

// --- Claims -----------------------------------------------------------------------------------

TEST(Promise, HoldsOnRandomRigsAndIsSeldomFarAboveTheError) {
    const auto start = std::chrono::steady_clock::now();
    const std::vector<Trial> trials =
        try_out_all(random_rig, kSeed, campaign(60, kMostRigs), Frames::Halves);
    expect_sound(trials);
    for (std::size_t i = 0; i < trials.size(); ++i) expect_kept(trials, i);
    EXPECT_LE(median_ratio(trials), kMedianRatio);

    const double all_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::vector<double> plan_s;
    for (const Trial& t : trials) plan_s.push_back(t.plan_s);
    std::cout << trials.size() << " rigs in " << all_s << " s, a plan in " << median(plan_s)
              << " s (median), " << std::ranges::max(plan_s)
              << " s (longest)\npromise over error found: " << median_ratio(trials)
              << " (median)\nerror found over promise: "
              << largest_share(trials, [](const Trial& t, std::size_t c) { return t.promise(c); })
              << " (largest)\nframes:" << frames_taken(trials) << '\n';
}

TEST(Promise, HoldsWithUsersWorstTables) {
    const int count = campaign(20, 100);
    const std::vector<Trial> trials = try_out_all(random_nasty_rig, kSeed, count, Frames::Halves);
    int refused = 0;
    for (std::size_t i = 0; i < trials.size(); ++i) {
        EXPECT_EQ(trials[i].fault, "") << description_of(trials, i);
        if (trials[i].tolerance == 0.0) {
            ++refused;
            std::cout << description_of(trials, i) << ": " << trials[i].refusal << '\n';
        }
        expect_kept(trials, i);
    }
    EXPECT_LE(refused, kNastyRefusals * static_cast<double>(trials.size()) + 1.0);
}

// Through lenses and ports, by beams of every kind.
TEST(Promise, HoldsThroughLensesAndPorts) {
    const int count = campaign(3, 100);
    const char* first = std::getenv("APHOTIC_RIG_SEED");
    const std::vector<Trial> trials = try_out_all(random_extended_rig_without_veil,
                                                  first != nullptr ? std::stoull(first) : kSeed,
                                                  count,
                                                  Frames::Halves);
    int refused = 0;
    for (std::size_t i = 0; i < trials.size(); ++i) {
        EXPECT_EQ(trials[i].fault, "") << description_of(trials, i);
        if (trials[i].tolerance == 0.0) {
            ++refused;
            std::cout << description_of(trials, i) << ": " << trials[i].refusal << '\n';
        }
        expect_kept(trials, i);
    }
    EXPECT_LE(refused, kExtendedRefusals * static_cast<double>(trials.size()) + 1.0);
}

// Rigs that were found with promises that did not hold: by 114 times, 33 times, 1.8 times, and
// behind a port, where frames hold two wavelengths, by a twentieth.
TEST(Promise, HoldsWhereItOnceDidNot) {
    std::vector<Trial> trials;
    for (const auto& [name, per_frame] : {std::pair{"blind-red", 3},
                                          {"blind-blue-of-three-lamps", 3},
                                          {"blind-blue-in-clear-water", 3},
                                          {"highlight-behind-port", 2}}) {
        SceneOptions scene;
        scene.wavelengths_per_frame = per_frame;
        const std::filesystem::path folder = std::filesystem::path(APHOTIC_SOURCE_DIR);
        const Rig rig = read_rig(folder / "tests/rigs" / name / "rig.toml");
        trials.push_back(try_out(rig, Frames::Halves, Dice(kSeed), scene));
        expect_kept(trials, trials.size() - 1);
    }
    expect_sound(trials);
}

// A row of a beam's table that is steep over an angle which few places of an image see: the promise
// was broken by 8 % on some pixels.
TEST(Promise, HoldsAtEveryPixelOfSteepTablesBehindAPort) {
    const std::filesystem::path folder = std::filesystem::path(APHOTIC_SOURCE_DIR) / "tests/rigs";
    const Rig rig = read_rig(folder / "steep-table-behind-port/rig.toml");
    const std::vector<Trial> trials{
        try_out(rig, Frames::Halves, Dice(kSeed), SceneOptions{}, Pixels::All)};
    expect_sound(trials);
    expect_kept(trials, 0);
}

// Without any rounding a pixel is a sum of members of the family of light with factors that are not
// negative, so no pixel may err by more than the family's worst member.
TEST(Promise, OfTheWavelengthsAloneHoldsOnRandomRigs) {
    // None of the other test's rigs.
    const std::vector<Trial> trials =
        try_out_all(random_rig, kSeed + kMostRigs, campaign(20, 100), Frames::Exact);
    expect_sound(trials);
    const auto allowed = [](const Trial& t, std::size_t c) {
        return (1.0 + kBetweenPaths) * t.quality[c].error + kReferenceError;
    };
    for (std::size_t i = 0; i < trials.size(); ++i) {
        for (std::size_t c = 0; c < kChannels; ++c) {
            EXPECT_LE(trials[i].found[c], allowed(trials[i], c)) << description_of(trials, i, c);
        }
    }
    std::cout << trials.size() << " rigs: error found over that of the wavelengths: "
              << largest_share(trials, allowed) << " (largest)\n";
}

}  // namespace
}  // namespace aphotic::promise_test
