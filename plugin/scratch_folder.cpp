// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/scratch_folder.h"

#include "spectral/error.h"

#include <fmt/format.h>
#include <stdlib.h>  // mkdtemp

#include <string>
#include <system_error>

namespace aphotic {

namespace fs = std::filesystem;

ScratchFolder::ScratchFolder() {
    std::string pattern = (fs::temp_directory_path() / "aphotic-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) {
        throw RunError(fmt::format("{}: no temporary folder can be made", pattern));
    }
    path_ = pattern;
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

}  // namespace aphotic
