// SPDX-License-Identifier: BSD-3-Clause
#include "survey/correct/altitude_exponential.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/words.h"
#include "lightmap/altitude_fit.h"
#include "survey/correct/slow_light.h"

#include <algorithm>
#include <cmath>

namespace aphotic {

AltitudeExponential::AltitudeExponential(std::size_t samples, double bin_m)
    : samples_(samples), bin_m_(bin_m) {}

void AltitudeExponential::learn_level(std::span<const float> plane, double altitude_m) {
    Bin& bin = bins_[std::lround(altitude_m / bin_m_)];
    bin.mean.resize(samples_);
    const auto n = static_cast<double>(++bin.images);
    bin.altitude_m += (altitude_m - bin.altitude_m) / n;
    for (std::size_t i = 0; i < samples_; ++i) {
        const double mean = bin.mean[i];
        bin.mean[i] = static_cast<float>(mean + (plane[i] - mean) / n);
    }
}

void AltitudeExponential::fit(std::size_t threads) {
    constexpr std::size_t kLeast = 4;  // one more than there are parameters
    if (bins_.size() < kLeast) {
        throw InputError(
            "altitude-exponential: found images in {} of altitude, {} m wide; allowed: {} or more",
            counted(bins_.size(), "bin"),
            bin_m_,
            kLeast);
    }
    std::vector<double> altitude_m;
    std::vector<const float*> means;
    double images = 0.0;
    mean_altitude_m_ = 0.0;
    for (const auto& [number, bin] : bins_) {
        altitude_m.push_back(bin.altitude_m);
        means.push_back(bin.mean.data());
        const auto of_bin = static_cast<double>(bin.images);
        mean_altitude_m_ += of_bin * bin.altitude_m;
        images += of_bin;
    }
    mean_altitude_m_ /= images;
    const AltitudeFitter fitter(altitude_m);
    fits_.resize(samples_);
    constexpr std::size_t kAtOnce = 4096;
    parallel_for((samples_ + kAtOnce - 1) / kAtOnce, threads, [&](std::size_t part, std::size_t) {
        std::vector<double> signal(means.size());
        for (std::size_t i = part * kAtOnce; i < std::min((part + 1) * kAtOnce, samples_); ++i) {
            std::ranges::transform(
                means, signal.begin(), [i](const float* mean) { return mean[i]; });
            const AltitudeFit fit = fitter.fit(signal);
            fits_[i] = {.a = static_cast<float>(fit.a),
                        .b_per_m = static_cast<float>(fit.b_per_m),
                        .c = static_cast<float>(fit.c)};
        }
    });
    bins_.clear();
    spread_ = RunningMean(samples_);
}

std::vector<float> AltitudeExponential::level(std::span<const float> plane,
                                              double altitude_m) const {
    constexpr float kMostGain = 1.0 / kLeastShare;
    const auto h = static_cast<float>(altitude_m);
    const auto h0 = static_cast<float>(mean_altitude_m_);
    std::vector<float> levelled(plane.size());
    for (std::size_t i = 0; i < plane.size(); ++i) {
        const auto& [a, b, c] = fits_[i];
        const float here = a * std::exp(b * h) + c;
        const float wanted = a * std::exp(b * h0) + c;
        // Without light there is nothing to correct.
        levelled[i] = here > 0.0F ? plane[i] * std::min(wanted / here, kMostGain) : plane[i];
    }
    return levelled;
}

void AltitudeExponential::learn_spread(std::span<const float> plane, double altitude_m) {
    spread_.add(level(plane, altitude_m));
}

void AltitudeExponential::end() {
    const Observed observed = spread_.observed();
    spread_ = RunningMean(0);
    mean_ = observed.average;
    common_mean_ = mean_of(mean_);
    // The errors of the means serve as s, since all pixels have equally many samples. With a single
    // sample they are NaN.
    std::vector<float> deviation = observed.standard_error;
    for (float& value : deviation) value = value > 0.0F ? value : 0.0F;
    const double common = mean_of(deviation);
    const double least = kLeastShare * common;
    scale_.assign(samples_, 1.0F);
    if (!(common > 0.0)) return;
    for (std::size_t i = 0; i < samples_; ++i) {
        scale_[i] = static_cast<float>(common / std::max<double>(deviation[i], least));
    }
}

std::vector<float> AltitudeExponential::corrected(std::span<const float> plane,
                                                  double altitude_m) const {
    std::vector<float> result = level(plane, altitude_m);
    for (std::size_t i = 0; i < result.size(); ++i) {
        result[i] = static_cast<float>((result[i] - mean_[i]) * scale_[i] + common_mean_);
    }
    return result;
}

}  // namespace aphotic
