// SPDX-License-Identifier: BSD-3-Clause
//
// The plot of a study: time along x, largest error off the edges along y, both logarithmic. A mark
// a measure, its shape and colour by subject, filled for fitted wavelengths and hollow for equal
// bands; the Pareto front as steps, the tolerance as a level line.
//
// A measure whose time or error has no logarithm, or is infinite, is not drawn.
#pragma once

#include "validation/study.h"

#include <array>
#include <string>
#include <string_view>

namespace aphotic {

// What a study varies.
struct StudySubject {
    std::string_view name;
    std::string_view heading;
    std::string_view words;
};
inline constexpr std::array<StudySubject, 7> kStudySubjects{{
    {"wavelengths",
     "Wavelengths",
     "How many, and how they are chosen: fitted to this rig’s lamps, water and camera, or as equal "
     "bands. Three share a frame, on all cores."},
    {"packing", "Wavelengths a frame", "One wavelength a frame in place of three."},
    {"resolution",
     "Resolution",
     "Rendered with fewer pixels over the same field of view, and enlarged with a filter."},
    {"emitters",
     "Emitters",
     "One lamp with softened cone edges in place of the many that stand for an emitter."},
    {"frames", "Frames", "16-bit linear PNG in place of half-float EXR."},
    {"antialiasing", "Antialiasing", "POV-Ray’s adaptive supersampling."},
    {"jobs", "Jobs", "One POV-Ray at a time in place of one a core."},
}};

[[nodiscard]] std::string study_svg(const Study& study);

[[nodiscard]] bool is_drawn(const StudyMeasure& measure);

// A subject's mark alone, as an inline <svg>.
[[nodiscard]] std::string subject_mark(std::string_view subject, bool hollow);

}  // namespace aphotic
