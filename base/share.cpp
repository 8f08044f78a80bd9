// SPDX-License-Identifier: BSD-3-Clause
#include "base/share.h"

#include "base/error.h"
#include "base/number.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <regex>
#include <system_error>

namespace aphotic {

namespace fs = std::filesystem;

WorkShare parse_share(std::string_view text) {
    const std::size_t slash = std::min(text.find('/'), text.size());
    const auto number = read_number<std::size_t>(text.substr(0, slash));
    const auto of = read_number<std::size_t>(text.substr(std::min(slash + 1, text.size())));
    if (number && of && *number >= 1 && *number <= *of && *of <= kMostShares) return {*number, *of};
    throw InputError("found {}; allowed: I/N, such as 2/4, with I from 1 to N and N up to {}",
                     text,
                     kMostShares);
}

fs::path share_folder(const fs::path& folder, WorkShare share) {
    return share.is_whole() ? folder
                            : folder / fmt::format("share-{}-of-{}", share.number, share.of);
}

std::vector<fs::path> share_folders(const fs::path& folder) {
    static const std::regex kName(R"(share-\d+-of-\d+)");
    std::vector<fs::path> found;
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
        if (entry.is_directory() && std::regex_match(entry.path().filename().string(), kName))
            found.push_back(entry.path());
    }
    std::ranges::sort(found);
    return found;
}

void remove_joined(const fs::path& share, const std::vector<fs::path>& files) {
    std::error_code ignored;
    for (const fs::path& file : files) fs::remove(share / file, ignored);
    std::vector<fs::path> folders{share};
    for (const auto& entry : fs::recursive_directory_iterator(share)) {
        if (entry.is_directory()) folders.push_back(entry.path());
    }
    // Those within before those around.
    std::ranges::sort(folders, std::greater());
    for (const fs::path& folder : folders) fs::remove(folder, ignored);
}

}  // namespace aphotic
