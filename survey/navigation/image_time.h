// SPDX-License-Identifier: BSD-3-Clause
//
// The time at which an image was taken, in seconds since 1970-01-01 00:00 UTC, from its file's name
// or its EXIF.
//
// A mask gives the position of the time in a name, character by character from the name's
// beginning:
//
//   PR_20240309_123456_789_LC16.tif
//   xxxYYYYMMDDxhhmmssxfff
//
// YYYY, MM, DD, hh, mm, ss stand for the digits of year to second; fff, if present, for
// milliseconds and uuu for microseconds; any other character for any one character. It may end
// before the name does. The letters are those of oplab's filename_to_date.
//
// Without a mask: EXIF's DateTimeOriginal with SubSecTimeOriginal, the digits of a decimal
// fraction, in the zone of OffsetTimeOriginal; if that is missing or blank, in UTC. OffsetTime is
// the zone of the file's last change, and is ignored. Otherwise a time as in HabCam's names,
// 20120623.171552346.1219.tif, to the millisecond. Times in names are UTC.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace aphotic {

// An InputError unless the mask has each of YYYY, MM, DD, hh, mm and ss once, and fff and uuu at
// most once, uuu with fff.
void require_time_mask(const std::string& mask);

// Empty if a digit is missing or there is no such time.
[[nodiscard]] std::optional<double> time_by_mask(std::string_view name, const std::string& mask);
[[nodiscard]] std::optional<double> time_in_habcam_name(const std::string& name);

// Tags: header_of_image() of image/any_image.h. An InputError if the zone is invalid.
[[nodiscard]] std::optional<double> time_in_exif(const std::map<std::string, std::string>& tags);

struct ImageTime {
    double time_s = 0.0;
    bool lacks_zone = false;  // of the shot, though its file has one: OffsetTime
};

// An empty mask means none. An InputError if the image has no time.
[[nodiscard]] ImageTime image_time(const std::filesystem::path& image, const std::string& mask);

}  // namespace aphotic
