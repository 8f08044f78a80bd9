// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/full_disk.h"

#include <fmt/format.h>

#include <cstdint>
#include <system_error>

namespace aphotic {

namespace fs = std::filesystem;

std::string words_of_full_disk(const fs::path& folder) {
    constexpr std::uintmax_t kLittle = std::uintmax_t{64} << 10U;
    std::error_code error;
    const std::uintmax_t left = fs::space(folder, error).available;
    if (error || left > kLittle) return "";
    return fmt::format("\n{}: {}: {} KiB are left",
                       folder.string(),
                       std::make_error_code(std::errc::no_space_on_device).message(),
                       left >> 10U);
}

}  // namespace aphotic
