// SPDX-License-Identifier: BSD-3-Clause
//
// What a plan promises, against the reference, on rigs that nobody chose: random geometry, water,
// materials, lamps, sensors and ports. Frames as POV-Ray would render them are the reference's own
// radiance at the planned wavelengths, exposed and rounded to half floats as the manifest says; the
// rule's weights make signals of them; what these should be is the reference's full spectrum.
//
// POV-Ray itself, its single-precision colours and its way to the inverse square law, is not in
// it: kFrameError keeps 2e-6 for these (spectral/rule_fitter.h).
#include "scene_gen/geometry.h"
#include "scene_gen/render_plan.h"
#include "scene_gen/scene_set.h"
#include "spectral/builtin.h"
#include "spectral/error.h"
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
#include <exception>
#include <iostream>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace aphotic {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::uint64_t kSeed = 20240613;

#ifdef __OPTIMIZE__
constexpr int kRigs = 500;
constexpr int kRigsOfWavelengths = 100;
#else
// Unoptimised and with sanitizers the plan of one rig takes half a minute: there it is enough that
// every line runs.
constexpr int kRigs = 1;
constexpr int kRigsOfWavelengths = 1;
#endif
constexpr unsigned kThreads = 2;

// Of every rig so many pixels: the reference traces whole rows.
constexpr int kRows = 4;
constexpr int kPixelsPerRow = 10;

const double kTolerance = PlanRequest{}.tolerance;
// For rigs of which kTolerance asks too much: none of these 500, nor of 1900 more.
constexpr double kLooseTolerance = 1e-2;
constexpr double kRareShare = 0.01;

// Promises are to be worth something: on half of the rigs no more than so many times the error.
constexpr double kMedianRatio = 5.0;

// A rule's error is the largest on kCheckPaths paths. Between these it may rise, but the error
// swings no faster than a sum of some ten falling exponentials can: by far less than this share.
constexpr double kBetweenPaths = 0.02;
// What the reference's own spectrum may miss.
constexpr double kReferenceError = kSpectralError;

// --- Random rigs ---------------------------------------------------------------------------------

// The same throws with every standard library: only the engine is the standard's.
class Dice {
  public:
    explicit Dice(std::uint64_t seed) : engine_(seed) {}

    double between(double least, double most) { return least + (most - least) * unit(); }
    // Every octave as likely as any other.
    double over_octaves(double least, double most) {
        return least * std::exp2(std::log2(most / least) * unit());
    }
    int whole(int least, int most) { return least + static_cast<int>(unit() * (most - least + 1)); }
    bool chance(double share) { return unit() < share; }
    std::size_t index_in(const auto& list) {
        return static_cast<std::size_t>(unit() * static_cast<double>(list.size()));
    }
    template <std::size_t N>
    std::string_view one_of(const std::array<std::string_view, N>& names) {
        return names[index_in(names)];
    }

  private:
    // The engine's upper 53 bits, in [0, 1).
    double unit() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }

    std::mt19937_64 engine_;
};

// Straight lines between random values, some of them the least.
Spectrum random_curve(Dice& dice, double least, double most) {
    constexpr WavelengthRange kCovered{.first_nm = 360.0, .last_nm = 760.0};
    constexpr double kShareOfLeast = 0.15;
    const double spacing_nm = dice.over_octaves(4.0, 100.0);
    std::vector<double> lambda_nm{kCovered.first_nm};
    while (lambda_nm.back() < kCovered.last_nm) {
        lambda_nm.push_back(lambda_nm.back() + spacing_nm * dice.between(0.2, 1.8));
    }
    std::vector<double> values;
    for (std::size_t i = 0; i < lambda_nm.size(); ++i) {
        const double value = dice.between(least, most);
        values.push_back(dice.chance(kShareOfLeast) ? least : value);
    }
    return {"random", std::move(lambda_nm), std::move(values)};
}

Spectrum random_lamp(Dice& dice) {
    if (dice.chance(0.5)) {
        constexpr std::array<std::string_view, 3> kLamps{"xenon-flash", "xenon-arc", "cie-d65"};
        return load_curve(std::string(dice.one_of(kLamps)), CurveRole::LampSpectrum, {});
    }
    return random_curve(dice, 0.0, dice.over_octaves(1e-3, 1e3));
}

Spectrum random_reflectance(Dice& dice) {
    if (dice.chance(0.5)) {
        constexpr std::array<std::string_view, 4> kMaterials{
            "sand", "green-algae", "brown-algae", "red-algae"};
        return load_curve(std::string(dice.one_of(kMaterials)), CurveRole::Reflectance, {});
    }
    return random_curve(dice, 0.02, 1.0);
}

Sensor random_sensor(Dice& dice) {
    if (dice.chance(0.4)) return builtin_sensor("nikon-d5100");
    if (dice.chance(0.2)) {
        return {load_curves("cie-1931", CurveRole::ColourMatching, {}), ResponseKind::Energy};
    }
    std::vector<Spectrum> responses;
    for (int c = 0; c < kChannels; ++c) responses.push_back(random_curve(dice, 0.0, 1.0));
    return {std::move(responses), dice.chance(0.5) ? ResponseKind::Energy : ResponseKind::Quantum};
}

Water random_water(Dice& dice) {
    constexpr std::array<std::string_view, 2> kWaters{"pope-fry-1997", "pure-2016"};
    Water water{.absorption_per_m =
                    load_curve(std::string(dice.one_of(kWaters)), CurveRole::WaterAbsorption, {})};
    water.multiple = dice.chance(0.1) ? 0.0 : dice.between(0.0, 5.0);
    water.uniform_loss_per_m = dice.chance(0.3) ? dice.between(0.0, 0.5) : 0.0;
    water.salinity_psu = dice.between(0.0, 40.0);
    water.temperature_c = dice.between(-2.0, 35.0);
    return water;
}

// HabCam's chip in 48 by 36 pixels, behind its lens of 12 mm, a somewhat other, or now and then one
// so wide that a tilted sled has the horizon in view.
Camera random_camera(Dice& dice) {
    constexpr double kChipWidth_m = 1360 * 6.45e-6;
    Camera camera{.width_px = 48,
                  .height_px = 36,
                  .pixel_pitch_m = kChipWidth_m / 48,
                  .focal_length_m = dice.chance(0.1) ? 0.004 : dice.between(0.008, 0.016),
                  // Where Pope and Fry's table and all glasses but one have values.
                  .range = {dice.between(420.0, 440.0), dice.between(650.0, 720.0)},
                  .sensor = random_sensor(dice),
                  .port = std::nullopt};
    if (dice.chance(0.1)) {
        constexpr std::array<std::string_view, 5> kGlasses{
            "bk7", "fused-silica", "sapphire", "pmma", "polycarbonate"};
        camera.port = {.distance_m = dice.between(0.01, 0.05),
                       .thickness_m = dice.between(0.003, 0.03),
                       .glass = builtin_glass(dice.one_of(kGlasses))};
        camera.range.first_nm =
            std::max(camera.range.first_nm, camera.port->glass.range().first_nm);
    } else {
        camera.range.first_nm = dice.between(380.0, 440.0);
    }
    return camera;
}

Beam random_beam(Dice& dice) {
    Beam beam{.name = "random",
              .weights = dice.chance(0.8) ? ConeWeights::Flux : ConeWeights::Literal,
              .cones = {}};
    const int cones = dice.whole(1, 3);
    for (int k = 0; k < cones; ++k) {
        const double half_angle_deg = dice.chance(0.3) ? 90.0 : dice.over_octaves(3.0, 90.0);
        beam.cones.push_back({.part = "random",
                              .half_angle_rad = half_angle_deg * kDegree,
                              .weight = dice.between(0.05, 1.0)});
    }
    return beam;
}

// Around the camera, outside any housing, and above the floor.
Vector3d random_position_m(Dice& dice, const Sled& sled) {
    constexpr double kLeastHeight_m = 0.15;
    while (true) {
        const double around_rad = dice.between(0.0, 2.0 * std::numbers::pi);
        const double aside_m = dice.between(0.3, 1.0);
        Vector3d position_m(aside_m * std::cos(around_rad),
                            aside_m * std::sin(around_rad),
                            dice.between(-0.3, 0.3));
        if (position_m.norm() > 1.0) continue;
        if (height_above(floor_plane(sled), position_m) > kLeastHeight_m) return position_m;
    }
}

// A point of the floor in view; where that is the horizon, the floor on the camera's axis.
Vector3d random_aim_m(Dice& dice, const Rig& rig) {
    const double column = dice.between(0.0, rig.camera.width_px);
    const double row = dice.between(0.0, rig.camera.height_px);
    const double middle_nm = 0.5 * (rig.camera.range.first_nm + rig.camera.range.last_nm);
    const WaterRay ray = pixel_ray(rig, column, row, middle_nm);
    const auto distance_m = distance_to(floor_plane(rig.sled), ray);
    if (!distance_m) return {0.0, 0.0, rig.sled.altitude_m};
    return ray.origin_m + *distance_m * ray.direction;
}

Rig random_rig(std::uint64_t seed) {
    Dice dice(seed);
    const Sled sled{.altitude_m = dice.over_octaves(0.5, 10.0),
                    .pitch_rad = dice.between(-30.0, 30.0) * kDegree,
                    .roll_rad = dice.between(-30.0, 30.0) * kDegree};
    Rig rig{.title = "random",
            .sled = sled,
            .camera = random_camera(dice),
            .water = random_water(dice),
            .seafloor = {.reflectance = random_reflectance(dice)},
            .strobes = {},
            .materials = {},
            .digest = ""};
    if (dice.chance(0.2)) {
        rig.seafloor.phong = dice.between(0.05, 1.0);
        rig.seafloor.phong_size = dice.over_octaves(4.0, 200.0);
    }
    if (dice.chance(0.1)) rig.materials.push_back(random_reflectance(dice));
    const Spectrum lamp = random_lamp(dice);
    const bool is_mixed = dice.chance(0.2);
    const Spectrum other_lamp = is_mixed ? random_lamp(dice) : lamp;
    const int strobes = dice.whole(1, 6);
    for (int s = 0; s < strobes; ++s) {
        const Vector3d position_m = random_position_m(dice, sled);
        const Vector3d aim_m = random_aim_m(dice, rig);
        rig.strobes.push_back({.name = std::to_string(s),
                               .position_m = position_m,
                               .axis = (aim_m - position_m).normalized(),
                               .beam = random_beam(dice),
                               .spectrum = s % 2 == 0 ? lamp : other_lamp,
                               .power = dice.over_octaves(0.1, 100.0),
                               .emitter = std::nullopt});
    }
    return rig;
}

// --- Frames --------------------------------------------------------------------------------------

Spectrum flat(double value) {
    return {"flat", {300.0, 800.0}, {value, value}};
}

// The rig whose light is at every wavelength as the given rig's at lambda_nm, so that a frame with
// the refractive indices of another wavelength is this rig's radiance at that one.
Rig in_the_light_of(Rig rig, double lambda_nm) {
    for (Strobe& strobe : rig.strobes) strobe.spectrum = flat(strobe.spectrum.at(lambda_nm));
    rig.seafloor.reflectance = flat(rig.seafloor.reflectance.at(lambda_nm));
    rig.water.absorption_per_m = flat(rig.water.attenuation_per_m(lambda_nm));
    rig.water.multiple = 1.0;
    rig.water.uniform_loss_per_m = 0.0;
    return rig;
}

std::vector<double> frame_of(const Rig& rig, const ManifestWavelength& w) {
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
    for (const ManifestWavelength& w : manifest.wavelengths) {
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

// --- Trials --------------------------------------------------------------------------------------

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

std::optional<RenderPlan> try_plan(const Rig& rig, double tolerance, std::string& refusal) {
    PlanRequest request;
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

// On random pixels of random rows in which there is light.
void compare(const Rig& rig, const Manifest& manifest, Frames kind, Dice& dice, Trial& trial) {
    const Signals signals = signals_of(rig, manifest, kind);
    std::array<double, kChannels> black{};
    for (std::size_t c = 0; c < kChannels; ++c) {
        black[c] = std::max(kBlackShare * std::ranges::max(signals[c]), manifest.black(c));
    }
    const Tracer tracer(rig, {.signals = true, .planes_nm = {}});
    const std::vector<Row> rows = lit_rows(tracer, signals, black);
    if (rows.empty()) return;
    const auto width = static_cast<std::size_t>(rig.camera.width_px);
    for (int k = 0; k < kRows; ++k) {
        const Row& row = rows[dice.index_in(rows)];
        const std::vector<double> traced = tracer.rows(row.number, 1);
        for (int p = 0; p < kPixelsPerRow; ++p) {
            const std::size_t column = row.columns[dice.index_in(row.columns)];
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

Trial try_out(std::uint64_t seed, Frames kind) {
    const Rig rig = random_rig(seed);
    Trial trial;
    trial.has_port = rig.camera.port.has_value();
    trial.has_highlight = rig.seafloor.phong > 0.0;
    const auto start = std::chrono::steady_clock::now();
    std::optional<RenderPlan> plan;
    for (const double tolerance : {kTolerance, kLooseTolerance}) {
        plan = try_plan(rig, tolerance, trial.refusal);
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
    Dice dice(~seed);
    compare(rig, set.manifest, kind, dice, trial);
    return trial;
}

std::vector<Trial> try_out_all(std::uint64_t first_seed, int count, Frames kind) {
    std::vector<Trial> trials(static_cast<std::size_t>(count));
    std::atomic<std::size_t> next = 0;
    const auto work = [&] {
        for (std::size_t i = next++; i < trials.size(); i = next++) {
            try {
                trials[i] = try_out(first_seed + i, kind);
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

// --- Figures -------------------------------------------------------------------------------------

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

// --- Claims --------------------------------------------------------------------------------------

TEST(Promise, HoldsOnRandomRigsAndIsSeldomFarAboveTheError) {
    const auto start = std::chrono::steady_clock::now();
    const std::vector<Trial> trials = try_out_all(kSeed, kRigs, Frames::Halves);
    expect_sound(trials);
    for (std::size_t i = 0; i < trials.size(); ++i) {
        for (std::size_t c = 0; c < kChannels; ++c) {
            EXPECT_LE(trials[i].found[c], trials[i].promise(c)) << description_of(trials, i, c);
        }
    }
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

// Without any rounding a pixel is a sum of members of the family of light with factors that are not
// negative, so no pixel may err by more than the family's worst member.
TEST(Promise, OfTheWavelengthsAloneHoldsOnRandomRigs) {
    // None of the other test's rigs.
    const std::vector<Trial> trials = try_out_all(kSeed + kRigs, kRigsOfWavelengths, Frames::Exact);
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
}  // namespace aphotic
