// SPDX-License-Identifier: BSD-3-Clause
//
// Reports from work on a survey to whatever displays them, such as a terminal or a window. Calls
// never overlap.
#pragma once

#include "survey/survey_check.h"

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

// An image that could not be used.
struct Skipped {
    std::string image;
    std::string why;
};

[[nodiscard]] nlohmann::ordered_json to_json(const std::vector<Skipped>& skipped);

struct RunWatch {
    // share: of this part of the work, 0 to 1; it falls when another part begins.
    std::function<void(std::string_view what, double share)> progress = [](auto, auto) {};
    std::function<void(const Skipped& one)> skipped = [](const auto&) {};
    // A dropout.
    std::function<void(const MarkedImage& one)> marked = [](const auto&) {};
    // Before anything is written, even if nothing looks wrong. An exception from here ends the run.
    std::function<void(const std::vector<Suspicion>& found)> looks_wrong = [](const auto&) {};
};

}  // namespace aphotic
