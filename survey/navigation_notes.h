// SPDX-License-Identifier: BSD-3-Clause
//
// What a survey's navigation was taken for: the format, which of its columns say what, in which
// unit, and how its poses became the camera's.
#pragma once

#include "rig/rig.h"

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace aphotic {

enum class AngleUnit { Degrees, Radians };

// Where images are found in a track, by their times.
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
    std::optional<TimesOfImages> times{};  // none: images have their names in the file
    Mounting mounting{};
};

// All that poses depend on, lines left out aside: a file may grow.
[[nodiscard]] nlohmann::ordered_json to_json(const NavigationNotes& notes);

// "oplab's CSV: image 'relative_path', ...; metres, degrees; altitude: along the axis"
[[nodiscard]] std::string words_of(const NavigationNotes& notes);

}  // namespace aphotic
