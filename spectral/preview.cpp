// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/preview.h"

#include "spectral/atomic_file.h"
#include "spectral/error.h"

#include <cairo.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>

namespace aphotic {
namespace {

using Channels = std::array<double, kChannels>;

std::span<const float> plane(const CameraImage& image, std::size_t channel) {
    const std::size_t size = image.samples.size() / kChannels;
    return std::span(image.samples).subspan(channel * size, size);
}

double mean(std::span<const float> samples) {
    double sum = 0.0;
    for (const float sample : samples) sum += sample;
    return sum / static_cast<double>(samples.size());
}

Channels white_of(const CameraImage& image, const Channels& lamp_signal, PreviewWhite white) {
    Channels result{1.0, 1.0, 1.0};
    if (white == PreviewWhite::Lamp) result = lamp_signal;
    if (white == PreviewWhite::Image) {
        for (std::size_t c = 0; c < kChannels; ++c) result[c] = mean(plane(image, c));
    }
    // A dead channel has no white of its own.
    for (double& value : result) value = value > 0.0 ? value : 1.0;
    return result;
}

// The quantile over all channels of what scale makes of the samples; a spread-out subset of a
// few hundred thousand samples tells it well enough.
double bright_value(const CameraImage& image, const Channels& scale) {
    constexpr std::size_t kSubset = 200'000;
    const std::size_t step = std::max<std::size_t>(1, image.samples.size() / kSubset) | 1U;
    std::vector<double> values;
    for (std::size_t c = 0; c < kChannels; ++c) {
        const auto samples = plane(image, c);
        for (std::size_t i = 0; i < samples.size(); i += step)
            values.push_back(scale[c] * samples[i]);
    }
    const auto rank =
        static_cast<std::ptrdiff_t>(kBrightShare * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
}

}  // namespace

double srgb_encoded(double linear) {
    const double x = std::clamp(linear, 0.0, 1.0);
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
}

void write_preview(const CameraImage& image,
                   const Channels& lamp_signal,
                   const PreviewOptions& options,
                   const std::filesystem::path& file) {
    Channels scale = white_of(image, lamp_signal, options.white);
    for (double& value : scale) value = 1.0 / value;
    const double bright = bright_value(image, scale);
    const double gain = bright > 0.0 ? std::exp2(options.stops) * kBrightLevel / bright : 0.0;
    for (double& value : scale) value *= gain;

    const auto destroy = [](cairo_surface_t* surface) { cairo_surface_destroy(surface); };
    const std::unique_ptr<cairo_surface_t, decltype(destroy)> surface(
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, image.width_px, image.height_px), destroy);
    if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS) {
        throw RunError(fmt::format("{}: no picture of {} x {} pixels can be made: {}",
                                   file.string(),
                                   image.width_px,
                                   image.height_px,
                                   cairo_status_to_string(cairo_surface_status(surface.get()))));
    }
    const auto width = static_cast<std::size_t>(image.width_px);
    unsigned char* data = cairo_image_surface_get_data(surface.get());
    const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface.get()));
    for (std::size_t row = 0; row < static_cast<std::size_t>(image.height_px); ++row) {
        auto* pixels = reinterpret_cast<std::uint32_t*>(data + row * stride);
        for (std::size_t column = 0; column < width; ++column) {
            std::uint32_t pixel = 0;
            for (std::size_t c = 0; c < kChannels; ++c) {
                const double value = srgb_encoded(scale[c] * plane(image, c)[row * width + column]);
                pixel = pixel << 8U | static_cast<std::uint32_t>(std::lround(255.0 * value));
            }
            pixels[column] = pixel;
        }
    }
    cairo_surface_mark_dirty(surface.get());

    AtomicFile destination(file);
    const cairo_status_t status =
        cairo_surface_write_to_png(surface.get(), destination.temporary().c_str());
    if (status != CAIRO_STATUS_SUCCESS) {
        throw RunError(fmt::format(
            "{}: cannot be written: {}", file.string(), cairo_status_to_string(status)));
    }
    destination.commit();
}

}  // namespace aphotic
