// SPDX-License-Identifier: BSD-3-Clause
#include "cli/allowed_skips.h"

#include "base/number.h"
#include "base/words.h"
#include "cli/terminal.h"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <system_error>

namespace aphotic::cli {

std::size_t AllowedSkips::of(std::size_t images) const {
    // 0.07 of 100 are 7, which their product in doubles misses by its rounding.
    constexpr double kRounding = 1e-9;
    const double number_of =
        is_share ? number * static_cast<double>(images) * (1.0 + kRounding) : number;
    return static_cast<std::size_t>(number_of);
}

std::optional<AllowedSkips> allowed_skips_in(std::string_view text) {
    constexpr double kPercent = 0.01;
    constexpr double kMostImages = 1e9;
    const bool is_percent = text.ends_with('%');
    if (is_percent) text.remove_suffix(1);
    const auto read = read_number<double>(text);
    if (!read) return std::nullopt;
    const bool is_share = is_percent || *read != std::floor(*read);
    const double number = is_percent ? kPercent * *read : *read;
    const bool is_allowed = number >= 0.0 && number <= (is_share ? 1.0 : kMostImages);
    return is_allowed ? std::optional(AllowedSkips{number, is_share}) : std::nullopt;
}

void add_allow_skipped(CLI::App& app, AllowedSkips& allowed) {
    const auto wrong = [](const std::string& text) {
        return allowed_skips_in(text)
                   ? ""
                   : fmt::format(
                         "found {}; allowed: a number of images, or a share such as 0.01 or 1%",
                         text);
    };
    app.add_option_function<std::string>(
           "--allow-skipped",
           [&allowed](const std::string& text) { allowed = *allowed_skips_in(text); },
           "End with 0 when no more images are skipped than this: a number, or a share of all "
           "such as 0.01 or 1%")
        ->check(CLI::Validator(wrong, "N|SHARE"))
        ->default_str("0");
}

ExitStatus status_of_skips(std::size_t skipped, std::size_t images, const AllowedSkips& allowed) {
    if (skipped == 0) return kDone;
    const std::size_t most = allowed.of(images);
    warn(
        "{} of {} skipped; allowed: {} (--allow-skipped)", skipped, counted(images, "image"), most);
    return skipped <= most ? kDone : kAnswerIsNo;
}

}  // namespace aphotic::cli
