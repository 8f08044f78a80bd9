// SPDX-License-Identifier: BSD-3-Clause
//
// Navigation in any of a survey's formats, recognised by its content:
//
//   a table          of poses by image, or of poses over time (navigation_csv.h, track.h)
//   an iFDO          of the camera's own poses (navigation_ifdo.h)
//   the images' tags HabCam's, with "tags" for a file's name
//
// The times of images (image_time.h) are shifted by clock_offset_s and looked up in poses over
// time. Lines of the track without a time, or with a pose that is impossible for a sled or outside
// the altitude range, are omitted: an altimeter that loses the floor leaves a gap, and not an
// altitude between 2 m and 0.
//
// All other poses are the vehicle's and are converted to the camera's (rig/vehicle_pose.h).
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
// Keys with their values, separated by commas, in any order. Angles are in degrees, altitudes in
// metres; alt0 and alt1 are the two altimeters'.
//
// Source: howland54/habcam-dsvimc.

// alt0, pitch and roll, or the keys that `given` names instead. An InputError if it names any
// other.
[[nodiscard]] ColumnNames tag_names(const ColumnNames& given);

// A fault of the pose, not an error, if the description has none of them.
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
    bool has_places = false;  // also read the vehicle's place
    std::string time_mask{};  // of the images' names
    double clock_offset_s = 0.0;
    double longest_gap_s = kLongestGap_s;
    std::optional<AltitudeIs> altitude_is{};    // empty: as in the rig
    std::optional<double> altitude_offset_m{};  // empty: as in the rig
    double least_altitude_m = 0.0;              // of the camera
    double most_altitude_m = std::numeric_limits<double>::infinity();
    std::size_t jobs = std::max(1U, std::thread::hardware_concurrency());  // files read at a time
};

// rig: the source of whatever the navigation lacks, or null. An InputError if the source as a whole
// cannot be interpreted, or lacks the angles that the camera's pose needs.
[[nodiscard]] Navigation read_navigation(const NavigationOptions& options,
                                         const std::vector<ImageFile>& files,
                                         const Rig* rig);

// The same from a text, named by options.source.
[[nodiscard]] Navigation parse_navigation(std::string_view text,
                                          const NavigationOptions& options,
                                          const std::vector<ImageFile>& files,
                                          const Rig* rig);

}  // namespace aphotic
