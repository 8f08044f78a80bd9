// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_problem.h"

#include "base/degrees.h"
#include "base/error.h"
#include "rig/camera/vignetting.h"
#include "spectral/natural_water.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

namespace aphotic {
namespace {

struct WaterBounds {
    const char* key;
    double absent;  // where the rig does not tell it
    double least;
    double most;
    double plausible;  // and no less than its value
};
constexpr std::array<WaterBounds, 2> kWaterNumbers{
    {{"multiple", 1.0, 0.0, 1e3, 0.3}, {"uniform_loss_per_m", 0.0, 0.0, 1e2, 0.1}}};
// Chlorophyll: what the reader allows, and room for differences.
constexpr std::array<WaterBounds, 3> kCase1Numbers{{{"chlorophyll_mg_m3", 1.0, 0.0202, 29.8, 0.3},
                                                    {"cdom_440_per_m", 0.0, 0.0, 1e2, 0.05},
                                                    {"particles", 1.0, 0.0, 1e2, 0.3}}};

// What is asked for by one word each.
constexpr std::array kWords{
    "beam", "aim", "power", "water", "vignetting", "floor", "altitude", "attitude", "gain"};
constexpr std::size_t kByDefault = 6;

// Of keys that may be asked for by themselves: what is in them, and the word that they are part of.
struct KeyOfWord {
    std::string_view within;
    std::string_view word;
};
constexpr std::array<KeyOfWord, 8> kKeys{{{".aim_a", "aim"},
                                          {".power", "power"},
                                          {"camera.vignetting.a", "vignetting"},
                                          {"floor.brightness", "floor"},
                                          {"sled.altitude_offset_m", "altitude"},
                                          {"camera.pitch_offset_deg", "attitude"},
                                          {"camera.roll_offset_deg", "attitude"},
                                          {"gain.", "gain"}}};

std::string_view word_with(std::string_view key) {
    for (const auto& [within, word] : kKeys)
        if (key.find(within) != std::string_view::npos) return word;
    return {};
}

// By the word, or by a key that is part of it.
bool is_asked(const FitOptions& options, const std::string& word) {
    if (!options.free)
        return std::find(kWords.begin(), kWords.begin() + kByDefault, word) !=
               kWords.begin() + kByDefault;
    return std::ranges::any_of(*options.free, [&](const std::string& asked) {
        return asked == word || word_with(asked) == word;
    });
}

void require_known(const FitOptions& options, const Rig& rig) {
    for (const std::string& word : options.free.value_or(std::vector<std::string>{})) {
        if (std::ranges::find(kWords, word) != kWords.end() || word.starts_with("water.") ||
            !word_with(word).empty())
            continue;
        throw InputError(
            "--free: found '{}'; allowed: {}, or one number by its key, as water.multiple",
            word,
            fmt::join(kWords, ", "));
    }
    if (options.free && is_asked(options, "floor") && !rig.water.scatters()) {
        throw InputError(
            "--free: found floor in water that does not scatter; allowed: without it, for only the "
            "veil tells how bright the floor is");
    }
}

bool is_case_1(const RigText& rig) {
    return rig.has("water.chlorophyll_mg_m3");
}

// The water's numbers, which the state holds whether they are free or not.
void add_water(const RigText& text,
               const Rig& rig,
               const FitOptions& options,
               FitState& state,
               std::vector<FreeNumber>& free) {
    std::vector<std::string> known;
    const auto add = [&](const WaterBounds& bounds, bool is_free) {
        const std::string key = fmt::format("water.{}", bounds.key);
        known.push_back(key);
        const double value = text.number(key).value_or(bounds.absent);
        if (is_free) {
            free.push_back({.number = {FitPart::Water, state.water.size(), 0},
                            .key = key,
                            .plausible = std::max(bounds.plausible, 0.5 * value),
                            .least = bounds.least,
                            .most = bounds.most,
                            .group = "water"});
            state.water.push_back({.key = key, .value = value});
        }
    };
    const auto by_itself = [&](const char* key) {
        return options.free && std::ranges::find(*options.free, fmt::format("water.{}", key)) !=
                                   options.free->end();
    };
    if (is_case_1(text)) {
        for (WaterBounds bounds : kCase1Numbers) {
            // What the reader takes where cdom is not told.
            if (std::string_view(bounds.key) == "cdom_440_per_m")
                bounds.absent = case_1_cdom_440_per_m(*text.number("water.chlorophyll_mg_m3"));
            add(bounds, is_asked(options, "water") || by_itself(bounds.key));
        }
    } else {
        const bool is_all = is_asked(options, "water") && rig.water.multiple > 0.0;
        add(kWaterNumbers[0], is_all || by_itself("multiple"));
    }
    add(kWaterNumbers[1], by_itself("uniform_loss_per_m"));
    for (const std::string& word : options.free.value_or(std::vector<std::string>{})) {
        if (!word.starts_with("water.") || std::ranges::find(known, word) != known.end()) continue;
        throw InputError(
            "--free: found '{}'; allowed of this water: {}", word, fmt::join(known, ", "));
    }
}

// Strobes of like beams share one, unless each is to have its own.
void add_beams(const Rig& rig,
               const FitOptions& options,
               const FitAngles& angles,
               FitState& state,
               std::vector<FreeNumber>& free) {
    std::vector<std::string> signatures;
    for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
        const Beam& beam = rig.strobes[s].beam;
        const std::string signature =
            options.has_beam_each ? fmt::format("{}", s) : beam_signature(beam);
        const auto same = std::ranges::find(signatures, signature);
        state.beam_of.push_back(static_cast<std::size_t>(same - signatures.begin()));
        if (same != signatures.end()) continue;
        signatures.push_back(signature);
        const std::string name = rig.strobes[s].name;
        if (!is_asked(options, "beam")) {
            state.beams.push_back(FitBeam::held(beam));
        } else if (options.beam == FitBeamKind::Table) {
            state.beams.push_back(
                FitBeam::table(options.parts.value_or(kMostParts), angles.widest_rad));
        } else if (options.beam == FitBeamKind::Cones) {
            state.beams.push_back(FitBeam::cones(beam, angles.block_rad));
        } else if (options.beam == FitBeamKind::Cosine) {
            state.beams.push_back(
                FitBeam::cosine(beam.cones.empty() ? 1.0 : beam.cones.front().exponent));
        } else {
            state.beams.push_back(FitBeam::optics(beam));
        }
        const FitBeam& made = state.beams.back();
        for (std::size_t k = 0; k < made.shapes().size(); ++k) {
            const double shape = made.shapes()[k];
            free.push_back({.number = {FitPart::BeamShape, state.beams.size() - 1, k},
                            .key = fmt::format("strobe.{}.beam.{}", name, made.shape_names()[k]),
                            .plausible = std::max(0.3 * shape, 1e-3),
                            .least = 0.05 * shape,
                            .most = 50.0 * std::max(shape, 1e-3),
                            .per_unit = made.kind() == FitBeamKind::Optics ? kMillimetres : 1.0,
                            .group = "beam"});
        }
    }
}

void add_strobes(const Rig& rig,
                 const FitOptions& options,
                 FitState& state,
                 std::vector<FreeNumber>& free) {
    constexpr double kMostTurn_rad = 0.8;
    std::set<std::size_t> seen;  // beams whose first strobe has the power 1
    for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
        const std::string& name = rig.strobes[s].name;
        for (std::size_t k = 0; k < 2 && is_asked(options, "aim"); ++k) {
            free.push_back(
                {.number = {FitPart::Aim, s, k},
                 .key = fmt::format("strobe.{}.aim_{}_deg", name, k == 0 ? "along" : "across"),
                 .plausible = 10.0 * kRadiansPerDegree,
                 .least = -kMostTurn_rad,
                 .most = kMostTurn_rad,
                 .per_unit = kDegreesPerRadian,
                 .group = "aim"});
        }
        // One that is off is no reference for the others.
        if (state.power[s] <= 0.0) continue;
        const bool is_first = seen.insert(state.beam_of[s]).second;
        if (is_first || !is_asked(options, "power")) continue;
        free.push_back({.number = {FitPart::Power, s, 0},
                        .key = fmt::format("strobe.{}.power", name),
                        .plausible = 0.5 * state.power[s],
                        .least = 1e-3 * state.power[s],
                        .most = 1e3 * state.power[s],
                        .group = "power"});
    }
}

void add_camera(const Rig& rig,
                const FitOptions& options,
                FitState& state,
                std::vector<FreeNumber>& free) {
    if (is_asked(options, "vignetting")) {
        const RadialVignetting radial = radial_like(rig.camera);
        state.vignetting.assign(radial.a.begin(), radial.a.end());
        for (std::size_t k = 0; k < state.vignetting.size(); ++k) {
            free.push_back({.number = {FitPart::LensFactor, 0, k},
                            .key = fmt::format("camera.vignetting.a{}", k + 1),
                            .plausible = 0.5,
                            .group = "vignetting"});
        }
    }
    constexpr double kMostTilt_rad = 0.5;
    if (is_asked(options, "altitude")) {
        free.push_back({.number = {FitPart::Offset, 0, 0},
                        .key = "sled.altitude_offset_m",
                        .plausible = 0.2,
                        .least = -0.3 * rig.sled.altitude_m,
                        .most = 0.3 * rig.sled.altitude_m,
                        .group = "altitude"});
    }
    for (std::size_t k = 1; k <= 2 && is_asked(options, "attitude"); ++k) {
        free.push_back({.number = {FitPart::Offset, 0, k},
                        .key = k == 1 ? "camera.pitch_offset_deg" : "camera.roll_offset_deg",
                        .plausible = 3.0 * kRadiansPerDegree,
                        .least = -kMostTilt_rad,
                        .most = kMostTilt_rad,
                        .per_unit = kDegreesPerRadian,
                        .group = "attitude"});
    }
    if (rig.water.scatters() && is_asked(options, "floor")) {
        constexpr double kDarkest = 0.02;  // times the rig's; the brightest reflects all
        free.push_back({.number = {FitPart::FloorBrightness, 0, 0},
                        .key = "floor.brightness",
                        .plausible = 0.7,
                        .least = kDarkest,
                        .most = 1.0 / std::ranges::max(rig.seafloor.reflectance.values()),
                        .group = "floor"});
    }
    if (rig.camera.sensor.is_mono()) return;
    if (!is_asked(options, "gain")) {
        for (std::size_t k = 0; k < state.floor.size(); ++k) {
            free.push_back({.number = {FitPart::FloorColour, 0, k},
                            .key = k == 0 ? "floor.redness" : "floor.bend",
                            .plausible = 1.0,
                            .group = kFloorColour});
        }
        return;
    }
    for (const std::size_t c : {std::size_t{0}, std::size_t{2}}) {
        free.push_back({.number = {FitPart::Gain, c, 0},
                        .key = fmt::format("gain.{}", kChannelNames[c]),
                        .plausible = 1e3,
                        .least = 1e-6,
                        .most = 1e6,
                        .group = "gain"});
    }
}

// Of a word that was not asked for as a whole, the numbers alone that were.
void keep_those_asked(const FitOptions& options, FitProblem& problem) {
    if (!options.free) return;
    const auto has = [&](std::string_view word) {
        return std::ranges::find(*options.free, word) != options.free->end();
    };
    for (const std::string& key : *options.free) {
        const std::string_view word = word_with(key);
        if (word.empty() || key.starts_with("water.") ||
            std::ranges::count(problem.free, key, &FreeNumber::key) > 0)
            continue;
        std::vector<std::string> allowed;
        for (const FreeNumber& one : problem.free)
            if (one.group == word) allowed.push_back(one.key);
        throw InputError("--free: found '{}'; allowed: {}", key, fmt::join(allowed, ", "));
    }
    std::erase_if(problem.free, [&](const FreeNumber& one) {
        return !word_with(one.key).empty() && !has(one.group) && !has(one.key);
    });
}

}  // namespace

std::vector<FitNumber> FitProblem::numbers() const {
    std::vector<FitNumber> all;
    for (const FreeNumber& one : free) all.push_back(one.number);
    return all;
}

Eigen::VectorXd FitProblem::start() const {
    Eigen::VectorXd x(static_cast<Eigen::Index>(free.size()));
    std::ranges::transform(
        free, x.begin(), [](const FreeNumber& one) { return one.start / one.plausible; });
    return x;
}

Eigen::VectorXd FitProblem::now() const {
    FitState read = state;  // number_in() hands out what may be changed
    Eigen::VectorXd x(static_cast<Eigen::Index>(free.size()));
    std::ranges::transform(free, x.begin(), [&](const FreeNumber& one) {
        return number_in(read, one.number) / one.plausible;
    });
    return x;
}

Eigen::VectorXd FitProblem::plausible() const {
    Eigen::VectorXd scale(static_cast<Eigen::Index>(free.size()));
    std::ranges::transform(free, scale.begin(), &FreeNumber::plausible);
    return scale;
}

Eigen::VectorXd values_of(const Eigen::VectorXd& shares, const FitProblem& problem) {
    Eigen::VectorXd all(shares.size() + static_cast<Eigen::Index>(problem.free.size()));
    all << shares, problem.now().cwiseProduct(problem.plausible());
    return all;
}

FitState FitProblem::at(const double* x) const {
    FitState moved = state;
    for (std::size_t k = 0; k < free.size(); ++k)
        number_in(moved, free[k].number) = x[k] * free[k].plausible;
    return moved;
}

FitProblem fit_problem(const RigText& text, const FitOptions& options, const FitAngles& angles) {
    const Rig rig = text.rig();
    require_known(options, rig);
    FitProblem problem;
    FitState& state = problem.state;
    for (const Strobe& strobe : rig.strobes) {
        state.power.push_back(strobe.power);
        state.aim_rad.push_back({0.0, 0.0});
    }
    add_water(text, rig, options, state, problem.free);
    add_beams(rig, options, angles, state, problem.free);
    add_strobes(rig, options, state, problem.free);
    add_camera(rig, options, state, problem.free);
    keep_those_asked(options, problem);
    for (FreeNumber& one : problem.free) one.start = number_in(state, one.number);
    return problem;
}

std::vector<std::string> words_fixed_in(const FitProblem& problem) {
    std::set<std::string> free;
    for (const FreeNumber& one : problem.free) free.insert(one.group);
    for (const FitBeam& beam : problem.state.beams)
        if (beam.kind() != FitBeamKind::Held) free.insert("beam");
    // A beam of its own has its own power.
    const FitState& state = problem.state;
    if (free.contains("beam") && state.beams.size() == state.beam_of.size()) free.insert("power");
    std::vector<std::string> fixed;
    for (const char* word : kWords)
        if (!free.contains(word)) fixed.emplace_back(word);
    return fixed;
}

}  // namespace aphotic
