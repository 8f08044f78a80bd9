// SPDX-License-Identifier: BSD-3-Clause
//
// What a file says of its image: Exif, GPS, IPTC and XMP, carried from one file to another as they
// are. Left behind is what another file's pixels make untrue: sizes, compression, colour space,
// thumbnails, a raw file's levels and matrices; and makers' notes, whose insides nobody can move.
//
// OpenImageIO carries less: 2.4 drops the GPS position of every TIFF and JPEG, the ISO number of a
// TIFF, and most of XMP. Exiv2 does this.
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

// None: the file has none that can be read.
[[nodiscard]] SharedTags read_image_tags(const std::filesystem::path& file);

// To those of a TIFF, PNG or JPEG, where there are some, and that its samples are encoded as sRGB.
// A RunError when it cannot be written, of the file as it will be called, where that is another
// name.
void add_image_tags(const std::filesystem::path& file,
                    const SharedTags& tags,
                    bool is_srgb = false,
                    const std::filesystem::path& called = {});

// As names and words, such as Exif.GPSInfo.GPSLatitude and "41/1 30/1 444442/10000".
[[nodiscard]] std::vector<std::pair<std::string, std::string>> words_of(const ImageTags& tags);

// How much light the camera took; what is told by numbers over 0.
struct ShotExposure {
    std::optional<double> time_s{};
    std::optional<double> iso{};
    std::optional<double> f_number{};
};
[[nodiscard]] ShotExposure exposure_of(const ImageTags& tags);

// To be written; none where nothing is told. Exif holds a time to 1 ns and, of 1 s and more, to
// 1 us, an f-number to 1e-6, an ISO number without a fraction. taken_at: when it was taken, in UTC,
// as "YYYY:MM:DD hh:mm:ss"; empty: not told.
[[nodiscard]] SharedTags tags_of(const ShotExposure& exposure, const std::string& taken_at = {});

}  // namespace aphotic
