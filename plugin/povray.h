// SPDX-License-Identifier: BSD-3-Clause
//
// Finding POV-Ray, and making sure that it is one that can do the work: version 3.7 or later, and
// built with OpenEXR, but for frames as PNG.
//
// Looked for in this order: what the caller names, the environment variable APHOTIC_POVRAY, and
// `povray` on PATH. The first that is given counts; it is an error when it does not serve.
#pragma once

#include "image/frame_format.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace aphotic {

// How long POV-Ray may show no sign of life before it is stopped (plugin/life_signs.h). It computes
// from its first second to its last, so a minute without is a file system that does not answer, a
// wrapper that waits for something, or a process put to sleep.
inline constexpr double kStall_s = 60.0;

struct PovRay {
    std::filesystem::path executable;
    std::string version;      // such as 3.7.0.10.unofficial
    bool has_openexr = true;  // conda-forge's has not
};

// named: a path or a command's name, "" for none. Throws RunError, which says where was looked.
[[nodiscard]] PovRay find_povray(const std::string& named);

// An option such as +I with a path behind it, as one argument of POV-Ray's. Throws InputError when
// the path holds a quotation mark or letters beyond ASCII, which POV-Ray has no way to read.
[[nodiscard]] std::string path_option(std::string_view option, const std::filesystem::path& path);

// A RunError of one without OpenEXR; why: in which something is written, and what to do.
void require_openexr(const PovRay& povray, std::string_view why);

// The same of one that is to write frames so.
void require_format(const PovRay& povray, FrameFormat format);

// What prints this for --version; a RunError says what is wrong with it.
[[nodiscard]] PovRay povray_from(std::string_view printed);

}  // namespace aphotic
