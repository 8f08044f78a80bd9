// SPDX-License-Identifier: BSD-3-Clause
//
// The sled's pose at the time of each image. It is built from poses by the reader of navigation
// (navigation_file.h), or by any other program.
//
//   altitude  along the camera's axis
//   pitch     positive bow up
//   roll      positive starboard down
//
// An image is identified by its file name without folder and image extension, so that a pose
// remains valid after raw images are converted; or by its path, if poses are in the files
// themselves. An image that occurs twice has no pose.
#pragma once

#include "rig/rig.h"
#include "rig/vehicle_pose.h"
#include "survey/images/image_files.h"

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace aphotic {

// How a survey's navigation was interpreted: the format, the columns used, their units, and the
// conversion of its poses to the camera's.

enum class AngleUnit { Degrees, Radians };

// How images are located in a track by their times.
struct TimesOfImages {
    std::string mask{};  // of image names; empty: EXIF, or HabCam's names
    double clock_offset_s = 0.0;
    double longest_gap_s = 0.0;
    std::size_t lines_left_out = 0;  // of the track: no time, or an impossible pose
};

struct NavigationNotes {
    std::string format{};
    std::vector<std::pair<std::string, std::string>> columns{};  // our name, the file's
    AngleUnit angles_in = AngleUnit::Degrees;
    std::optional<TimesOfImages> times{};  // empty: the file names the images
    Mounting mounting{};
};

// Everything that poses depend on, except omitted lines: a file may grow.
[[nodiscard]] nlohmann::ordered_json to_json(const NavigationNotes& notes);

// "oplab's CSV: image 'relative_path', ...; metres, degrees; altitude: along the axis"
[[nodiscard]] std::string words_of(const NavigationNotes& notes);

struct ImagePose {
    std::string image{};  // as in the source
    double time_s = 0.0;  // of a track's, which has no image: since 1970 (time_text.h)
    Sled sled{};
    std::size_t line = 0;  // of the file; 0: none
    std::string fault{};   // why the source gives no pose; or empty
    Place place{};         // if requested, and given by the source
};

// Whether the source gives the angles, for the whole survey; otherwise they come from elsewhere,
// such as the rig.
struct GivenAngles {
    bool pitch = true;
    bool roll = true;
};

// Why a pose is impossible for a sled, such as the zeros and NaN of an altimeter that lost the
// floor; or empty.
[[nodiscard]] std::string fault_of(const Sled& sled);

enum class ImagesKnownBy { Name, Path };

class Navigation {
  public:
    // source is for messages, such as the file's name.
    Navigation(std::string source,
               const std::vector<ImagePose>& poses,
               GivenAngles given = {},
               ImagesKnownBy known_by = ImagesKnownBy::Name);

    // The pose of an image file. An InputError if it is missing, has a fault, or is impossible for
    // a sled; this concerns one image only.
    [[nodiscard]] const ImagePose& pose_of(const std::filesystem::path& image) const;

    // The name used in messages.
    [[nodiscard]] const std::string& source() const { return source_; }

    // Converts all poses from the vehicle's to the camera's.
    void mount(const Mounting& mounting);

    // Images outside this range lose their pose.
    void limit_altitude(double least_m, double most_m);

    [[nodiscard]] std::size_t size() const { return poses_.size(); }
    // All its images as named by the source, in its order.
    [[nodiscard]] std::vector<std::string> images() const;
    [[nodiscard]] const GivenAngles& given() const { return given_; }

    // Whether any pose has the vehicle's depth.
    [[nodiscard]] bool tells_depth() const;

    // Which angles are known from any source, including a rig that replaces the navigation's.
    [[nodiscard]] const GivenAngles& known() const { return known_; }
    void take_angles_of_rig() { known_ = {.pitch = true, .roll = true}; }

    // Null if no reader set them.
    [[nodiscard]] const std::optional<NavigationNotes>& notes() const { return notes_; }
    void note(NavigationNotes notes) { notes_ = std::move(notes); }

    // Possible problems in readable navigation, each with the source's name.
    [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }
    void warn(std::string what) { warnings_.push_back(std::move(what)); }

  private:
    [[nodiscard]] std::string key_of(const std::string& image) const;

    std::string source_;
    GivenAngles given_;
    GivenAngles known_;
    ImagesKnownBy known_by_;
    std::optional<NavigationNotes> notes_{};
    std::vector<std::string> warnings_{};
    std::size_t nameless_line_ = 0;  // the first; 0: none
    double least_m_ = 0.0;
    double most_m_ = std::numeric_limits<double>::infinity();
    std::unordered_map<std::string, ImagePose> poses_;  // by the image's key
};

}  // namespace aphotic
