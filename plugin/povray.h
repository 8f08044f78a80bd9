// SPDX-License-Identifier: BSD-3-Clause
//
// Finds POV-Ray and checks that it can do the work: version 3.7 or later, and built with OpenEXR
// unless frames are PNG.
//
// Searched in this order: the caller's name, the environment variable APHOTIC_POVRAY, and `povray`
// on PATH. The first one given is used; it is an error if it does not work.
#pragma once

#include "image/frame_format.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace aphotic {

// How long POV-Ray may show no sign of life before it is stopped (plugin/life_signs.h). It computes
// from its first second to its last, so a minute without signs is a file system that does not
// answer, a wrapper that waits for something, or a process put to sleep.
inline constexpr double kStall_s = 60.0;

struct PovRay {
    std::filesystem::path executable;
    std::string version;      // such as 3.7.0.10.unofficial
    bool has_openexr = true;  // conda-forge's has not
};

// named: a path or a command's name, "" for none. Throws RunError, which says where it searched.
[[nodiscard]] PovRay find_povray(const std::string& named);

// An option such as +I followed by a path, as one argument for POV-Ray. Throws InputError if the
// path has a quotation mark or letters beyond ASCII, which POV-Ray cannot read.
[[nodiscard]] std::string path_option(std::string_view option, const std::filesystem::path& path);

// A RunError if it has no OpenEXR; why: what needs it, and what to do.
void require_openexr(const PovRay& povray, std::string_view why);

// The same for a POV-Ray that is to write frames so.
void require_format(const PovRay& povray, FrameFormat format);

// The version from this output of --version; a RunError says what is wrong with it.
[[nodiscard]] PovRay povray_from(std::string_view printed);

}  // namespace aphotic
