// SPDX-License-Identifier: BSD-3-Clause
#include "cli/allowed_skips.h"

#include "base/words.h"

#include <fmt/format.h>

#include <charconv>
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
    double number = 0.0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (fault != std::errc() || end != text.data() + text.size()) return std::nullopt;
    const bool is_share = is_percent || number != std::floor(number);
    if (is_percent) number *= kPercent;
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
    fmt::print(stderr,
               "aphotic: {} of {} skipped; allowed: {} (--allow-skipped)\n",
               skipped,
               counted(images, "image"),
               most);
    return skipped <= most ? kDone : kAnswerIsNo;
}

}  // namespace aphotic::cli
