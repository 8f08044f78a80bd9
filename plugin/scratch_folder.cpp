// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/scratch_folder.h"

#include "base/error.h"

#include <stdlib.h>  // mkdtemp

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

fs::path temporary_folder() {
    std::error_code error;
    fs::path folder = fs::temp_directory_path(error);
    if (!error) return folder;
    const char* variable = std::getenv("TMPDIR");
    throw RunError("TMPDIR: found {}; allowed: an existing folder, or nothing, for /tmp",
                   variable == nullptr ? "nothing, and no folder /tmp" : variable);
}

}  // namespace

ScratchFolder::ScratchFolder() {
    std::string pattern = (temporary_folder() / "aphotic-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) {
        throw RunError("{}: cannot create a temporary folder: {}", pattern, std::strerror(errno));
    }
    path_ = pattern;
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

}  // namespace aphotic
