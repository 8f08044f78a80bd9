// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace aphotic {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// Of what is left of the images' brightness.
struct Trend {
    double correlation = 0.0;
    double rms = 0.0;  // of the part that goes with the altitude
};

Trend trend_with_altitude(const std::vector<ImageOutcome>& images) {
    const auto count = static_cast<Index>(images.size());
    VectorXd altitude(count);
    VectorXd level(count);
    for (Index i = 0; i < count; ++i) {
        const ImageOutcome& image = images[static_cast<std::size_t>(i)];
        altitude(i) = image.sled.altitude_m;
        level(i) = image.level;
    }
    altitude.array() -= altitude.mean();
    level.array() -= level.mean();
    const double size = altitude.norm() * level.norm();
    if (!(size > 0.0)) return {};
    const double correlation = altitude.dot(level) / size;
    return {.correlation = correlation,
            .rms = std::abs(correlation) * level.norm() / std::sqrt(static_cast<double>(count))};
}

void look_for_misfit(const FitResiduals& left, std::vector<Suspicion>& found) {
    if (left.pattern > kMostPattern) {
        found.push_back(
            {"pattern",
             fmt::format("residuals stay in place from image to image, {:.2g} rms: another beam, "
                         "lens or water than the fit allows, or a wrong black level",
                         left.pattern)});
    }
    const auto count = static_cast<double>(left.images.size());
    const Trend trend = trend_with_altitude(left.images);
    if (left.images.size() >= kFewestImages && trend.rms > kMostTrend &&
        std::abs(trend.correlation) > kTrendSigmas / std::sqrt(count)) {
        found.push_back(
            {"altitude",
             fmt::format("what is left of the images' brightness goes with it, {:.2g} rms",
                         trend.rms)});
    }
    double squares = 0.0;
    for (const ImageOutcome& image : left.images) squares += image.level * image.level;
    const double level = std::sqrt(squares / count);
    if (level > kMostLevel) {
        found.push_back(
            {"exposure",
             fmt::format("images are brighter or darker than their poses explain, {:.2g} rms: "
                         "poses of other images, or other exposures",
                         level)});
    }
}

void look_for_far_numbers(const FitResult& result, std::vector<Suspicion>& found) {
    for (const FittedNumber& one : result.numbers) {
        const double off = std::abs(one.value - one.start);
        const bool has_none = one.start == 0.0 && one.value == 0.0;  // and the rig told of none
        if ((!one.is_at_bound || has_none) && off <= kFarthest * one.plausible) continue;
        std::string held;
        for (const NotTold& none : result.held) held += fmt::format(", another {}", none.key);
        found.push_back(
            {"range",
             fmt::format("{} went from {:.3g} to {:.3g}, where {:.2g} is plausible: another beam, "
                         "lens or water than the fit allows{}, or other poses",
                         one.key,
                         one.start,
                         one.value,
                         one.plausible,
                         held)});
    }
}

void look_for_wide_errors(const FitResult& result, std::vector<Suspicion>& found) {
    std::vector<std::string> words;
    for (const FittedNumber& one : result.numbers)
        if (one.error > kMostError * one.plausible)
            words.push_back(fmt::format("{} +-{:.2g}", one.key, one.error));
    if (words.empty()) return;
    found.push_back({"errors",
                     fmt::format("{}: over half of what is plausible, by halves of the images "
                                 "or by what is held: fly more images at more altitudes, or leave "
                                 "these out of --free",
                                 fmt::join(words, ", "))});
}

void look_for_one_altitude(const FitSamples& samples,
                           const FitResult& result,
                           std::vector<Suspicion>& found) {
    const auto is_of = [](FitPart part) {
        return [part](const FittedNumber& one) { return one.number.part == part; };
    };
    const bool is_water_free = std::ranges::any_of(result.numbers, is_of(FitPart::Water));
    const bool is_lens_free = std::ranges::any_of(result.numbers, is_of(FitPart::LensFactor));
    const bool is_beam_free = std::ranges::any_of(
        result.state.beams, [](const FitBeam& beam) { return beam.kind() != FitBeamKind::Held; });
    if (!is_beam_free || (!is_water_free && !is_lens_free)) return;
    const auto by_altitude = [](const FitImage& image) { return image.sled.altitude_m; };
    const auto [low, high] = std::ranges::minmax(samples.images, {}, by_altitude);
    const double lowest_m = low.sled.altitude_m;
    const double highest_m = high.sled.altitude_m;
    if (highest_m >= kOneAltitude * lowest_m) return;
    found.push_back(
        {"altitudes",
         fmt::format("{:.3g} to {:.3g} m alone: beam, water and lens nearly make up for each "
                     "other, and what a model lacks may exceed the errors: fly {:.2g} m, too",
                     lowest_m,
                     highest_m,
                     2.0 * lowest_m)});
}

void look_for_texture(const FitSamples& samples,
                      const FitResiduals& left,
                      std::vector<Suspicion>& found) {
    const double most = std::clamp(kMostShared * left.residual, kLeastTexture, kMostTexture);
    if (!samples.are_maps || left.smooth <= most) return;
    found.push_back(
        {"maps",
         fmt::format("neighbouring blocks are off alike, by {:.2g} rms: texture that has not "
                     "averaged out, or light that the fit does not allow, and errors are too "
                     "small: fit to images, to maps of more of them, or with more --parts",
                     left.smooth)});
}

void look_for_saturation(const FitSamples& samples, std::vector<Suspicion>& found) {
    double saturated = 0.0;
    for (const FitImage& image : samples.images)
        saturated += image.saturated_share / static_cast<double>(samples.images.size());
    if (saturated <= kMostSaturation) return;
    found.push_back({"saturation", fmt::format("{:.2g} of all samples, left out", saturated)});
}

// An image's blocks and what a rig makes of them, as survey_check.h looks at whole images.
ImageLook look_at(const FitImage& image, const VectorXd& signal) {
    PerChannel observed{};
    ImageLook look;
    look.altitude_m = image.sled.altitude_m;
    for (Index row = 0; row < signal.size(); ++row) {
        const auto at = static_cast<std::size_t>(row);
        if (!std::isfinite(image.signal[at])) continue;
        observed.at(at % kChannels) += static_cast<double>(image.signal[at]);
        look.map_mean.at(at % kChannels) += signal(row);
    }
    for (std::size_t c = 0; c < kChannels; ++c) look.quotient[c] = observed[c] / look.map_mean[c];
    return look;
}

}  // namespace

std::optional<Suspicion> mistaken_input(const FitSamples& samples,
                                        const FitLight& fit_light,
                                        const FitState& state,
                                        const PathLight& light,
                                        const VectorXd& shares) {
    std::vector<ImageLook> looks;
    FitLight::Rows parts;
    for (const FitImage& image : samples.images) {
        fit_light.parts_into(state, light, image.sled, parts);
        looks.push_back(look_at(image, parts * shares));
    }
    if (auto turned = turned_brightness(looks)) return turned;
    return red_for_blue(looks, samples.mosaic);
}

std::vector<Suspicion> suspicions(const FitSamples& samples, const FitResult& result) {
    std::vector<Suspicion> found;
    look_for_saturation(samples, found);
    look_for_misfit(result.left, found);
    look_for_far_numbers(result, found);
    look_for_wide_errors(result, found);
    look_for_one_altitude(samples, result, found);
    look_for_texture(samples, result.left, found);
    return found;
}

}  // namespace aphotic
