// SPDX-License-Identifier: BSD-3-Clause
#include "base/disk_space.h"

#include "base/error.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <system_error>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

fs::path nearest_existing(const fs::path& folder) {
    fs::path there = fs::absolute(folder);
    std::error_code ignored;
    while (!fs::exists(there, ignored) && there != there.parent_path()) {
        there = there.parent_path();
    }
    return there;
}

}  // namespace

std::uint64_t free_disk_bytes(const fs::path& folder) {
    std::error_code error;
    const fs::space_info space = fs::space(nearest_existing(folder), error);
    if (error) {
        throw RunError("{}: free space cannot be read: {}", folder.string(), error.message());
    }
    return space.available;
}

bool on_one_disk(const fs::path& a, const fs::path& b) {
    struct stat of_a {};
    struct stat of_b {};
    return ::stat(nearest_existing(a).c_str(), &of_a) == 0 &&
           ::stat(nearest_existing(b).c_str(), &of_b) == 0 && of_a.st_dev == of_b.st_dev;
}

std::string words_of_full_disk(const fs::path& folder) {
    constexpr std::uintmax_t kLittle = std::uintmax_t{64} << 10U;
    std::error_code error;
    const std::uintmax_t left = fs::space(folder, error).available;
    if (error || left > kLittle) return "";
    return fmt::format("\n{}: {}: {} KiB left",
                       folder.string(),
                       std::make_error_code(std::errc::no_space_on_device).message(),
                       left >> 10U);
}

}  // namespace aphotic
