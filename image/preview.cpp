// SPDX-License-Identifier: BSD-3-Clause
#include "image/preview.h"

#include "base/atomic_file.h"
#include "base/error.h"

#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string_view>

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
    // A channel without signal has no white.
    for (double& value : result) value = value > 0.0 ? value : 1.0;
    return result;
}

// The quantile, over all channels, of the scaled samples; a subset of a few hundred thousand
// samples, evenly spread, is enough.
double bright_value(const CameraImage& image, const Channels& scale) {
    constexpr std::size_t kSubset = 200'000;
    const std::size_t step = std::max<std::size_t>(1, image.samples.size() / kSubset) | 1U;
    std::vector<double> values;
    for (std::size_t c = 0; c < kChannels; ++c) {
        const auto samples = plane(image, c);
        for (std::size_t i = 0; i < samples.size(); i += step) {
            if (std::isfinite(samples[i])) values.push_back(scale[c] * samples[i]);
        }
    }
    if (values.empty()) return 0.0;
    const auto rank =
        static_cast<std::ptrdiff_t>(kBrightShare * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    const double bright = values[static_cast<std::size_t>(rank)];
    // For a small light in the dark, the brightest sample is used.
    return bright > 0.0 ? bright : *std::ranges::max_element(values);
}

void require(cairo_status_t status, int width_px, int height_px) {
    if (status == CAIRO_STATUS_SUCCESS) return;
    throw RunError("cannot make a picture of {} x {} pixels: {}",
                   width_px,
                   height_px,
                   cairo_status_to_string(status));
}

// A chunk after the header, with its checksum: sRGB, perceptual intent. Cairo writes none.
std::string marked_as_srgb(std::string png) {
    constexpr std::size_t kHeaderEnd = 33;
    constexpr std::string_view kChunk("\0\0\0\1sRGB\0\xAE\xCE\x1C\xE9", 13);
    return png.insert(kHeaderEnd, kChunk);
}

}  // namespace

double srgb_encoded(double linear) {
    const double x = std::clamp(linear, 0.0, 1.0);
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
}

Channels preview_scale(const CameraImage& image,
                       const Channels& lamp_signal,
                       const PreviewOptions& options) {
    Channels scale = white_of(image, lamp_signal, options.white);
    for (double& value : scale) value = 1.0 / value;
    const double bright = bright_value(image, scale);
    const double gain = bright > 0.0 ? std::exp2(options.stops) * kBrightLevel / bright : 0.0;
    for (double& value : scale) value *= gain;
    return scale;
}

std::string preview_png(const CameraImage& image, const Channels& scale) {
    std::vector<std::uint32_t> pixels(image.samples.size() / kChannels);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        for (std::size_t c = 0; c < kChannels; ++c) {
            const double shown = scale[c] * plane(image, c)[i];
            const double value = std::isnan(shown) ? 0.0 : srgb_encoded(shown);
            pixels[i] = pixels[i] << 8U | static_cast<std::uint32_t>(std::lround(255.0 * value));
        }
    }
    return png_of(pixels, image.width_px, image.height_px);
}

std::string png_of(std::span<const std::uint32_t> pixels, int width_px, int height_px) {
    const auto destroy = [](cairo_surface_t* surface) { cairo_surface_destroy(surface); };
    const std::unique_ptr<cairo_surface_t, decltype(destroy)> surface(
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, width_px, height_px), destroy);
    require(cairo_surface_status(surface.get()), width_px, height_px);
    const auto width = static_cast<std::size_t>(width_px);
    unsigned char* data = cairo_image_surface_get_data(surface.get());
    const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface.get()));
    for (std::size_t row = 0; row < static_cast<std::size_t>(height_px); ++row) {
        std::ranges::copy(pixels.subspan(row * width, width),
                          reinterpret_cast<std::uint32_t*>(data + row * stride));
    }
    cairo_surface_mark_dirty(surface.get());

    std::string png;
    const auto append = [](void* to, const unsigned char* bytes, unsigned int count) {
        static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(bytes), count);
        return CAIRO_STATUS_SUCCESS;
    };
    require(cairo_surface_write_to_png_stream(surface.get(), append, &png), width_px, height_px);
    return marked_as_srgb(std::move(png));
}

void write_preview(const CameraImage& image,
                   const Channels& lamp_signal,
                   const PreviewOptions& options,
                   const std::filesystem::path& file) {
    std::string png;
    try {
        png = preview_png(image, preview_scale(image, lamp_signal, options));
    } catch (const RunError& error) {
        throw RunError("{}: {}", file.string(), error.what());
    }
    write_text_file(file, png);
}

}  // namespace aphotic
