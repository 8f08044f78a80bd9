// SPDX-License-Identifier: BSD-3-Clause
//
// The include files with water and strobes for POV-Ray (plugin/include/), as texts: aphotic.inc,
// its macros; aphotic_quick.inc, its data for a quick look without aphotic. They are written next
// to every set of scenes, where plain povray finds them.
#pragma once

#include <span>
#include <string_view>

namespace aphotic {

struct IncludeFile {
    std::string_view name;
    std::string_view text;
};

[[nodiscard]] std::span<const IncludeFile> include_library();

}  // namespace aphotic
