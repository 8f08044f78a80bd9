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
#include <cmath>
#include <string_view>
#include <variant>

namespace aphotic {
namespace {

using Eigen::Index;

constexpr double kTurn = 0.8;  // the largest error of an aim [rad]

// The numbers requested by one word, and their prior.
struct Word {
    std::string_view name;
    double spread;  // in the key's unit, or of the logarithm
    bool is_by_default;
};
constexpr std::array<Word, 9> kWords{{{"beam", kShapeSpread, true},
                                      {"aim", 2.0, true},
                                      {"power", 0.1, true},
                                      {"water", 0.3, true},
                                      {"vignetting", 1.5, true},
                                      {"floor", 0.5, true},
                                      {"tint", 0.5, true},
                                      {"altitude", 0.1, false},
                                      {"attitude", 2.0, false}}};
constexpr double kRadialSpread = 0.3;
constexpr double kLossSpread_per_m = 0.05;
constexpr double kMostCosine = 50.0;
constexpr double kUsualCosine = 3.0;  // for a lens that the rig does not describe

const Word& word_named(std::string_view name) {
    return *std::ranges::find(kWords, name, &Word::name);
}

bool has(const std::vector<std::string>& list, std::string_view word) {
    return std::ranges::find(list, word) != list.end();
}

class Problem {
  public:
    Problem(const RigText& text, const FitOptions& options)
        : text_(text), rig_(text.rig()), options_(options) {}

    FitProblem of(double widest_rad, double block_rad) {
        for (const Strobe& strobe : rig_.strobes) {
            state_.power.push_back(strobe.power);
            state_.aim_rad.push_back({0.0, 0.0});
        }
        add_beams(widest_rad, block_rad);
        add_strobes();
        add_water();
        add_floor();
        add_vignetting();
        add_offsets();
        require_known();
        require_fitted();
        return with_priors();
    }

  private:
    // Requested by its word or its key, and not held.
    [[nodiscard]] bool is_free(std::string_view word, const std::string& key) const {
        if (has(options_.hold, word) || has(options_.hold, key)) return false;
        // The floor's colour is free unless it is held, since it is never known.
        if (word == "tint" || !options_.free) return word_named(word).is_by_default;
        return has(*options_.free, word) || has(*options_.free, key);
    }

    void add(std::string_view word, FitNumber number) {
        known_.push_back(number.key);
        if (!is_free(word, number.key)) return;
        number.word = word;
        const auto told = [&](std::string_view name) {
            const auto at = options_.priors.find(std::string(name));
            // Relative, or in the key's unit.
            if (at != options_.priors.end())
                number.spread = number.is_log ? at->second : at->second / number.per_unit;
        };
        told(word);
        told(number.key);
        constexpr double kFarthest = 20.0;  // spreads, if nothing else bounds it
        if (number.least == number.most) {
            number.least = -kFarthest * number.spread;
            number.most = kFarthest * number.spread;
        }
        number.start = number_in(state_, number.at);
        numbers_.push_back(number);
    }

    // Weights of a beam's prior, relative to its own.
    [[nodiscard]] double as_told() const {
        const auto told = options_.priors.find("beam");
        return told == options_.priors.end() ? 1.0 : kShapeSpread / told->second;
    }

    // Strobes with equal beams share one, unless each is to have its own.
    void add_beams(double widest_rad, double block_rad) {
        std::vector<std::string> signatures;
        for (std::size_t s = 0; s < rig_.strobes.size(); ++s) {
            const Beam& beam = rig_.strobes[s].beam;
            const std::string signature =
                options_.has_beam_each ? fmt::format("{}", s) : beam_signature(beam);
            const auto same = std::ranges::find(signatures, signature);
            const auto b = static_cast<std::size_t>(same - signatures.begin());
            state_.beam_of.push_back(b);
            if (same != signatures.end()) continue;
            signatures.push_back(signature);
            const std::string key = fmt::format("strobe.{}.beam", rig_.strobes[s].name);
            const FitBeamKind kind = is_free("beam", key) ? options_.beam : FitBeamKind::Held;
            const FitBeam& made =
                state_.beams.emplace_back(kind, beam, widest_rad + kAimRoom_rad, block_rad);
            const std::vector<std::string> names = made.names();
            for (std::size_t k = 0; k < made.coefficients().size(); ++k) {
                FitNumber number{.at = {FitPart::Beam, b, k}, .key = key};
                number.word = "beam";
                number.start = made.coefficients()[k];
                if (!names.empty()) number.spread = made.spread() / as_told();
                number.least = -kFarthestCoefficient;
                number.most = kFarthestCoefficient;
                number.is_log = !names.empty();
                number.per_unit = kind == FitBeamKind::Optics ? kMillimetres : 1.0;
                number.key += names.empty() ? fmt::format(".ln_{}", k) : "." + names[k];
                numbers_.push_back(number);
            }
            known_.push_back(key);
        }
    }

    void add_strobes() {
        for (std::size_t s = 0; s < rig_.strobes.size(); ++s) {
            const std::string key = "strobe." + rig_.strobes[s].name;
            for (std::size_t k = 0; k < 2; ++k) {
                add("aim",
                    {.at = {FitPart::Aim, s, k},
                     .key = fmt::format("{}.aim_{}_deg", key, k == 0 ? "along" : "across"),
                     .spread = word_named("aim").spread * kRadiansPerDegree,
                     .per_unit = kDegreesPerRadian,
                     .least = -kTurn,
                     .most = kTurn});
            }
            if (state_.power[s] <= 0.0) continue;
            const std::string unit = power_key(text_, rig_.strobes[s].name);
            add("power",
                {.at = {FitPart::Power, s},
                 .key = unit,
                 .spread = word_named("power").spread,
                 .is_log = true,
                 .per_unit = text_.number(unit).value_or(1.0) / state_.power[s]});
        }
    }

    void add_water() {
        const auto one = [&](const char* name, double absent, double least, double most) {
            const std::string key = fmt::format("water.{}", name);
            const double value = text_.number(key).value_or(absent);
            state_.water.push_back({.key = key, .value = value});
            FitNumber number{.at = {FitPart::Water, state_.water.size() - 1}, .key = key};
            // A number at 0 can grow, but not by a factor.
            number.is_log = value > 0.0;
            number.spread = number.is_log ? word_named("water").spread : kLossSpread_per_m;
            number.least = number.is_log ? std::log(least / value) : 0.0;
            number.most = number.is_log ? std::log(most / value) : most;
            const std::size_t had = numbers_.size();
            add("water", number);
            if (numbers_.size() == had) state_.water.pop_back();
        };
        if (const auto chlorophyll = text_.number("water.chlorophyll_mg_m3")) {
            // The reader's limits, with room for differences.
            one("chlorophyll_mg_m3", 1.0, 0.0202, 29.8);
            one("cdom_440_per_m", case_1_cdom_440_per_m(*chlorophyll), 1e-6, 1e2);
            one("particles", 1.0, 1e-3, 1e2);
        } else if (rig_.water.multiple > 0.0) {
            one("multiple", 1.0, 1e-3, 1e3);
        }
        if (options_.free && has(*options_.free, "water.uniform_loss_per_m"))
            one("uniform_loss_per_m", 0.0, 1e-6, 1e2);
    }

    void add_floor() {
        if (rig_.water.scatters()) {
            add("floor",
                {.at = {FitPart::Brightness},
                 .key = "floor.brightness",
                 .spread = word_named("floor").spread,
                 .is_log = true,
                 .least = std::log(kDarkest),
                 .most = -std::log(std::ranges::max(rig_.seafloor.reflectance.values()))});
        } else if (options_.free && has(*options_.free, "floor")) {
            throw InputError(
                "--free: found floor in water that does not scatter; allowed: without it, since "
                "only the veil tells how bright the floor is");
        }
        if (rig_.camera.sensor.is_mono()) return;
        for (std::size_t k = 0; k < 2; ++k) {
            add("tint",
                {.at = {FitPart::Tint, 0, k},
                 .key = k == 0 ? "floor.redness" : "floor.bend",
                 .spread = word_named("tint").spread});
        }
    }

    void add_vignetting() {
        const auto& lens = rig_.camera.vignetting;
        const bool is_radial = options_.has_radial_vignetting.value_or(
            lens && !std::holds_alternative<NaturalVignetting>(*lens));
        const std::size_t had = numbers_.size();
        if (is_radial) {
            const RadialVignetting radial = radial_like(rig_.camera);
            state_.vignetting.assign(radial.a.begin(), radial.a.end());
        } else {
            const auto* natural = lens ? std::get_if<NaturalVignetting>(&*lens) : nullptr;
            state_.vignetting = {natural != nullptr ? natural->exponent : kUsualCosine};
        }
        for (std::size_t k = 0; k < state_.vignetting.size(); ++k) {
            FitNumber number{.at = {FitPart::Lens, 0, k},
                             .key = fmt::format("camera.vignetting.a{}", k + 1),
                             .spread = kRadialSpread};
            if (!is_radial) {
                number.key = "camera.vignetting.cosine";
                number.spread = word_named("vignetting").spread;
                number.least = -state_.vignetting.front();  // rigs allow 0 to kMostCosine
                number.most = kMostCosine - state_.vignetting.front();
            }
            add("vignetting", number);
        }
        if (numbers_.size() == had) state_.vignetting.clear();
    }

    void add_offsets() {
        add("altitude",
            {.at = {FitPart::Offset},
             .key = "sled.altitude_offset_m",
             .spread = word_named("altitude").spread});
        for (std::size_t k = 1; k <= 2; ++k) {
            add("attitude",
                {.at = {FitPart::Offset, 0, k},
                 .key = k == 1 ? "camera.pitch_offset_deg" : "camera.roll_offset_deg",
                 .spread = word_named("attitude").spread * kRadiansPerDegree,
                 .per_unit = kDegreesPerRadian});
        }
    }

    void require_known() const {
        const auto require = [&](const char* option, const std::string& asked) {
            if (std::ranges::count(kWords, asked, &Word::name) > 0 || has(known_, asked)) return;
            std::vector<std::string_view> words;
            for (const Word& word : kWords) words.push_back(word.name);
            throw InputError("{}: found '{}'; allowed: {}, or one number by its key: {}",
                             option,
                             asked,
                             fmt::join(words, ", "),
                             fmt::join(known_, ", "));
        };
        for (const std::string& asked : options_.free.value_or(std::vector<std::string>{}))
            require("--free", asked);
        for (const std::string& asked : options_.hold) require("--hold", asked);
        for (const auto& [asked, spread] : options_.priors) require("--prior", asked);
    }

    // Options about numbers require that these are fitted.
    void require_fitted() const {
        const auto is_fitted = [&](std::string_view word) {
            return std::ranges::any_of(numbers_, [&](const FitNumber& number) {
                return number.word == word || number.key == word;
            });
        };
        if (numbers_.empty())
            throw InputError("{}: found nothing to fit; allowed: a word or a key",
                             options_.free ? "--free" : "--hold");
        if ((options_.beam != FitBeamKind::Table || options_.has_beam_each) && !is_fitted("beam"))
            throw InputError(
                "--beam: found with a beam that is not fitted; allowed: with beam free");
        if (options_.has_radial_vignetting && !is_fitted("vignetting"))
            throw InputError(
                "--vignetting: found with a lens that is not fitted; allowed: with vignetting "
                "free");
        for (const auto& [asked, spread] : options_.priors) {
            if (!is_fitted(asked))
                throw InputError("--prior: found '{}', which is not fitted; allowed: what is free",
                                 asked);
            if (!(spread > 0.0) || !std::isfinite(spread))
                throw InputError("--prior: found {} of {}; allowed: a standard deviation above 0",
                                 spread,
                                 asked);
        }
    }

    FitProblem with_priors() {
        const auto count = std::ssize(numbers_);
        FitProblem problem{.start = state_,
                           .numbers = numbers_,
                           .prior_rows = Eigen::MatrixXd::Zero(count, count),
                           .prior_means = Eigen::VectorXd::Zero(count)};
        Eigen::MatrixXd& rows = problem.prior_rows;
        // A table's are related by its prior alone.
        for (Index k = 0; k < count; ++k) {
            const FitNumber& number = numbers_[static_cast<std::size_t>(k)];
            if (number.at.part != FitPart::Beam || number.is_log) rows(k, k) = 1.0 / number.spread;
        }
        Index first = 0;
        for (const FitBeam& beam : state_.beams) {
            const BeamPrior& prior = beam.prior();
            const Index own = prior.rows.rows();
            rows.conservativeResizeLike(Eigen::MatrixXd::Zero(rows.rows() + own, count));
            rows.block(rows.rows() - own, first, own, prior.rows.cols()) = as_told() * prior.rows;
            problem.prior_means.conservativeResize(rows.rows());
            problem.prior_means.tail(own) = as_told() * prior.means;
            first += std::ssize(beam.coefficients());
        }
        return problem;
    }

    // The error of an aim that keeps the image within a beam's table.
    static constexpr double kAimRoom_rad = 0.15;
    static constexpr double kFarthestCoefficient = 12.0;
    static constexpr double kDarkest = 0.02;  // times the rig's floor; the brightest reflects all

    const RigText& text_;
    Rig rig_;
    const FitOptions& options_;
    FitState state_;
    std::vector<FitNumber> numbers_;
    std::vector<std::string> known_;
};

}  // namespace

double FitNumber::value(double x) const {
    return is_log ? start * std::exp(x) : start + x;
}

double FitNumber::slope(double x) const {
    return is_log ? start * std::exp(x) : 1.0;
}

double FitNumber::shown(double x) const {
    return per_unit * value(x);
}

double FitNumber::shown_slope(double x) const {
    return per_unit * slope(x);
}

FitState FitProblem::state_at(const Eigen::VectorXd& x) const {
    FitState state = start;
    for (std::size_t k = 0; k < numbers.size(); ++k)
        number_in(state, numbers[k].at) = numbers[k].value(x(static_cast<Index>(k)));
    return state;
}

std::vector<FitPlaceInState> FitProblem::places() const {
    std::vector<FitPlaceInState> places;
    for (const FitNumber& number : numbers) places.push_back(number.at);
    return places;
}

std::string power_key(const RigText& text, const std::string& strobe) {
    const std::string key = "strobe." + strobe;
    for (const char* unit : {".luminous_flux_lm", ".radiant_flux_w", ".energy_j"})
        if (text.has(key + unit)) return key + unit;
    return key + ".power";
}

void require_fit_options(const RigText& text, const FitOptions& options) {
    constexpr double kAny_rad = 1.0;
    static_cast<void>(fit_problem(text, options, kAny_rad, kAny_rad));
}

FitProblem fit_problem(const RigText& text,
                       const FitOptions& options,
                       double widest_rad,
                       double block_rad) {
    return Problem(text, options).of(widest_rad, block_rad);
}

}  // namespace aphotic
