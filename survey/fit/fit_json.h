// SPDX-License-Identifier: BSD-3-Clause
//
// A fit as JSON: the content of fit.json and the output of `aphotic fit --json`.
#pragma once

#include "survey/fit/fit.h"

#include <nlohmann/json_fwd.hpp>

namespace aphotic {

[[nodiscard]] nlohmann::ordered_json to_json(const FitResult& result);

}  // namespace aphotic
