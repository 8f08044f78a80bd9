// SPDX-License-Identifier: BSD-3-Clause
//
// extremes.toml, as it travels inside the library.
#pragma once

#include <span>
#include <string_view>

namespace aphotic {

struct StressSheet {
    std::string_view name;
    std::string_view text;
};

[[nodiscard]] std::span<const StressSheet> stress_sheet();

}  // namespace aphotic
