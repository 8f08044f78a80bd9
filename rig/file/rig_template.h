// SPDX-License-Identifier: BSD-3-Clause
//
// Rigs to begin with: files of scenes/, embedded in the library. A value that a user has to measure
// is followed by a mark, "# measure: the lamp's data sheet". It counts as unmeasured until it
// differs from the template's, or until the mark is removed, which confirms the template's value.
#pragma once

#include "spectral/curve_loader.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

// Each has the name of its file in scenes/.
[[nodiscard]] std::span<const BuiltinTable> template_files();

// habcam, led, auv.
[[nodiscard]] std::vector<std::string> template_names();

struct RigTemplate {
    std::string rig;                  // its text, with a heading that states its origin
    std::vector<BuiltinTable> files;  // the files that it names
};
[[nodiscard]] RigTemplate rig_template(std::string_view name);

struct UnmeasuredLine {
    int line = 0;      // of the rig's file
    std::string text;  // "focal_length_mm = 12.0"
};

// Empty for a rig that does not begin like a template.
[[nodiscard]] std::vector<UnmeasuredLine> unmeasured_lines(std::string_view rig);

}  // namespace aphotic
