// SPDX-License-Identifier: BSD-3-Clause
#include "validation/patch_score.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "image/any_image.h"
#include "image/camera_image.h"

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace aphotic {
namespace {

using Rgb = std::array<double, 3>;

// Sums over the pixels of patches of one kind.
struct Sums {
    Rgb signal{};
    Rgb squares{};
    double pixels = 0.0;

    void add(const Sums& other) {
        for (std::size_t c = 0; c < kChannels; ++c) {
            signal[c] += other.signal[c];
            squares[c] += other.squares[c];
        }
        pixels += other.pixels;
    }
    // The sum of squares of I / m - 1 over all channels; empty if m is 0.
    [[nodiscard]] double deviations() const {
        double sum = 0.0;
        for (std::size_t c = 0; c < kChannels; ++c) {
            const double mean = signal[c] / pixels;
            if (mean > 0.0) sum += std::max(0.0, squares[c] / (mean * mean) - pixels);
        }
        return sum;
    }
};

std::vector<std::vector<float>> planes_of(const AnyImage& image, const PatchRequest& request) {
    std::vector<std::vector<float>> planes;
    for (const std::string_view channel : kChannelNames) {
        const auto found = std::ranges::find(image.channels, channel);
        if (found == image.channels.end()) {
            throw InputError("{}: found the channels {}; needed for --patches: R, G, B",
                             request.image,
                             fmt::join(image.channels, ", "));
        }
        planes.push_back(image.samples(static_cast<std::size_t>(found - image.channels.begin())));
        if (!request.is_srgb) continue;
        for (float& sample : planes.back()) sample = static_cast<float>(srgb_decoded(sample));
    }
    return planes;
}

Sums sums_of(const Patch& patch,
             const AnyImage& image,
             const std::vector<std::vector<float>>& planes,
             const PatchRequest& request) {
    if (patch.x_px + patch.width_px > image.width_px ||
        patch.y_px + patch.height_px > image.height_px) {
        fail_at_line(request.patches,
                     patch.line,
                     "found a patch up to {}, {}; allowed: the image's {} x {} pixels",
                     patch.x_px + patch.width_px,
                     patch.y_px + patch.height_px,
                     image.width_px,
                     image.height_px);
    }
    Sums sums{.pixels = static_cast<double>(patch.width_px) * patch.height_px};
    for (std::size_t c = 0; c < kChannels; ++c) {
        for (int row = patch.y_px; row < patch.y_px + patch.height_px; ++row) {
            for (int column = patch.x_px; column < patch.x_px + patch.width_px; ++column) {
                const double sample = planes[c][static_cast<std::size_t>(row) *
                                                    static_cast<std::size_t>(image.width_px) +
                                                static_cast<std::size_t>(column)];
                sums.signal[c] += sample;
                sums.squares[c] += sample * sample;
            }
        }
        // For a colour outside sRGB a channel is clipped to 0; for grey, none is.
        const bool is_allowed = patch.is_grey ? sums.signal[c] > 0.0 : sums.signal[c] >= 0.0;
        if (!(std::isfinite(sums.signal[c]) && is_allowed)) {
            throw InputError("{}: the patch '{}' has a mean {} of {:.3g}; allowed: {}",
                             request.image,
                             patch.name,
                             kChannelNames[c],
                             sums.signal[c] / sums.pixels,
                             patch.is_grey ? "above 0, of a grey patch" : "0 or more");
        }
    }
    return sums;
}

Rgb mean_of(const Sums& sums) {
    Rgb mean = sums.signal;
    for (double& value : mean) value /= sums.pixels;
    return mean;
}

Rgb scale_of(const std::vector<Patch>& patches,
             const std::vector<Sums>& sums,
             const PatchRequest& request) {
    if (request.scale == ComparedScale::None) return {1.0, 1.0, 1.0};
    const bool is_each = request.scale == ComparedScale::OfEachChannel;
    Rgb above{};
    double below = 0.0;
    for (std::size_t i = 0; i < patches.size(); ++i) {
        if (!patches[i].lab || (is_each && !patches[i].is_grey)) continue;
        const double luminance = luminance_of(patches[i].lab->L);
        const Rgb mean = mean_of(sums[i]);
        const double all = 0.2126 * mean[0] + 0.7152 * mean[1] + 0.0722 * mean[2];
        for (std::size_t c = 0; c < kChannels; ++c)
            above[c] += luminance * (is_each ? mean[c] : all);
        below += luminance * luminance;
    }
    if (below == 0.0) {
        throw InputError("{}: found no patch {}; needed for --scale{}",
                         request.patches,
                         is_each ? "that is grey of a known reflectance" : "of a known colour",
                         is_each ? "=per-channel" : "");
    }
    for (double& value : above) value /= below;
    return above;
}

std::optional<double> mean_of(const std::vector<double>& values) {
    if (values.empty()) return std::nullopt;
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::optional<double> median_of(std::vector<double> values) {
    if (values.empty()) return std::nullopt;
    std::ranges::sort(values);
    const std::size_t n = values.size();
    return (values[(n - 1) / 2] + values[n / 2]) / 2.0;
}

double unevenness_of(const std::vector<Patch>& patches, const std::vector<Sums>& sums) {
    std::map<std::string, Sums> kinds;
    for (std::size_t i = 0; i < patches.size(); ++i) {
        const std::string& reference = patches[i].reference;
        const bool is_alone = reference.empty() || (!patches[i].lab);
        kinds[is_alone ? fmt::format("alone {}", i) : reference].add(sums[i]);
    }
    double deviations = 0.0;
    double samples = 0.0;
    for (const auto& [name, kind] : kinds) {
        deviations += kind.deviations();
        samples += kChannels * kind.pixels;
    }
    return std::sqrt(deviations / samples);
}

}  // namespace

PatchScores score_patches(const PatchRequest& request) {
    const std::vector<Patch> patches =
        parse_patches(request.patches, read_text_file(request.patches));
    const AnyImage image = open_any_image(request.image);
    const std::vector<std::vector<float>> planes = planes_of(image, request);
    std::vector<Sums> sums;
    for (const Patch& patch : patches) sums.push_back(sums_of(patch, image, planes, request));

    PatchScores scores{.scale = scale_of(patches, sums, request),
                       .unevenness = unevenness_of(patches, sums)};
    std::vector<double> degrees;
    std::vector<double> differences;
    for (std::size_t i = 0; i < patches.size(); ++i) {
        PatchScore score{.name = patches[i].name, .signal = mean_of(sums[i])};
        for (std::size_t c = 0; c < kChannels; ++c) score.signal[c] /= scores.scale[c];
        if (patches[i].is_grey) {
            score.degrees = degrees_from_grey(score.signal);
            degrees.push_back(*score.degrees);
        }
        if (patches[i].lab) {
            score.difference = ciede2000(*patches[i].lab, lab_of_srgb(score.signal));
            differences.push_back(*score.difference);
        }
        scores.patches.push_back(std::move(score));
    }
    scores.mean_degrees = mean_of(degrees);
    scores.median_degrees = median_of(degrees);
    scores.mean_difference = mean_of(differences);
    scores.median_difference = median_of(differences);
    return scores;
}

nlohmann::ordered_json to_json(const PatchScores& scores) {
    const auto put =
        [](nlohmann::ordered_json& json, const char* key, std::optional<double> value) {
            if (value) json[key] = *value;
        };
    nlohmann::ordered_json json{{"unevenness", scores.unevenness}, {"scale", scores.scale}};
    put(json, "mean_degrees_from_grey", scores.mean_degrees);
    put(json, "median_degrees_from_grey", scores.median_degrees);
    put(json, "mean_ciede2000", scores.mean_difference);
    put(json, "median_ciede2000", scores.median_difference);
    for (const PatchScore& patch : scores.patches) {
        nlohmann::ordered_json one{{"patch", patch.name}, {"signal", patch.signal}};
        put(one, "degrees_from_grey", patch.degrees);
        put(one, "ciede2000", patch.difference);
        json["patches"].push_back(one);
    }
    return json;
}

}  // namespace aphotic
