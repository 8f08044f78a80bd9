// SPDX-License-Identifier: BSD-3-Clause
//
// A number of a pose, as tables and tags hold it.
#pragma once

#include "survey/navigation.h"

#include <string_view>

namespace aphotic {

// NaN when the field says that nobody knows it, as by None or an empty cell; what is neither is a
// fault of the pose.
[[nodiscard]] double number_in(ImagePose& pose, std::string_view column, std::string_view field);

}  // namespace aphotic
