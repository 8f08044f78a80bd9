// SPDX-License-Identifier: BSD-3-Clause
#include "cli/raw_image_file.h"

#include "cli/any_image.h"
#include "spectral/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

namespace aphotic::cli {
namespace {

// Where R, G and B stand among the planes: by their names, or the only three.
std::vector<std::size_t> colours_of(const AnyImage& image) {
    std::vector<std::size_t> places;
    for (const std::string_view name : kChannelNames) {
        const auto found = std::ranges::find(image.channels, name);
        if (found == image.channels.end()) return {};
        places.push_back(static_cast<std::size_t>(found - image.channels.begin()));
    }
    return places;
}

[[noreturn]] void refuse_channels(const AnyImage& image, std::string_view allowed) {
    throw InputError(fmt::format(
        "found the channels {}; allowed: {}", fmt::join(image.channels, ", "), allowed));
}

RawImage raw_of(const AnyImage& image, const RawFileOptions& options) {
    const Mosaic mosaic = mosaic_named(options.mosaic).value_or(Mosaic::None);
    std::vector<std::size_t> places = colours_of(image);
    if (mosaic != Mosaic::None) places = {0};
    if (mosaic != Mosaic::None && image.channels.size() != 1)
        refuse_channels(image, "one, of a mosaic");
    if (places.empty()) refuse_channels(image, "R, G and B, or one with --bayer");
    if (mosaic != Mosaic::None && std::min(image.width_px, image.height_px) < 2) {
        throw InputError(
            fmt::format("found {} x {} pixels; allowed: 2 or more each way, of a mosaic",
                        image.width_px,
                        image.height_px));
    }
    const std::vector<float> planes = image.planes();
    const std::size_t pixels = planes.size() / image.channels.size();
    RawImage raw{
        .width_px = image.width_px, .height_px = image.height_px, .mosaic = mosaic, .samples = {}};
    raw.samples.reserve(pixels * places.size());
    const double full_scale = image.full_scale > 0.0 ? image.full_scale : 1.0;
    for (const std::size_t place : places) {
        for (std::size_t i = place * pixels; i < (place + 1) * pixels; ++i)
            raw.samples.push_back(static_cast<float>(planes[i] * full_scale - options.black_level));
    }
    return raw;
}

}  // namespace

void add_raw_file_options(CLI::App& app, RawFileOptions& options) {
    app.add_option("--bayer",
                   options.mosaic,
                   "the images are mosaics of this pattern, named after the four pixels at the\n"
                   "top left: RGGB, BGGR, GRBG or GBRG")
        ->check(CLI::Validator(
            [](const std::string& name) {
                return mosaic_named(name) ? "" : "allowed: RGGB, BGGR, GRBG or GBRG; found " + name;
            },
            "PATTERN"));
    app.add_option("--black-level",
                   options.black_level,
                   "the black level, in the camera's own numbers, which is taken off")
        ->capture_default_str();
}

RawImage read_raw_image(const std::filesystem::path& file, const RawFileOptions& options) {
    try {
        return raw_of(open_any_image(file), options);
    } catch (const InputError& error) {
        const std::string_view words = error.what();
        const std::string name = file.string() + ": ";
        throw InputError(std::string(words.starts_with(name) ? words.substr(name.size()) : words));
    }
}

void check_same_size(const RawImage& image, const RawImage& first) {
    if (image.width_px == first.width_px && image.height_px == first.height_px) return;
    throw InputError(fmt::format("found {} x {} pixels; allowed: {} x {}, as the first image",
                                 image.width_px,
                                 image.height_px,
                                 first.width_px,
                                 first.height_px));
}

void print_skipped(const std::filesystem::path& file, const std::string& why) {
    fmt::print(stderr, "aphotic: {}: {}; skipped\n", file.string(), why);
}

}  // namespace aphotic::cli
