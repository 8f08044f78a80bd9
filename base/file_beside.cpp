// SPDX-License-Identifier: BSD-3-Clause
#include "base/file_beside.h"

#include "base/error.h"

#include <system_error>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

bool leads_out(const fs::path& relative) {
    return relative.empty() || relative.is_absolute() || *relative.begin() == "..";
}

// The path after all its links have been followed.
fs::path end_of(const fs::path& path) {
    std::error_code error;
    fs::path end = fs::canonical(path, error);
    if (!error) return end;
    const bool dangles = error == std::errc::no_such_file_or_directory && fs::is_symlink(path);
    throw InputError(
        "{}: cannot be read: {}", path.string(), dangles ? "it is a broken link" : error.message());
}

}  // namespace

fs::path file_beside(const fs::path& folder, const std::string& name) {
    fs::path path = folder / name;
    constexpr std::string_view kAllowed = "a file in the same folder or below it";
    // Checks the text of the path first, so that no path outside is accessed.
    if (leads_out(fs::path(name).lexically_normal())) {
        throw InputError("found '{}'; allowed: {}", name, kAllowed);
    }
    const fs::path end = end_of(path);
    if (leads_out(end.lexically_relative(end_of(folder.empty() ? "." : folder)))) {
        throw InputError("{}: found a link that leads to {}; allowed: {}",
                         path.string(),
                         end.string(),
                         kAllowed);
    }
    if (!fs::is_regular_file(end)) {
        throw InputError("{}: cannot be read: it is {}; allowed: {}",
                         path.string(),
                         fs::is_directory(end) ? "a folder" : "a pipe, a device or a socket",
                         kAllowed);
    }
    return path;
}

}  // namespace aphotic
