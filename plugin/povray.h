// SPDX-License-Identifier: BSD-3-Clause
//
// Finds POV-Ray and checks that it can do the work: version 3.7 or later, and built with OpenEXR
// unless frames are PNG.
//
// Searched in this order: the caller's name, the environment variable APHOTIC_POVRAY, and `povray`
// on PATH. The first one given is used; if it does not work, that is an error.
#pragma once

#include "image/frame_format.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace aphotic {

// The longest time without a sign of life before POV-Ray is stopped (plugin/life_signs.h). It
// computes from its first second to its last, so a minute without signs means a file system that
// does not respond, a waiting wrapper, or a suspended process.
inline constexpr double kStall_s = 60.0;

struct PovRay {
    std::filesystem::path executable;
    std::string version;      // such as 3.7.0.10.unofficial
    bool has_openexr = true;  // false for conda-forge's
};

// named: a path or a command's name, "" for none. Throws RunError, which lists the places searched.
[[nodiscard]] PovRay find_povray(const std::string& named);

// An option such as +I followed by a path, as one argument for POV-Ray. Throws InputError if the
// path has a quotation mark or letters beyond ASCII, which POV-Ray cannot read.
[[nodiscard]] std::string path_option(std::string_view option, const std::filesystem::path& path);

// A RunError if it has no OpenEXR; why: the part that requires it, and a remedy.
void require_openexr(const PovRay& povray, std::string_view why);

// The same for a POV-Ray that writes frames in this format.
void require_format(const PovRay& povray, FrameFormat format);

// The version from this output of --version; a RunError states the fault.
[[nodiscard]] PovRay povray_from(std::string_view printed);

}  // namespace aphotic
