// SPDX-License-Identifier: BSD-3-Clause
//
// The sled's pose when each image was taken. It is built from poses, by the reader of navigation
// (navigation_file.h) or by any program that knows them.
//
//   altitude  along the camera's axis      pitch  positive bow up      roll  positive starboard
//   down
//
// An image is identified by its file name without folder and image extension, so that a pose still
// holds after raw images were converted; or, if poses are in the files themselves, by its path. An
// image that occurs twice has no pose.
#pragma once

#include "rig/rig.h"
#include "survey/images/image_files.h"
#include "survey/navigation/vehicle_pose.h"

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

// How a survey's navigation was interpreted: the format, the columns used, their units, and how its
// poses became the camera's.

enum class AngleUnit { Degrees, Radians };

// How images are found in a track, by their times.
struct TimesOfImages {
    std::string mask{};  // of their names; empty: EXIF, or HabCam's names
    double clock_offset_s = 0.0;
    double longest_gap_s = 0.0;
    std::size_t lines_left_out = 0;  // of the track: no time, or no pose that a sled can have
};

struct NavigationNotes {
    std::string format{};
    std::vector<std::pair<std::string, std::string>> columns{};  // our name, the file's
    AngleUnit angles_in = AngleUnit::Degrees;
    std::optional<TimesOfImages> times{};  // empty: images have their names in the file
    Mounting mounting{};
};

// Everything that poses depend on, except omitted lines: a file may grow.
[[nodiscard]] nlohmann::ordered_json to_json(const NavigationNotes& notes);

// "oplab's CSV: image 'relative_path', ...; metres, degrees; altitude: along the axis"
[[nodiscard]] std::string words_of(const NavigationNotes& notes);

struct ImagePose {
    std::string image{};  // as the source has it
    Sled sled{};
    std::size_t line = 0;  // of the file; 0: of none
    std::string fault{};   // why the source tells no pose; or empty
    Place place{};         // where the source tells it, and is asked to
};

// Whether the source has the angles, for the whole survey; otherwise poses have others, such as the
// rig's.
struct GivenAngles {
    bool pitch = true;
    bool roll = true;
};

// Why no sled has this pose, such as the zeros and NaN of an altimeter that lost the floor; or
// empty.
[[nodiscard]] std::string fault_of(const Sled& sled);

enum class ImagesKnownBy { Name, Path };

class Navigation {
  public:
    // source is for messages, such as the file's name.
    Navigation(std::string source,
               const std::vector<ImagePose>& poses,
               GivenAngles given = {},
               ImagesKnownBy known_by = ImagesKnownBy::Name);

    // The pose of an image file. An InputError if there is none, it has a fault, or its numbers are
    // impossible for a sled: that concerns one image, and the others can be used without it.
    [[nodiscard]] const ImagePose& pose_of(const std::filesystem::path& image) const;

    // The name that stands in messages.
    [[nodiscard]] const std::string& source() const { return source_; }

    // From now on poses, which were the vehicle's, are the camera's.
    void mount(const Mounting& mounting);

    // Images outside this range no longer have a pose.
    void limit_altitude(double least_m, double most_m);

    [[nodiscard]] std::size_t size() const { return poses_.size(); }
    // All its poses, as the source has them, in its order.
    [[nodiscard]] std::vector<std::string> images() const;
    [[nodiscard]] const GivenAngles& given() const { return given_; }

    // Whether any pose has the vehicle's depth.
    [[nodiscard]] bool tells_depth() const;

    // Which angles poses have from anywhere: the source, or a rig that stands in for it.
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

// The highest pose of these images; empty if no image has one.
[[nodiscard]] std::optional<Sled> highest_pose(const Navigation& navigation,
                                               const std::vector<ImageFile>& files);

}  // namespace aphotic
