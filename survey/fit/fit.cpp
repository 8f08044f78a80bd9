// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit.h"

#include "base/error.h"
#include "base/words.h"
#include "survey/fit/fit_check.h"
#include "survey/fit/fit_errors.h"
#include "survey/fit/fit_objective.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace aphotic {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNear = 0.2;  // of a number's error
constexpr double kNearest = 0.05;
constexpr double kFirstShare = 0.3;  // of the time

// Every other image, or pair of images, of those.
FitSamples half_of(const FitSamples& samples,
                   const std::vector<std::size_t>& images,
                   std::size_t split,
                   std::size_t which) {
    FitSamples half{.places = samples.places};
    for (std::size_t k = 0; k < images.size(); ++k)
        if ((k >> split) % 2 == which) half.images.push_back(samples.images[images[k]]);
    return half;
}

// Edges are found from as far away as they are soft, and aims may be some degrees off: where blocks
// are finer, a search for cones begins with softer ones.
FitPoint start_of(const FitObjective& objective,
                  const RigText& text,
                  const FitSamples& samples,
                  const FitOptions& options,
                  const FitLight& light,
                  double widest_rad) {
    FitPoint start = objective.first_point();
    constexpr double kSoft_rad = 0.1;
    if (options.beam != FitBeamKind::Cones || light.block_rad() > kSoft_rad) return start;
    const FitProblem problem = fit_problem(text, options, widest_rad, kSoft_rad);
    const FitObjective softer(text, samples, options, light, problem);
    start.x = softer.search(softer.first_point(), kNear, [](int) {}).x;
    return start;
}

// The curvature with as many images again, in level flight at an altitude.
struct CurvatureAt {
    double altitude_m = 0.0;
    MatrixXd curvature;
};
struct Curvatures {
    MatrixXd now;
    std::vector<CurvatureAt> with_more;
};
Curvatures curvatures_of(const FitObjective& objective,
                         const FitPoint& point,
                         const FitSamples& samples) {
    constexpr std::array kAltitudes{0.5, 0.7, 1.4, 2.0};  // of the mean
    const auto count = static_cast<double>(samples.images.size());
    double altitude_m = 0.0;
    for (const FitImage& image : samples.images) altitude_m += image.sled.altitude_m / count;
    Curvatures all{.now = objective.curvature_of(objective.terms_at(point, Curvature::Majorant)),
                   .with_more = {}};
    for (const double times : kAltitudes) {
        const double there_m = times * altitude_m;
        const MatrixXd one = objective.information_at(point, {.altitude_m = there_m});
        all.with_more.push_back({.altitude_m = there_m, .curvature = all.now + count * one});
    }
    return all;
}

// The altitude at which more images would improve a number most.
std::optional<FlyAt> fly_at(const Curvatures& curvatures, Index number, double error) {
    constexpr double kHelps = 0.7;
    const auto error_of = [&](const MatrixXd& A) {
        return std::sqrt(A.ldlt().solve(VectorXd::Unit(A.rows(), number))(number));
    };
    const double now = error_of(curvatures.now);
    std::optional<FlyAt> best;
    double least = kHelps * now;
    for (const CurvatureAt& there : curvatures.with_more) {
        const double then = error_of(there.curvature);
        if (!(then < least)) continue;
        least = then;
        best = FlyAt{.altitude_m = there.altitude_m, .error = error * then / now};
    }
    return best;
}

// The beam scaled to a flux of 1; covariance: of its coefficients.
std::vector<BeamPoint> curve_of(const FitBeam& beam, const MatrixXd& covariance) {
    constexpr int kPoints = 91;
    const double flux = beam.fitted().flux;
    const double widest_rad = std::min(beam.widest_rad(), 1.57);
    std::vector<BeamPoint> points;
    BeamValue value;
    for (int i = 0; i < kPoints; ++i) {
        const double theta_rad = widest_rad * i / (kPoints - 1);
        beam.at({std::sin(theta_rad), 0.0, std::cos(theta_rad)}, value);
        VectorXd slopes = VectorXd::Zero(covariance.rows());
        slopes.segment(static_cast<Index>(value.first), std::ssize(value.by)) =
            VectorXd::Map(value.by.data(), std::ssize(value.by));
        points.push_back(
            {.theta_rad = theta_rad,
             .intensity = value.intensity / flux,
             .error = std::sqrt(std::max(0.0, slopes.dot(covariance * slopes))) / flux});
    }
    return points;
}

std::vector<Confounded> confounded_in(const FitProblem& problem, const MatrixXd& covariance) {
    constexpr double kMuch = 0.9;
    std::vector<Confounded> found;
    for (std::size_t i = 0; i < problem.numbers.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const auto a = static_cast<Index>(i);
            const auto b = static_cast<Index>(j);
            const FitPart one = problem.numbers[i].at.part;
            const FitPart other = problem.numbers[j].at.part;
            const bool is_curve = one == FitPart::Beam || other == FitPart::Beam;
            // What one lamp of two has less, the other has more.
            const bool are_powers = one == FitPart::Power && other == FitPart::Power;
            const double correlation =
                covariance(a, b) / std::sqrt(covariance(a, a) * covariance(b, b));
            if (!is_curve && !are_powers && std::abs(correlation) > kMuch)
                found.push_back({problem.numbers[j].key, problem.numbers[i].key, correlation});
        }
    }
    std::ranges::sort(found, [](const Confounded& a, const Confounded& b) {
        return std::abs(a.correlation) > std::abs(b.correlation);
    });
    return found;
}

// Observed and fitted.
FitView view_of(const FitObjective& objective,
                const FitPoint& point,
                const FitSamples& samples,
                std::size_t image,
                const ImageView& seen) {
    const auto mu = point.x.tail(static_cast<Index>(objective.channels()));
    FitView view{.image = image, .observed = {}, .fitted = {}};
    for (std::size_t c = 0; c < kChannels; ++c) {
        const auto of = static_cast<Index>(std::min(c, objective.channels() - 1));
        for (std::size_t place = 0; place < samples.places.size(); ++place) {
            const Index at = static_cast<Index>(place * kChannels) + of;
            view.observed.push_back(samples.images[image].signal[static_cast<std::size_t>(at)]);
            view.fitted.push_back(static_cast<float>(
                std::exp(seen.light.logarithm(at) + mu(of) + seen.level(of, 0))));
        }
    }
    return view;
}

// The lowest image, a middle one, and the highest.
std::vector<std::size_t> images_to_show(const FitSamples& samples) {
    std::vector<std::size_t> order(samples.images.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return samples.images[i].sled.altitude_m; });
    if (order.size() > kFitViews)
        order = {order.front(), order[(order.size() - 1) / 2], order.back()};
    return order;
}

// All that the result tells of the images; those that count.
std::vector<std::size_t> add_images(const FitObjective& objective,
                                    const FitPoint& point,
                                    const FitModel& model,
                                    const FitSamples& samples,
                                    FitResult& result) {
    const auto q = static_cast<Index>(objective.channels());
    const Index green = q / 2;  // or a mono camera's one channel
    const std::vector<std::size_t> shown = images_to_show(samples);
    result.views.resize(shown.size());
    std::vector<std::size_t> counted;
    std::vector<std::vector<float>> residuals(samples.images.size());
    double veil = 0.0;
    double rows = 0.0;
    for (std::size_t i = 0; i < samples.images.size(); ++i) {
        const ImageView seen = objective.view(point, model, i);
        if (objective.counts(seen)) counted.push_back(i);
        result.blocks += seen.blocks;
        result.images.push_back({.name = samples.images[i].name,
                                 .sled = samples.images[i].sled,
                                 .off = point.pose[i],
                                 .brightness = seen.level(green, 0)});
        for (Index row = green; row < seen.rows.rows(); row += q)
            residuals[i].push_back(static_cast<float>(seen.rows(row, 0)));
        for (const double share : seen.light.floor_share) {
            if (!std::isfinite(share)) continue;
            veil += 1.0 - share;
            rows += 1.0;
        }
        const auto view = std::ranges::find(shown, i);
        if (view != shown.end())
            result.views[static_cast<std::size_t>(view - shown.begin())] =
                view_of(objective, point, samples, i, seen);
    }
    result.pattern = fixed_pattern(residuals, samples.places.across());
    result.veil_share = veil / std::max(rows, 1.0);
    result.texture = std::sqrt(point.texture.details.front()(green, green));
    result.level_spread = std::sqrt(point.texture.level(green, green));
    return counted;
}

// The difference of the logarithms of the fitted map and that of the rig as it is, none of its
// forms replaced, over the flight, at the blocks that count, less each channel's mean; rms. Where
// the rig gives no light, it counts as the darkest that would.
double moved_from_rig(const RigText& text,
                      const FitSamples& samples,
                      const FitLight& light,
                      const FitObjective& objective,
                      const FitPoint& point) {
    const FitOptions held{.free = std::vector<std::string>{"altitude"}};
    const FitState as_it_is =
        fit_problem(text, held, light.widest_rad(samples.images), light.block_rad()).start;
    const PathLight of_rig(text, as_it_is.water, as_it_is.tint, light.paths(samples.images));
    const FitModel model = objective.model_at(point.x);
    const std::size_t channels = objective.channels();
    std::vector<std::vector<double>> off(channels);
    const std::size_t apart = (point.pose.size() + kFewPoses - 1) / kFewPoses;
    for (std::size_t i = 0; i < point.pose.size(); i += apart) {
        const ImageView seen = objective.view(point, model, i);
        const BlockLight by_rig =
            light.at(as_it_is, of_rig, objective.sled_at(point, i), {}, samples.images[i].planes);
        for (std::size_t k = 0; k < static_cast<std::size_t>(seen.rows.rows()); ++k) {
            if (!std::isfinite(seen.rows(static_cast<Index>(k), 0))) continue;
            const auto row = static_cast<Index>(k / channels * kChannels + k % channels);
            const double difference = seen.light.logarithm(row) - by_rig.logarithm(row);
            off[k % channels].push_back(std::isfinite(difference) ? difference
                                                                  : -std::log(kDarkestBlock));
        }
    }
    double variance = 0.0;
    for (const std::vector<double>& of : off) {
        const auto all = VectorXd::Map(of.data(), std::ssize(of));
        if (all.size() > 0) variance += (all.array() - all.mean()).square().mean();
    }
    return std::sqrt(variance / static_cast<double>(channels));
}

// In the keys' units, of the numbers.
void add_numbers(const FitProblem& problem,
                 const FitObjective& objective,
                 const FitPoint& point,
                 const FitSamples& samples,
                 const MatrixXd& told,
                 const std::vector<double>& powers,
                 FitResult& result) {
    std::optional<Curvatures> curvatures;  // if a number is not determined
    VectorXd units(told.rows());
    VectorXd of_state(told.rows());
    for (Index k = 0; k < told.rows(); ++k) {
        const FitNumber& number = problem.numbers[static_cast<std::size_t>(k)];
        const double scale = number.at.part == FitPart::Power
                                 ? powers[number.at.of] / result.state.power[number.at.of]
                                 : 1.0;
        units(k) = scale * number.shown_slope(point.x(k));
        of_state(k) = number.slope(point.x(k));
        const double error = std::sqrt(told(k, k));
        const bool is_of_curve = number.at.part == FitPart::Beam && !number.is_log;
        FittedNumber one{.key = number.key,
                         .word = number.word,
                         .start = number.shown(0.0),
                         .value = scale * number.shown(point.x(k)),
                         .error = units(k) * error,
                         .spread = number.shown_slope(0.0) * number.spread,
                         .is_log = number.is_log,
                         .is_determined = is_of_curve || error < kDetermined * number.spread};
        if (!one.is_determined) {
            if (!curvatures) curvatures = curvatures_of(objective, point, samples);
            one.fly_at = fly_at(*curvatures, k, one.error);
        }
        result.numbers.push_back(std::move(one));
    }
    result.covariance = units.asDiagonal() * told * units.asDiagonal();
    result.confounded = confounded_in(problem, told);
    const MatrixXd covariance = of_state.asDiagonal() * told * of_state.asDiagonal();
    Index first = 0;
    for (const FitBeam& beam : result.state.beams) {
        const auto size = std::ssize(beam.coefficients());
        if (beam.is_round())
            result.beam_curves.push_back(
                curve_of(beam, covariance.block(first, first, size, size)));
        first += size;
    }
}

std::vector<std::string> words_fixed_in(const FitProblem& problem) {
    std::vector<std::string> fixed;
    for (const char* word : {"beam", "aim", "power", "water", "vignetting", "floor"})
        if (std::ranges::count(problem.numbers, word, &FitNumber::word) == 0)
            fixed.emplace_back(word);
    return fixed;
}

}  // namespace

void require_bare_floor(const Rig& rig) {
    if (!rig.objects.empty()) {
        throw InputError("found {}; allowed: none, since a survey shows the bare floor on average",
                         counted(rig.objects.size(), "object"));
    }
    if (!rig.scene.empty())
        throw InputError(
            "scene: found {}; allowed: none, since a survey shows the bare floor on average",
            rig.scene.string());
    if (rig.seafloor.phong > 0.0)
        throw InputError("seafloor.phong: found {}; allowed: 0, a matt floor", rig.seafloor.phong);
}

FitResult fit(const RigText& text,
              const FitSamples& samples,
              const FitOptions& options,
              const RunWatch& watch) {
    const Rig rig = text.rig();
    require_bare_floor(rig);
    const FitLight light(rig, samples.places);
    const double widest_rad = light.widest_rad(samples.images);
    const FitProblem problem = fit_problem(text, options, widest_rad, light.block_rad());
    const FitObjective objective(text, samples, options, light, problem);
    FitResult result;
    result.looks_wrong = samples.looks_wrong;
    result.marked = samples.marked;
    if (const auto mistake = mistaken_input(samples, objective, problem, light)) {
        watch.looks_wrong({*mistake});
        result.looks_wrong.push_back(*mistake);
    }
    const FitPoint start = start_of(objective, text, samples, options, light, widest_rad);
    FitPoint point = objective.search(start, kNear, [&](int round) {
        result.rounds = round;
        watch.progress("fitting", kFirstShare * round / kMostRounds);
    });
    point.dispersion = dispersion_at(objective, point);
    point = objective.search(point, kNearest, [&](int round) {
        ++result.rounds;
        watch.progress("fitting", kFirstShare + (1.0 - kFirstShare) * round / kMostRounds);
    });
    const FitModel model = objective.model_at(point.x);
    const std::vector<std::size_t> counted = add_images(objective, point, model, samples, result);
    const auto answer_of_half = [&](std::size_t split, std::size_t which) {
        const FitSamples some = half_of(samples, counted, split, which);
        const FitObjective half(text, some, options, light, problem);
        FitPoint from = start;
        from.pose.assign(some.images.size(), Eigen::Vector3d::Zero());
        from.dispersion = point.dispersion;
        const double done = static_cast<double>(2 * split + which);
        return half.search(std::move(from), kNear, [&](int round) {
            watch.progress("comparing halves",
                           (done + static_cast<double>(round) / kMostRounds) / (2.0 * kSplits));
        });
    };
    result.state = model.state;
    const std::vector<double> powers = powers_in(result.state, rig);
    const FitErrors errors = errors_of(objective, problem, point, powers, answer_of_half);
    result.are_maps = samples.are_maps;
    result.block_px = samples.places.block_px;
    result.fixed = words_fixed_in(problem);
    result.unevenness = errors.unevenness;
    result.moved = moved_from_rig(text, samples, light, objective, point);
    result.dispersion = point.dispersion;
    add_numbers(problem, objective, point, samples, errors.covariance, powers, result);
    for (const Suspicion& one : suspicions(samples, result)) result.looks_wrong.push_back(one);
    return result;
}

double rig_unevenness(const FitResult& result) {
    return std::sqrt(
        std::max(0.0, result.moved * result.moved - result.unevenness * result.unevenness));
}

bool is_rig_as_good(const FitResult& result) {
    return rig_unevenness(result) <= result.unevenness;
}

bool is_curve(const FittedNumber& number) {
    return number.key.find(".beam.ln_") != std::string::npos;
}

std::string with_error(const FittedNumber& number, std::string_view sign) {
    constexpr int kOfExact = 4;
    const int decimals =
        number.error > 0.0 ? std::max(0, 1 - static_cast<int>(std::floor(std::log10(number.error))))
                           : kOfExact;
    return fmt::format("{:.{}f} {} {:.{}f}", number.value, decimals, sign, number.error, decimals);
}

std::string words_of(const FitResult& result) {
    const auto splines = static_cast<std::size_t>(std::ranges::count_if(result.numbers, is_curve));
    std::string words = counted(result.numbers.size() - splines, "number");
    if (splines > 0) words += fmt::format(" and a beam of {} splines", splines);
    return words + fmt::format(" fitted to {}",
                               counted(result.images.size(), result.are_maps ? "map" : "image"));
}

std::string words_of(const FittedNumber& number) {
    std::string words =
        fmt::format("{} is not determined by this survey (+-{:.2g})", number.key, number.error);
    if (number.fly_at)
        words += fmt::format(": as many more images at {:.2g} m would reduce its error to {:.2g}",
                             number.fly_at->altitude_m,
                             number.fly_at->error);
    return words;
}

}  // namespace aphotic
