// SPDX-License-Identifier: BSD-3-Clause
//
// The part of the command that links libtiff; see height_grid.h.
#include "base/error.h"
#include "base/number.h"
#include "base/number_bytes.h"
#include "image/height_grid.h"
#include "image/image_size.h"
#include "image/tiff_handle.h"
#include "image/whole_tiff.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace {

using aphotic::HeightGrid;
using aphotic::InputError;
using aphotic::number_at;
using aphotic::size_of;

constexpr float kNoHeight = std::numeric_limits<float>::quiet_NaN();

// Tags that libtiff does not know.
constexpr std::uint32_t kModelPixelScale = 33550;
constexpr std::uint32_t kModelTiepoint = 33922;
constexpr std::uint32_t kModelTransformation = 34264;
constexpr std::uint32_t kGeoKeyDirectory = 34735;
constexpr std::uint32_t kGdalMetadata = 42112;
constexpr std::uint32_t kGdalNodata = 42113;

// Empty if the file has another type, as libtiff reports it.
template <typename Value>
std::span<const Value> values_of(TIFF* tiff, std::uint32_t tag, TIFFDataType type) {
    const TIFFField* const field = ::TIFFFindField(tiff, tag, TIFF_ANY);
    if (field == nullptr || ::TIFFFieldDataType(field) != type || ::TIFFFieldPassCount(field) == 0)
        return {};
    std::uint32_t count = 0;
    const Value* values = nullptr;
    if (::TIFFGetField(tiff, tag, &count, &values) != 1) return {};
    return {values, count};
}

std::string text_of(TIFF* tiff, std::uint32_t tag) {
    const auto letters = values_of<char>(tiff, tag, TIFF_ASCII);
    const std::string text(letters.begin(), letters.end());
    return text.substr(0, text.find('\0'));
}

// The keys stored in the directory itself, by their numbers.
std::map<int, int> geo_keys(TIFF* tiff) {
    constexpr std::size_t kEntry = 4;  // key, location, count, value
    const auto shorts = values_of<std::uint16_t>(tiff, kGeoKeyDirectory, TIFF_SHORT);
    std::map<int, int> keys;
    for (std::size_t i = kEntry; i + kEntry <= shorts.size(); i += kEntry)
        if (shorts[i + 1] == 0) keys[shorts[i]] = shorts[i + 3];
    return keys;
}

void require_metres(const std::map<int, int>& keys) {
    constexpr int kModelType = 1024;
    constexpr int kGeographic = 2;
    constexpr int kMetre = 9001;
    constexpr int kOwn = 32767;  // user-defined, described elsewhere
    const auto of = [&](int key, int otherwise) {
        const auto found = keys.find(key);
        return found == keys.end() ? otherwise : found->second;
    };
    if (of(kModelType, 0) == kGeographic)
        throw InputError(
            "found a grid of geographic degrees; allowed: metres of a projection, as "
            "`gdalwarp -t_srs EPSG:32619 IN.tif OUT.tif` makes them, in the navigation's zone");
    for (const auto& [key, what] : {std::pair{3076, "across"}, {4099, "of its heights"}}) {
        const int unit = of(key, kMetre);
        if (unit != kMetre && unit != kOwn)
            throw InputError(
                "found the unit {} {} (EPSG); allowed: metres, {}", unit, what, kMetre);
    }
}

void place_on_map(TIFF* tiff, HeightGrid& grid) {
    constexpr std::size_t kTie = 6;
    constexpr int kRasterType = 1025;
    constexpr int kPoints = 2;
    const auto scale = values_of<double>(tiff, kModelPixelScale, TIFF_DOUBLE);
    const auto tie = values_of<double>(tiff, kModelTiepoint, TIFF_DOUBLE);
    if (scale.size() < 2 || tie.size() != kTie) {
        const bool is_turned = !values_of<double>(tiff, kModelTransformation, TIFF_DOUBLE).empty();
        throw InputError(
            "found {}; needed: ModelPixelScale and one ModelTiepoint, as gdalwarp writes them to a "
            "north-up GeoTIFF",
            is_turned ? "a ModelTransformation" : "no georeference");
    }
    if (!(scale[0] > 0.0 && scale[1] > 0.0 && std::isfinite(tie[3]) && std::isfinite(tie[4])))
        throw InputError("found pixels of {} x {} m; allowed: above 0", scale[0], scale[1]);
    const auto keys = geo_keys(tiff);
    require_metres(keys);
    const auto raster = keys.find(kRasterType);
    const double middle = raster != keys.end() && raster->second == kPoints ? 0.0 : 0.5;
    grid.step_east_m = scale[0];
    grid.step_south_m = scale[1];
    grid.east_m = tie[3] + (middle - tie[0]) * scale[0];
    grid.north_m = tie[4] - (middle - tie[1]) * scale[1];
}

struct SampleKind {
    std::uint16_t format;
    std::uint16_t bits;
    float (*at)(const void* bytes);
};
constexpr std::array kSampleKinds{
    SampleKind{SAMPLEFORMAT_IEEEFP, 32, number_at<float, float>},
    SampleKind{SAMPLEFORMAT_IEEEFP, 64, number_at<double, float>},
    SampleKind{SAMPLEFORMAT_INT, 8, number_at<std::int8_t, float>},
    SampleKind{SAMPLEFORMAT_INT, 16, number_at<std::int16_t, float>},
    SampleKind{SAMPLEFORMAT_INT, 32, number_at<std::int32_t, float>},
    SampleKind{SAMPLEFORMAT_UINT, 8, number_at<std::uint8_t, float>},
    SampleKind{SAMPLEFORMAT_UINT, 16, number_at<std::uint16_t, float>},
    SampleKind{SAMPLEFORMAT_UINT, 32, number_at<std::uint32_t, float>}};

template <typename Value>
Value tag_number(TIFF* tiff, std::uint32_t tag) {
    Value value{};
    ::TIFFGetFieldDefaulted(tiff, tag, &value);
    return value;
}

const SampleKind& kind_of(TIFF* tiff) {
    const auto format = tag_number<std::uint16_t>(tiff, TIFFTAG_SAMPLEFORMAT);
    const auto bits = tag_number<std::uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE);
    const auto channels = tag_number<std::uint16_t>(tiff, TIFFTAG_SAMPLESPERPIXEL);
    const auto* const kind = std::ranges::find_if(kSampleKinds, [&](const SampleKind& one) {
        return one.format == format && one.bits == bits;
    });
    if (kind == kSampleKinds.end() || channels != 1)
        throw InputError(
            "found {} channels of {} bits, sample format {}; allowed: one channel of integers or "
            "floats, of 8 to 64 bits",
            channels,
            bits,
            format);
    return *kind;
}

// Strips are tiles as wide as the grid.
void read_heights(TIFF* tiff, HeightGrid& grid) {
    const SampleKind& kind = kind_of(tiff);
    const bool is_tiled = ::TIFFIsTiled(tiff) != 0;
    const auto width = size_of(grid.width);
    const auto height = size_of(grid.height);
    const std::size_t across =
        is_tiled ? tag_number<std::uint32_t>(tiff, TIFFTAG_TILEWIDTH) : width;
    const std::size_t down =
        is_tiled
            ? tag_number<std::uint32_t>(tiff, TIFFTAG_TILELENGTH)
            : std::min<std::size_t>(tag_number<std::uint32_t>(tiff, TIFFTAG_ROWSPERSTRIP), height);
    const std::size_t sample_bytes = kind.bits / 8U;
    std::vector<std::uint8_t> part(across * down * sample_bytes);
    const std::size_t parts_across = (width + across - 1) / across;
    grid.height_m.assign(width * height, kNoHeight);
    for (std::size_t top = 0, n = 0; top < height; top += down) {
        for (std::size_t left = 0; left < parts_across * across; left += across, ++n) {
            const auto index = static_cast<std::uint32_t>(n);
            const auto room = static_cast<tmsize_t>(part.size());
            const tmsize_t got = is_tiled ? ::TIFFReadEncodedTile(tiff, index, part.data(), room)
                                          : ::TIFFReadEncodedStrip(tiff, index, part.data(), room);
            if (got < 0) return;  // libtiff reports the reason
            for (std::size_t row = top; row < std::min(height, top + down); ++row)
                for (std::size_t column = left; column < std::min(width, left + across); ++column)
                    grid.height_m[row * width + column] =
                        kind.at(&part[((row - top) * across + column - left) * sample_bytes]);
        }
    }
}

void leave_out_unknown(TIFF* tiff, HeightGrid& grid) {
    const std::string metadata = text_of(tiff, kGdalMetadata);
    if (metadata.find("role=\"scale\"") != std::string::npos ||
        metadata.find("role=\"offset\"") != std::string::npos)
        throw InputError(
            "found a scale or offset of its numbers in GDAL_METADATA; allowed: metres, as "
            "`gdal_translate -unscale -ot Float32` makes them");
    std::string nodata = text_of(tiff, kGdalNodata);
    std::erase(nodata, ' ');
    const auto none = aphotic::read_number<double>(nodata);
    for (float& height_m : grid.height_m)
        if (!std::isfinite(height_m) || (none && height_m == static_cast<float>(*none)))
            height_m = kNoHeight;
}

}  // namespace

// Throws an InputError that does not name the file.
extern "C" void aphotic_read_height_grid(const std::filesystem::path& file, HeightGrid& grid) {
    aphotic::require_whole_tiff(file);
    aphotic::require_sound_streams(file);
    aphotic::SaidOfTiff said;
    const aphotic::TiffHandle tiff = aphotic::open_tiff(file, "rm", said);
    if (!tiff) throw InputError("it cannot be read: {}", said.error);
    grid.width = static_cast<int>(tag_number<std::uint32_t>(tiff.get(), TIFFTAG_IMAGEWIDTH));
    grid.height = static_cast<int>(tag_number<std::uint32_t>(tiff.get(), TIFFTAG_IMAGELENGTH));
    place_on_map(tiff.get(), grid);
    read_heights(tiff.get(), grid);
    if (!said.error.empty()) throw InputError("it cannot be read: {}", said.error);
    leave_out_unknown(tiff.get(), grid);
}
