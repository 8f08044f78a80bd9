// SPDX-License-Identifier: BSD-3-Clause
//
// Navigation from wherever a survey keeps it, known by its content:
//
//   a table          of poses by image, or of poses over time (navigation_csv.h, track.h)
//   an iFDO          of the camera's own poses (navigation_ifdo.h)
//   the images' tags HabCam's, with "tags" for a file's name
//
// What poses over time are of: an image's time (image_time.h) plus clock_offset_s. Lines of the
// track without a time, or with a pose that no sled can have or from outside the altitudes, are
// left out: an altimeter that loses the floor makes a gap, and no altitude between 2 m and 0.
//
// Else poses are those of the vehicle; from them follow the camera's (vehicle_pose.h).
#pragma once

#include "survey/images/image_files.h"
#include "survey/navigation/ifdo.h"
#include "survey/navigation/navigation.h"
#include "survey/navigation/navigation_columns.h"
#include "survey/navigation/track.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace aphotic {

// HabCam's tags, which its controller writes into the ImageDescription of each image:
//
//   lat=40.612345,lon=-67.123456,hdg=181.20,pitch=-4.80,roll=0.30,alt0=2.05,alt1=2.11,depth=61.2,...
//
// Keys with their values, parted by commas, in any order. Angles are in degrees, altitudes in
// metres: alt0 and alt1 are the two altimeters'.
//
// Source: howland54/habcam-dsvimc.

// alt0, pitch and roll, or what `given` names instead of them. An InputError when it names anything
// but these three.
[[nodiscard]] ColumnNames tag_names(const ColumnNames& given);

// A fault of the pose, and no error, where the description has none of them.
void read_tags(ImagePose& pose,
               std::string_view description,
               const ColumnNames& names,
               AngleUnit angles_in);

inline constexpr std::string_view kNavigationInTags = "tags";
inline constexpr std::size_t kMostNavigation_bytes = kMostIfdo_bytes;

struct NavigationOptions {
    std::string source{};  // a file, or kNavigationInTags
    ColumnNames columns{};
    AngleUnit angles_in = AngleUnit::Degrees;
    bool has_places = false;  // where the vehicle was is read, too
    std::string time_mask{};  // of the images' names
    double clock_offset_s = 0.0;
    double longest_gap_s = kLongestGap_s;
    std::optional<AltitudeIs> altitude_is{};    // none: as the rig has it
    std::optional<double> altitude_offset_m{};  // none: as the rig has it
    double least_altitude_m = 0.0;              // of the camera
    double most_altitude_m = std::numeric_limits<double>::infinity();
    std::size_t jobs = std::max(1U, std::thread::hardware_concurrency());  // files read at a time
};

// What else is known of the sled: a rig, or null. An InputError when the source as a whole cannot
// be understood, or does not tell the angles that the camera's pose needs.
[[nodiscard]] Navigation read_navigation(const NavigationOptions& options,
                                         const std::vector<ImageFile>& files,
                                         const Rig* rig);

// The same of a text, whose name options.source is.
[[nodiscard]] Navigation parse_navigation(std::string_view text,
                                          const NavigationOptions& options,
                                          const std::vector<ImageFile>& files,
                                          const Rig* rig);

}  // namespace aphotic
