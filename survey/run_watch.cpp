// SPDX-License-Identifier: BSD-3-Clause
#include "survey/run_watch.h"

#include <nlohmann/json.hpp>

namespace aphotic {

nlohmann::ordered_json to_json(const std::vector<Skipped>& skipped) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const Skipped& one : skipped) json.push_back({{"image", one.image}, {"why", one.why}});
    return json;
}

}  // namespace aphotic
