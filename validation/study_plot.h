// SPDX-License-Identifier: BSD-3-Clause
//
// The plot of a study: time along x, largest error off the edges along y, both logarithmic. A mark
// a measure, its shape and colour by subject, filled for fitted wavelengths and hollow for equal
// bands; the Pareto front as steps, the tolerance as a level line.
//
// A measure whose time or error has no logarithm, or is infinite, is not drawn.
#pragma once

#include "validation/study.h"

#include <string>
#include <string_view>

namespace aphotic {

// Wide marks carry names; narrow ones, for a window of a phone's width, the measures' numbers from
// 1 on.
enum class StudyPlotWidth { Wide, Narrow };

[[nodiscard]] std::string study_svg(const Study& study, StudyPlotWidth width);

[[nodiscard]] bool is_drawn(const StudyMeasure& measure);

// A subject's mark alone, as an inline <svg>.
[[nodiscard]] std::string subject_mark(std::string_view subject, bool hollow);

}  // namespace aphotic
