// SPDX-License-Identifier: BSD-3-Clause
//
// A design as one page: the gain, the light on the floor before and after, the trade-off of
// evenness against signal, the new places of the strobes, and the figures of every pose.
#pragma once

#include "lightmap/design.h"

#include <string>

namespace aphotic {

[[nodiscard]] std::string design_html(const Rig& rig,
                                      const DesignRequest& request,
                                      const DesignResult& result);

}  // namespace aphotic
