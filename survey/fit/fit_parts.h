// SPDX-License-Identifier: BSD-3-Clause
//
// How many parts of a beam's table the images tell. Too many follow the floor's texture as well,
// and a beam of such detail seems to tell to a hair where its lamp points, and tells it wrong. So
// the number is that of kRungs with the least
//
//   S + ln(n) tr(H^-1 M)
//
// S  the objective (fit_search.h), H its curvature, M the variance of its gradient, both as the
//    sandwich has them (fit_equations.h)
// n  tiles of all images, within which noise may be correlated as it likes
//
// It is G. Schwarz's criterion (Ann. Stat. 6 (1978) 461) with K. Takeuchi's trace for the count of
// what is fitted, which holds for any noise. Takeuchi's own, of 2 for ln(n), and twice that choose
// too many: it is derived for one valley of S, and the least of several is lower by chance alone.
//
// S of two rungs is compared as fit_search.h says (excess). From the fewest on, until two more
// rungs do not do better.
#pragma once

#include "rig/file/rig_text.h"
#include "survey/fit/fit_problem.h"
#include "survey/fit/fit_samples.h"
#include "survey/fit/fit_search.h"
#include "survey/run_watch.h"

#include <array>
#include <cstddef>

namespace aphotic {

inline constexpr std::array<std::size_t, 6> kRungs{6, 8, 12, 16, 24, kMostParts};

// The problem with as many parts as the images tell, its state the answer to these samples.
[[nodiscard]] FitProblem with_told_parts(const RigText& rig,
                                         const FitSamples& samples,
                                         const FitOptions& options,
                                         const FitAngles& angles,
                                         const RunWatch& watch);

}  // namespace aphotic
