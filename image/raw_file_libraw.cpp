// SPDX-License-Identifier: BSD-3-Clause
//
// The part of the command that links LibRaw; see raw_file.h.
#include "base/error.h"
#include "image/decoded_size.h"
#include "image/image_size.h"
#include "image/raw_file.h"

#include <fmt/format.h>
#include <libraw/libraw.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace {

using aphotic::size_of;

[[noreturn]] void refuse_raw(const std::filesystem::path& file, const std::string& why) {
    throw aphotic::InputError("{}: cannot be read: {}", file.string(), why);
}

[[noreturn]] void refuse_samples(const std::filesystem::path& file) {
    refuse_raw(file, "found samples that are not whole numbers");
}

void require_success(int status, const std::filesystem::path& file) {
    if (status != LIBRAW_SUCCESS) refuse_raw(file, LibRaw::strerror(status));
}

// A two by two mosaic; LibRaw's numbers below a thousand mean other patterns.
bool is_bayer(const LibRaw& raw) {
    constexpr unsigned kOthers = 1000;
    return raw.imgdata.idata.filters >= kOthers;
}

std::string pattern_of(LibRaw& raw, const std::filesystem::path& file) {
    const auto& sensor = raw.imgdata.idata;
    if (sensor.filters == 0) {
        if (sensor.colors == 1) return "mono";
        if (sensor.colors == 3) return "none";
        refuse_raw(file, fmt::format("found {} colours; allowed: 1 or 3", sensor.colors));
    }
    std::string pattern;
    for (int site = 0; site < 4; ++site) {
        const int colour = is_bayer(raw) ? raw.COLOR(site / 2, site % 2) : 6;
        pattern += colour < 4 ? sensor.cdesc[colour] : '?';
    }
    static const std::array<std::string, 4> kPatterns{"RGGB", "BGGR", "GRBG", "GBRG"};
    if (std::ranges::find(kPatterns, pattern) != kPatterns.end()) return pattern;
    refuse_raw(file, fmt::format("found another mosaic pattern; allowed: RGGB, BGGR, GRBG, GBRG"));
}

// The black level of every site of a mosaic, or every channel: the common level, the colour's, and
// the pattern's.
double black_at(LibRaw& raw, int row, int column, int colour) {
    const auto& levels = raw.imgdata.color;
    const unsigned rows = levels.cblack[4];
    const unsigned columns = levels.cblack[5];
    double black = levels.black + levels.cblack[colour];
    if (rows > 0 && columns > 0) {
        black += levels.cblack[6 + static_cast<unsigned>(row) % rows * columns +
                               static_cast<unsigned>(column) % columns];
    }
    return black;
}

// Black levels of the sites at the top left, which then repeat.
struct BlackPattern {
    int rows = 2;
    int columns = 2;
    std::vector<double> blacks{};

    [[nodiscard]] double at(int row, int column) const {
        return blacks[size_of(row % rows) * size_of(columns) + size_of(column % columns)];
    }
};

BlackPattern blacks_of(LibRaw& raw) {
    const auto& levels = raw.imgdata.color;
    const auto even = [](unsigned count) { return 2 * std::max(1, static_cast<int>(count)); };
    BlackPattern pattern{.rows = even(levels.cblack[4]), .columns = even(levels.cblack[5])};
    const bool is_mosaic = is_bayer(raw);
    for (int row = 0; row < pattern.rows; ++row) {
        for (int column = 0; column < pattern.columns; ++column) {
            const int colour = is_mosaic ? raw.COLOR(row, column) : 0;
            pattern.blacks.push_back(black_at(raw, row, column, colour));
        }
    }
    return pattern;
}

// One plane, or interleaved R, G and B.
std::vector<double> all_blacks(LibRaw& raw, const std::string& pattern) {
    if (pattern != "none") return blacks_of(raw).blacks;
    return {black_at(raw, 0, 0, 0), black_at(raw, 0, 0, 1), black_at(raw, 0, 0, 2)};
}

std::vector<float> mosaic_of(LibRaw& raw, double black) {
    const auto& sizes = raw.imgdata.sizes;
    const std::size_t pitch = sizes.raw_pitch / sizeof(ushort);
    const BlackPattern blacks = blacks_of(raw);
    std::vector<float> samples;
    samples.reserve(std::size_t{sizes.height} * sizes.width);
    for (int row = 0; row < sizes.height; ++row) {
        const ushort* const from = raw.imgdata.rawdata.raw_image +
                                   size_of(sizes.top_margin + row) * pitch + sizes.left_margin;
        for (int column = 0; column < sizes.width; ++column)
            samples.push_back(static_cast<float>(from[column] - (blacks.at(row, column) - black)));
    }
    return samples;
}

std::vector<float> colours_of(LibRaw& raw, double black) {
    const auto& sizes = raw.imgdata.sizes;
    const auto& data = raw.imgdata.rawdata;
    const std::size_t side_by_side = data.color3_image != nullptr ? 3 : 4;
    const ushort* const pixels =
        data.color3_image != nullptr ? data.color3_image[0] : data.color4_image[0];
    const std::size_t pitch = sizes.raw_pitch / sizeof(ushort);
    std::vector<float> planes;
    planes.reserve(3 * std::size_t{sizes.height} * sizes.width);
    for (int channel = 0; channel < 3; ++channel) {
        const auto more = static_cast<float>(black_at(raw, 0, 0, channel) - black);
        for (int row = 0; row < sizes.height; ++row) {
            const ushort* const from =
                pixels + size_of(sizes.top_margin + row) * pitch + sizes.left_margin * side_by_side;
            for (std::size_t column = 0; column < sizes.width; ++column) {
                planes.push_back(static_cast<float>(
                                     from[column * side_by_side + static_cast<unsigned>(channel)]) -
                                 more);
            }
        }
    }
    return planes;
}

// Memory of the samples that unpack() holds, at most four of 16 bits per pixel, and of its buffers.
void require_sound_sizes(LibRaw& raw, const std::filesystem::path& file) {
    constexpr std::uint64_t kMostPixel_bytes = 8;
    constexpr std::uint64_t kBeside_mebi = 256;
    const auto& sizes = raw.imgdata.sizes;
    const std::uint64_t pixels = std::uint64_t{sizes.raw_width} * sizes.raw_height;
    try {
        aphotic::require_sides(sizes.width, sizes.height);
        aphotic::require_tiles(
            {sizes.width, sizes.height}, {sizes.raw_width, sizes.raw_height}, kMostPixel_bytes);
        aphotic::require_file_size(
            std::filesystem::file_size(file), pixels * kMostPixel_bytes, pixels);
    } catch (const aphotic::InputError& error) {
        refuse_raw(file, error.what());
    }
    if (raw.is_floating_point() != 0) refuse_samples(file);
    raw.imgdata.params.max_raw_memory_mb =
        static_cast<unsigned>(pixels * kMostPixel_bytes / aphotic::kMebi + kBeside_mebi);
}

}  // namespace

extern "C" void aphotic_open_raw_file(const std::filesystem::path& file, aphotic::RawFile& opened) {
    const auto raw = std::make_shared<LibRaw>();
    raw->set_dataerror_handler(nullptr, nullptr);  // it would also print the errors that are thrown
    require_success(raw->open_file(file.c_str()), file);
    require_sound_sizes(*raw, file);
    const auto& sizes = raw->imgdata.sizes;
    opened.width_px = sizes.width;
    opened.height_px = sizes.height;
    opened.pattern = pattern_of(*raw, file);
    const std::vector<double> blacks = all_blacks(*raw, opened.pattern);
    const auto [least, most] = std::ranges::minmax(blacks);
    opened.black = least;
    opened.white = raw->imgdata.color.maximum - (most - least);
    opened.samples = [raw, file, black = least] {
        require_success(raw->unpack(), file);
        const auto& data = raw->imgdata.rawdata;
        if (data.raw_image != nullptr) return mosaic_of(*raw, black);
        if (data.color3_image != nullptr || data.color4_image != nullptr)
            return colours_of(*raw, black);
        refuse_samples(file);
    };
}
