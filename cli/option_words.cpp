// SPDX-License-Identifier: BSD-3-Clause
#include "cli/option_words.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>
#include <system_error>

namespace aphotic::cli {

namespace fs = std::filesystem;

namespace {

const toml::table& all_words() {
    static const toml::table kWords = toml::parse(command_text("options.toml"));
    return kWords;
}

// The command's own words, else the common ones.
const toml::table& words_of(const CLI::App& command, const std::string& name) {
    for (const std::string& place : {command.get_name(), std::string("shared")}) {
        const toml::node* of_place = all_words().get(place);
        const toml::node* words = of_place != nullptr ? of_place->as_table()->get(name) : nullptr;
        if (words != nullptr) return *words->as_table();
    }
    throw std::logic_error(fmt::format("{} {}: not in options.toml", command.get_name(), name));
}

constexpr std::array kWritten{"output", "preview", "report", "plot", "quick-look"};

bool is_written(const CLI::Option& option) {
    if (option.get_items_expected_max() == 0) return false;  // a flag has no value
    return std::ranges::any_of(kWritten,
                               [&](const char* name) { return option.check_lname(name); });
}

// The file itself, or anything below a folder.
bool takes_place_of(const fs::path& file, const fs::path& named) {
    std::error_code ignored;
    if (fs::equivalent(file, named, ignored)) return true;
    if (!fs::is_directory(named, ignored)) return false;
    const std::string inner = fs::canonical(file, ignored).string();
    const std::string outer = (fs::canonical(named, ignored) / "").string();
    return inner.starts_with(outer);
}

// The parser itself reports values that are not numbers.
std::optional<double> number_in(const std::string& text) {
    double number = 0.0;
    return CLI::detail::lexical_cast(text, number) ? std::optional(number) : std::nullopt;
}

CLI::Validator number_that(std::function<bool(double)> is_allowed, const std::string& allowed) {
    return CLI::Validator(
        [is_allowed, allowed](const std::string& text) {
            const std::optional<double> number = number_in(text);
            const bool is_good = !number || std::isnan(*number) || is_allowed(*number);
            return is_good ? "" : fmt::format("found {}; allowed: {}", text, allowed);
        },
        allowed);
}

void refuse_nan(CLI::Option& option) {
    option.check(
        [](const std::string& text) -> std::string {
            const std::optional<double> number = number_in(text);
            return number && std::isnan(*number) ? "found nan; allowed: a number" : "";
        },
        "");
}

void require_extension(CLI::Option& option, const std::string& extension) {
    option.check(
        [extension](const std::string& text) {
            return fs::path(text).extension() == extension
                       ? ""
                       : fmt::format("found {}; allowed: a name that ends in {}", text, extension);
        },
        "");
}

// "" comes from a script's unset variable: it cannot mean a folder, least of all the current one.
void refuse_no_name(CLI::Option& option) {
    option.check(
        [](const std::string& text) {
            return text.empty() ? "found an empty string; allowed: a name" : "";
        },
        "");
}

}  // namespace

std::string_view command_text(std::string_view file) {
    return std::ranges::find(command_texts(), file, &CommandText::name)->text;
}

void describe(CLI::App& command) {
    const toml::table& words = *all_words().get(command.get_name())->as_table();
    command.description(words["summary"].value_or(std::string()));
    command.group(words["under"].value_or(std::string()));
    if (const auto footer = words["footer"].value<std::string>()) command.footer(*footer);
}

std::string what_is_kept(const CLI::App& command) {
    const auto keeps = all_words()[command.get_name()]["keeps"].value<std::string>();
    return keeps ? *keeps + " are kept: run the same command again to continue"
                 : "run the same command again to start afresh";
}

std::string spellings_of(const CLI::App& command, const std::string& name) {
    return words_of(command, name)["names"].value_or(name);
}

CLI::Option* described(const CLI::App& command, const std::string& name, CLI::Option* option) {
    const toml::table& words = words_of(command, name);
    option->description(words["words"].value_or(std::string()));
    if (const auto takes = words["takes"].value<std::string>()) option->option_text(*takes);
    if (const auto type = words["type"].value<std::string>()) option->type_name(*type);
    if (const auto usual = words["usual"].value<std::string>()) option->default_str(*usual);
    if (words["usual"].value_or(false)) option->capture_default_str();
    return option;
}

CLI::Validator in_range(double least, double most) {
    return number_that([=](double number) { return number >= least && number <= most; },
                       fmt::format("{} to {}", least, most));
}

CLI::Validator positive() {
    return number_that([](double number) { return number > 0.0 && std::isfinite(number); },
                       "more than 0");
}

CLI::Validator not_negative() {
    return number_that([](double number) { return number >= 0.0 && std::isfinite(number); },
                       "0 or more");
}

void add_common_checks(CLI::App& command) {
    for (CLI::Option* option : command.get_options()) {
        const std::string type = option->get_type_name();
        if (type.find("FLOAT") != std::string::npos) refuse_nan(*option);
        if (is_written(*option) || option->get_positional()) refuse_no_name(*option);
        for (const char* extension : {".exr", ".svg"}) {
            if (is_written(*option) && type.ends_with(extension))
                require_extension(*option, extension);
        }
    }
}

std::vector<fs::path> written_places(const CLI::App& command) {
    std::vector<fs::path> places;
    for (const CLI::Option* option : command.get_options()) {
        if (is_written(*option) && option->count() > 0) {
            places.emplace_back(option->results().front());
        }
    }
    return places;
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
                throw InputError("{}: found {}, which {} also names; allowed: a different file",
                                 written->get_name(),
                                 file.string(),
                                 other->get_name());
            }
        }
    }
}

}  // namespace aphotic::cli
