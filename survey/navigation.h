// SPDX-License-Identifier: BSD-3-Clause
//
// Where the sled was when each image was taken.
//
// A navigation file is CSV with a header row, whose columns may stand in any order, others among
// them:
//
//   image,altitude_m,pitch_deg,roll_deg
//   201207.0001.tif,2.05,4.8,-0.3
//
// or lines of four fields parted by blanks, without a header, as HabCam's .eic files:
//
//   201207.0001.tif 2.05 4.8 -0.3
//
// Lines that are empty, hold commas alone or begin with # are passed over. A cell that is no number
// costs its own image alone, as does a line with too few or too many fields. altitude_m is measured
// along the camera's axis, pitch is positive bow up, roll positive starboard down: the rig's own
// conventions. A CSV file without a column for pitch or roll leaves it as the rig has it.
//
// An image is known by its file name without folder and without an image's extension, so that a
// line still holds when raw images were converted. An image that stands twice has no pose.
#pragma once

#include "rig/rig.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <unordered_map>

namespace aphotic {

struct ImagePose {
    std::string image;  // as the file has it
    std::size_t line = 0;
    Sled sled;
    std::string fault;  // why the line tells no pose; or empty
};

class Navigation {
  public:
    // The pose of an image file. An InputError when there is no line for it, the line cannot be
    // understood, or its numbers are none that a sled can have, such as the zeros and NaN of an
    // altimeter that lost the floor: that is of one image, and the others can do without it.
    [[nodiscard]] const ImagePose& pose_of(const std::filesystem::path& image) const;

    [[nodiscard]] std::size_t size() const { return poses_.size(); }

    // Whether the file tells them; else poses have the rig's.
    [[nodiscard]] bool has_pitch() const { return has_pitch_; }
    [[nodiscard]] bool has_roll() const { return has_roll_; }

  private:
    friend Navigation parse_navigation(const std::string&, std::string_view, const Sled&);

    void add(ImagePose pose);

    std::string name_;
    std::size_t nameless_line_ = 0;  // the first; 0: none
    bool has_pitch_ = true;
    bool has_roll_ = true;
    std::unordered_map<std::string, ImagePose> poses_;  // by the image's key
};

// name stands in messages. A header that cannot be understood, or no line of an image at all, is an
// InputError that names the line.
[[nodiscard]] Navigation parse_navigation(const std::string& name,
                                          std::string_view text,
                                          const Sled& rig_sled);
[[nodiscard]] Navigation read_navigation(const std::filesystem::path& file, const Sled& rig_sled);

// Whether the file's name ends as an image's does, such as .tif; in any letter case.
[[nodiscard]] bool is_image_name(const std::filesystem::path& file);

}  // namespace aphotic
