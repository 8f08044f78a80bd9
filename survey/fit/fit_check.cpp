// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_check.h"

#include <fmt/format.h>

#include <cmath>

namespace aphotic {
namespace {

// An image's blocks and their light from a rig, as survey_check.h examines whole images.
ImageLook look_at(const FitImage& image, const Eigen::VectorXd& logarithm) {
    PerChannel observed{};
    ImageLook look;
    look.altitude_m = image.sled.altitude_m;
    for (std::size_t at = 0; at < image.signal.size(); ++at) {
        const double lit = std::exp(logarithm(static_cast<Eigen::Index>(at)));
        if (!std::isfinite(image.signal[at]) || !std::isfinite(lit)) continue;
        observed.at(at % kChannels) += static_cast<double>(image.signal[at]);
        look.map_mean.at(at % kChannels) += lit;
    }
    for (std::size_t c = 0; c < kChannels; ++c) look.quotient[c] = observed[c] / look.map_mean[c];
    return look;
}

}  // namespace

std::optional<Suspicion> mistaken_input(const FitSamples& samples,
                                        const FitObjective& objective,
                                        const FitProblem& problem,
                                        const FitLight& light) {
    const FitModel rig = objective.model_at(Eigen::VectorXd::Zero(std::ssize(problem.numbers)));
    std::vector<ImageLook> looks;
    for (const FitImage& image : samples.images) {
        looks.push_back(
            look_at(image, light.at(rig.state, rig.light, image.sled, {}, image.planes).logarithm));
    }
    if (auto turned = turned_brightness(looks)) return turned;
    return red_for_blue(looks, samples.mosaic);
}

std::vector<Suspicion> suspicions(const FitSamples& samples, const FitResult& result) {
    std::vector<Suspicion> found;
    double saturated = 0.0;
    for (const FitImage& image : samples.images)
        saturated += image.saturated_share / static_cast<double>(samples.images.size());
    if (saturated > kMostSaturation)
        found.push_back({"saturation", fmt::format("{:.2g} of all samples, left out", saturated)});
    const FixedPattern& pattern = result.pattern;
    if (pattern.is_too_large()) {
        found.push_back({std::string(kAboutPattern),
                         fmt::format("residuals keep a fixed pattern over all images, {:.2g} rms "
                                     "where chance gives {:.2g}: a beam, lens or water that the "
                                     "fit does not allow, or a wrong black level",
                                     pattern.rms,
                                     pattern.by_chance)});
    }
    for (const FittedNumber& one : result.numbers) {
        const double off = one.is_log ? one.start * std::abs(std::log(one.value / one.start))
                                      : std::abs(one.value - one.start);
        if (is_curve(one) || off <= kFarthest * one.spread) continue;
        found.push_back(
            {"range",
             fmt::format("{} went from {:.3g} to {:.3g}, where {:.2g} was expected: a beam, lens "
                         "or water that the fit does not allow, or wrong poses",
                         one.key,
                         one.start,
                         one.value,
                         one.spread)});
    }
    return found;
}

}  // namespace aphotic
