// SPDX-License-Identifier: BSD-3-Clause
//
// Rigs to begin with: files of scenes/ that travel inside the library. A line that a user has to
// measure says so behind its value, "# measure: the lamp's data sheet". It counts as unmeasured
// until its value differs from the template's, or until the mark is gone, which says that the
// template's value is right.
#pragma once

#include "spectral/curve_loader.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

// Each as a file of scenes/ is called.
[[nodiscard]] std::span<const BuiltinTable> template_files();

// habcam, led, auv.
[[nodiscard]] std::vector<std::string> template_names();

struct RigTemplate {
    std::string rig;                  // its text, with a heading that says where it comes from
    std::vector<BuiltinTable> files;  // what it names, to be beside it
};
[[nodiscard]] RigTemplate rig_template(std::string_view name);

struct UnmeasuredLine {
    int line = 0;      // of the rig's file
    std::string text;  // "focal_length_mm = 12.0"
};

// None in a rig that does not begin as a template does.
[[nodiscard]] std::vector<UnmeasuredLine> unmeasured_lines(std::string_view rig);

}  // namespace aphotic
