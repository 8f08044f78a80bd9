// SPDX-License-Identifier: BSD-3-Clause
//
// The include files through which POV-Ray learns of water and strobes (plugin/include/), as texts:
// aphotic.inc, its macros; aphotic_quick.inc, what it takes for a quick look without us. They are
// written beside every set of scenes, so that plain povray finds them there.
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
