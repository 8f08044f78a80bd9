// SPDX-License-Identifier: BSD-3-Clause
#include "survey/correct/average.h"

#include "base/error.h"
#include "base/parallel.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

namespace aphotic {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct Estimate {
    double value = kNaN;
    double standard_error = kNaN;
};

// Of the mean of `kept` samples whose squared deviations add up to `squares`.
double error_of_mean(double squares, std::size_t kept) {
    if (kept < 2) return kNaN;
    const auto n = static_cast<double>(kept);
    return std::sqrt(squares / (n * (n - 1.0)));
}

Observed unobserved(std::size_t samples) {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    return {.average = std::vector<float>(samples, kNone),
            .standard_error = std::vector<float>(samples, kNone),
            .count = std::vector<float>(samples, 0.0F)};
}

void put(Observed& observed, std::size_t at, const Estimate& estimate, std::size_t count) {
    observed.average[at] = static_cast<float>(estimate.value);
    observed.standard_error[at] = static_cast<float>(estimate.standard_error);
    observed.count[at] = static_cast<float>(count);
}

// The sample of that rank, from 0. Orders the samples about it.
double ranked(std::span<float> samples, std::size_t rank) {
    const auto place = samples.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(samples.begin(), place, samples.end());
    return *place;
}

Estimate median_of(std::span<float> samples) {
    constexpr double kZ = 2.5758;
    const std::size_t n = samples.size();
    const double upper = ranked(samples, n / 2);
    const double lower =
        n % 2 == 1 ? upper : *std::max_element(samples.begin(), samples.begin() + n / 2);
    Estimate estimate{.value = (lower + upper) / 2.0};
    if (n < 2) return estimate;
    const auto count = static_cast<double>(n);
    const double k = std::max(1.0, std::round((count + 1.0) / 2.0 - kZ * std::sqrt(count / 4.0)));
    const auto low = static_cast<std::size_t>(k) - 1;
    estimate.standard_error = (ranked(samples, n - 1 - low) - ranked(samples, low)) / (2.0 * kZ);
    return estimate;
}

double sum_of_squares(std::span<const float> samples, double about) {
    return std::transform_reduce(
        samples.begin(), samples.end(), 0.0, std::plus<>(), [&](double sample) {
            return (sample - about) * (sample - about);
        });
}

Estimate trimmed_mean_of(std::span<float> samples, double trim) {
    const std::size_t n = samples.size();
    constexpr double kRounding = 1e-9;  // 0.29 of 100 samples are 29
    const auto cut = static_cast<std::size_t>(trim * static_cast<double>(n) + kRounding);
    const double least = ranked(samples, cut);
    // Only beyond the least ones, so that those keep their places.
    const double most = ranked(samples.subspan(cut), n - 1 - 2 * cut);
    const std::span<const float> kept = samples.subspan(cut, n - 2 * cut);
    const double sum = std::accumulate(kept.begin(), kept.end(), 0.0);
    const auto cut_off = static_cast<double>(cut);
    const double winsorised = (sum + cut_off * (least + most)) / static_cast<double>(n);
    const double squares =
        sum_of_squares(kept, winsorised) +
        cut_off * (std::pow(least - winsorised, 2.0) + std::pow(most - winsorised, 2.0));
    return {.value = sum / static_cast<double>(kept.size()),
            .standard_error = error_of_mean(squares, kept.size())};
}

Estimate estimate_of(std::span<float> samples, Average average, double trim) {
    if (samples.empty()) return {};
    if (average == Average::Median) return median_of(samples);
    return trimmed_mean_of(samples, average == Average::Trimmed ? trim : 0.0);
}

std::vector<float> in_all_channels(const std::vector<float>& plane) {
    std::vector<float> planes;
    planes.reserve(plane.size() * kChannels);
    for (int c = 0; c < kChannels; ++c) planes.insert(planes.end(), plane.begin(), plane.end());
    return planes;
}

// A few places at a time, so that each image is read by whole cache lines.
constexpr std::size_t kPlaces = 64;

// For `many` places from the first on, up to kPlaces.
void average_places(std::span<const std::vector<float>> images,
                    std::size_t first,
                    std::size_t many,
                    Average average,
                    double trim,
                    Observed& observed) {
    std::vector<float> samples(many * images.size());
    std::array<std::size_t, kPlaces> counts{};
    for (const std::vector<float>& image : images) {
        for (std::size_t i = 0; i < many; ++i) {
            if (std::isnan(image[first + i])) continue;
            samples[i * images.size() + counts[i]++] = image[first + i];
        }
    }
    for (std::size_t i = 0; i < many; ++i) {
        const auto of_place = std::span(samples).subspan(i * images.size(), counts[i]);
        put(observed, first + i, estimate_of(of_place, average, trim), counts[i]);
    }
}

}  // namespace

RunningMean::RunningMean(std::size_t samples)
    : mean_(samples, 0.0), squares_(samples, 0.0), count_(samples, 0) {}

void RunningMean::add(std::span<const float> image) {
    assert(image.size() == mean_.size());
    for (std::size_t i = 0; i < image.size(); ++i) {
        if (std::isnan(image[i])) continue;
        const double off = image[i] - mean_[i];
        mean_[i] += off / ++count_[i];
        squares_[i] += off * (image[i] - mean_[i]);
    }
}

Observed RunningMean::observed() const {
    Observed observed = unobserved(mean_.size());
    for (std::size_t i = 0; i < mean_.size(); ++i) {
        if (count_[i] == 0) continue;
        put(observed, i, {mean_[i], error_of_mean(squares_[i], count_[i])}, count_[i]);
    }
    return observed;
}

Observed average_of(std::span<const std::vector<float>> images,
                    Average average,
                    double trim,
                    int threads) {
    assert(trim >= 0.0 && trim < 0.5 && threads > 0);
    const std::size_t samples = images.empty() ? 0 : images.front().size();
    Observed observed = unobserved(samples);
    const std::size_t parts = (samples + kPlaces - 1) / kPlaces;
    parallel_for(parts, static_cast<std::size_t>(threads), [&](std::size_t part, std::size_t) {
        const std::size_t first = part * kPlaces;
        average_places(images, first, std::min(kPlaces, samples - first), average, trim, observed);
    });
    return observed;
}

std::vector<float> by_channel(const std::vector<float>& samples,
                              const RawImage& like,
                              float elsewhere) {
    if (like.mosaic == Mosaic::None) return samples;
    const std::size_t pixels = like.pixels();
    if (like.mosaic == Mosaic::Mono) return in_all_channels(samples);
    std::vector<float> planes(pixels * kChannels, elsewhere);
    for (std::size_t i = 0; i < pixels; ++i) {
        const auto width = static_cast<std::size_t>(like.width_px);
        const int channel =
            channel_at(like.mosaic, static_cast<int>(i % width), static_cast<int>(i / width));
        planes[static_cast<std::size_t>(channel) * pixels + i] = samples[i];
    }
    return planes;
}

void divide_by_own_mean(RawImage& image) {
    double sum = 0.0;
    double count = 0.0;
    for (const float sample : image.samples) {
        if (std::isnan(sample)) continue;
        sum += sample;
        count += 1.0;
    }
    const double mean = sum / count;
    if (!(mean > 0.0)) throw InputError("its mean is {:.3g}; allowed: above 0, to divide by", mean);
    for (float& sample : image.samples) sample = static_cast<float>(sample / mean);
}

std::size_t samples_in_memory(std::size_t images, double memory_mb) {
    constexpr double kMegabyte = 1e6;
    constexpr double kMost = 1e12;  // more than any image has
    const double bytes = static_cast<double>(std::max<std::size_t>(1, images)) * sizeof(float);
    return static_cast<std::size_t>(std::clamp(memory_mb * kMegabyte / bytes, 1.0, kMost));
}

}  // namespace aphotic
