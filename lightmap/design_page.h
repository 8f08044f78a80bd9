// SPDX-License-Identifier: BSD-3-Clause
//
// A design as one page: what is gained, the light on the floor before and after, the trade of
// evenness against signal, where the strobes went, and the figures of every pose.
#pragma once

#include "lightmap/design.h"

#include <string>

namespace aphotic {

[[nodiscard]] std::string design_html(const Rig& rig,
                                      const DesignRequest& request,
                                      const DesignResult& result);

}  // namespace aphotic
