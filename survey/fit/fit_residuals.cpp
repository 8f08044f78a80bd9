// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_residuals.h"

#include "base/upper_median.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace aphotic {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// The residuals of all images at one place and channel.
using InPlace = std::vector<float>;

// How much of the residuals stays in place from image to image: rms of the medians, for shade is no
// pattern, less what chance makes of them.
double pattern_of(std::vector<InPlace>& places) {
    constexpr std::size_t kFew = 3;
    double pattern = 0.0;
    double counted = 0.0;
    for (InPlace& at : places) {
        if (at.size() < kFew) continue;
        const float median = upper_median(at);
        for (float& off : at) off = std::abs(off - median);
        const double deviation = kNormal * upper_median(at);
        const double chance =
            0.5 * std::numbers::pi * deviation * deviation / static_cast<double>(at.size() - 1);
        pattern += double{median} * median - chance;
        counted += 1.0;
    }
    return std::sqrt(std::max(0.0, pattern) / std::max(1.0, counted));
}

FitView view_of(std::size_t image, const FitSamples& samples, const FitEquations::Residual& found) {
    const std::size_t places = samples.places.size();
    FitView view{.image = image,
                 .observed = std::vector<float>(places * kChannels),
                 .fitted = std::vector<float>(places * kChannels),
                 .residual = std::vector<float>(places, 0.0F)};
    for (std::size_t i = 0; i < places; ++i) {
        for (std::size_t c = 0; c < kChannels; ++c) {
            const auto row = static_cast<Index>(kChannels * i + c);
            view.observed[c * places + i] = samples.images[image].signal[kChannels * i + c];
            view.fitted[c * places + i] = static_cast<float>(found.signal(row));
            view.residual[i] +=
                static_cast<float>(found.residual(row) / found.signal(row) / kChannels);
        }
    }
    return view;
}

// The images nearest to even steps of altitude.
std::vector<std::size_t> images_to_show(const FitSamples& samples) {
    std::vector<std::size_t> order(samples.images.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return samples.images[i].sled.altitude_m; });
    const std::size_t count = std::min(kFitViews, order.size());
    std::vector<std::size_t> shown;
    for (std::size_t k = 0; k < count; ++k)
        shown.push_back(order[count == 1 ? 0 : k * (order.size() - 1) / (count - 1)]);
    return shown;
}

}  // namespace

FitResiduals fit_residuals(const FitEquations& equations,
                           const FitSamples& samples,
                           const FitState& state,
                           const PathLight& light,
                           const VectorXd& shares) {
    FitResiduals result;
    constexpr double kDim = 0.05;  // of an image's brightest: darker blocks are noise
    std::vector<InPlace> places(samples.places.size() * kChannels);
    const std::vector<std::size_t> shown = images_to_show(samples);
    result.views.resize(shown.size());
    const auto are_side_by_side = [&](std::size_t place) {
        return samples.places.rows[place] == samples.places.rows[place + 1];
    };
    double squares = 0.0;
    double blocks = 0.0;
    double products = 0.0;
    double pairs = 0.0;
    for (std::size_t i = 0; i < samples.images.size(); ++i) {
        const FitEquations::Residual found = equations.residual_of(i, state, light, shares);
        const double most = found.signal.maxCoeff();
        double of_image = 0.0;
        double count = 0.0;
        for (Index row = 0; row < found.residual.size(); ++row) {
            if (!std::isfinite(found.residual(row)) || found.signal(row) < kDim * most) continue;
            const double off = found.residual(row) / found.signal(row);
            places[static_cast<std::size_t>(row)].push_back(static_cast<float>(off));
            of_image += off * off;
            count += 1.0;
            const Index next = row + kChannels;
            if (next >= found.residual.size() || !std::isfinite(found.residual(next)) ||
                found.signal(next) < kDim * most ||
                !are_side_by_side(static_cast<std::size_t>(row) / kChannels))
                continue;
            products += off * found.residual(next) / found.signal(next);
            pairs += 1.0;
        }
        squares += of_image;
        blocks += count;
        result.images.push_back({.sled = samples.images[i].sled,
                                 .residual = std::sqrt(of_image / std::max(1.0, count)),
                                 .level = found.effects[0]});
        const auto at = std::ranges::find(shown, i);
        if (at != shown.end())
            result.views[static_cast<std::size_t>(at - shown.begin())] = view_of(i, samples, found);
    }
    result.residual = std::sqrt(squares / std::max(1.0, blocks));
    result.pattern = pattern_of(places);
    result.smooth = std::sqrt(std::max(0.0, products) / std::max(1.0, pairs));
    return result;
}

}  // namespace aphotic
