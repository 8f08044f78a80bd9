// SPDX-License-Identifier: BSD-3-Clause
//
// An image's metadata, Exif, GPS, IPTC and XMP, copied unchanged from one file to another. Omitted
// are the tags that different pixels invalidate: sizes, compression, colour space, thumbnails, a
// raw file's levels and matrices; and maker notes, whose offsets cannot be changed.
//
// OpenImageIO copies less: 2.4 drops the GPS position of every TIFF and JPEG, the ISO number of a
// TIFF, and most of XMP. Exiv2 copies all.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace aphotic {

struct ImageTags;  // the library's own
using SharedTags = std::shared_ptr<const ImageTags>;

// Null if the file has no readable metadata.
[[nodiscard]] SharedTags read_image_tags(const std::filesystem::path& file);

// Adds these tags, if any, to those in the bytes of a TIFF, PNG or JPEG, and marks its samples as
// sRGB. A RunError that names the file if they are no such image.
void add_image_tags(const std::filesystem::path& file,
                    std::vector<unsigned char>& image,
                    const SharedTags& tags,
                    bool is_srgb = false);

// As names and values, such as Exif.GPSInfo.GPSLatitude and "41/1 30/1 444442/10000".
[[nodiscard]] std::vector<std::pair<std::string, std::string>> words_of(const ImageTags& tags);

// The camera's exposure; known values are above 0.
struct ShotExposure {
    std::optional<double> time_s{};
    std::optional<double> iso{};
    std::optional<double> f_number{};
};
[[nodiscard]] ShotExposure exposure_of(const ImageTags& tags);

// Tags to be written; empty if no value is known. Exif stores an exposure time to 1 ns, or to 1 us
// from 1 s on, an f-number to 1e-6, an ISO number without a fraction. taken_at: the time of the
// image, in UTC, as "YYYY:MM:DD hh:mm:ss"; empty: unknown.
[[nodiscard]] SharedTags tags_of(const ShotExposure& exposure, const std::string& taken_at = {});

}  // namespace aphotic
