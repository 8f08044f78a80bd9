// SPDX-License-Identifier: BSD-3-Clause
#include "cli/option_checks.h"

#include "spectral/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

namespace aphotic::cli {

namespace fs = std::filesystem;

namespace {

constexpr std::array kWritten{"output", "preview", "report", "plot", "quick-look"};

bool is_written(const CLI::Option& option) {
    return std::ranges::any_of(kWritten,
                               [&](const char* name) { return option.check_lname(name); });
}

// The file itself, or what stands below a folder.
bool takes_place_of(const fs::path& file, const fs::path& named) {
    std::error_code ignored;
    if (fs::equivalent(file, named, ignored)) return true;
    if (!fs::is_directory(named, ignored)) return false;
    const std::string inner = fs::canonical(file, ignored).string();
    const std::string outer = (fs::canonical(named, ignored) / "").string();
    return inner.starts_with(outer);
}

}  // namespace

void refuse_nan(CLI::App& command) {
    for (CLI::Option* option : command.get_options()) {
        if (option->get_type_name().find("FLOAT") == std::string::npos) continue;
        option->check(
            [](const std::string& text) -> std::string {
                char* end = nullptr;
                const double number = std::strtod(text.c_str(), &end);
                return end != text.c_str() && std::isnan(number) ? "found nan; allowed: a number"
                                                                 : "";
            },
            "");
    }
}

void require_separate_files(const CLI::App& command) {
    for (const CLI::Option* written : command.get_options()) {
        if (!is_written(*written) || written->count() == 0) continue;
        const fs::path file = written->results().front();
        for (const CLI::Option* other : command.get_options()) {
            if (other == written) continue;
            for (const std::string& named : other->results()) {
                const bool is_same = is_written(*other) && fs::path(named) == file;
                const bool takes =
                    !is_written(*other) && fs::is_regular_file(file) && takes_place_of(file, named);
                if (!is_same && !takes) continue;
                throw InputError(
                    fmt::format("{}: found {}, which {} names too; allowed: a file of its own",
                                written->get_name(),
                                file.string(),
                                other->get_name()));
            }
        }
    }
}

}  // namespace aphotic::cli
