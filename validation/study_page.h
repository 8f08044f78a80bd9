// SPDX-License-Identifier: BSD-3-Clause
//
// A study for people: the recommendation, the plot of error against time, a table a subject, and
// how to read them. One page that needs no other file, no script and no network, for a window of
// any width. The same study gives the same page, byte for byte.
#pragma once

#include "validation/study.h"

#include <string>

namespace aphotic {

[[nodiscard]] std::string study_page(const Study& study);

}  // namespace aphotic
