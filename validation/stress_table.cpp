// SPDX-License-Identifier: BSD-3-Clause
#include "base/atomic_file.h"
#include "base/json_text.h"
#include "validation/stress.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <regex>

namespace aphotic {

namespace {

using Json = nlohmann::ordered_json;

std::string error_words(double e) {
    if (e == 0.0) return "0";
    return std::isfinite(e) ? fmt::format("{:.1e}", e) : "not finite";
}

// A message's first line, without the folder in which this run happened to write.
std::string reason(const StressFound& found) {
    std::string said = found.said.substr(0, found.said.find('\n'));
    for (std::size_t at = said.find(found.asked.name); at != std::string::npos;
         at = said.find(found.asked.name)) {
        const std::size_t start = said.rfind(' ', at) + 1;  // npos + 1: the beginning
        said.erase(start, at + found.asked.name.size() + 1 - start);
    }
    // Nor the boot and the process, which a file's name has while it is written.
    said = std::regex_replace(said, std::regex(R"(\.[0-9a-f]{8}-[0-9a-f]+-[0-9]+\.part)"), ".part");
    std::string escaped;
    for (const char c : said) {
        if (c == '|') escaped += '\\';
        escaped += c;
    }
    return escaped;
}

std::string row(const StressFound& found) {
    const std::string answer = fmt::format(
        "{}{}", found.as_expected() ? "" : "**NOT AS EXPECTED:** ", answer_word(found.answer));
    if (found.answer == StressAnswer::Refused) {
        return fmt::format(
            "| {} | | | | | | {}: `{}` |\n", found.asked.value, answer, reason(found));
    }
    return fmt::format("| {} | {} | {} | {} of {} | {} | {} | {} |\n",
                       found.asked.value,
                       found.peak == 0.0 ? "0" : fmt::format("{:.2e}", found.peak),
                       error_words(found.povray_radiance),
                       error_words(found.povray_signal),
                       error_words(found.promise),
                       error_words(found.traced_radiance),
                       error_words(found.traced_signal),
                       answer);
}

std::string markdown(std::span<const StressFound> found) {
    std::string text =
        "# Extremes, case by case\n\nWritten by `aphotic stress`; docs/stress.md explains the "
        "columns.\n";
    std::string group;
    std::string extreme;
    for (const StressFound& one : found) {
        if (one.asked.group != group) {
            group = one.asked.group;
            text += fmt::format(
                "\n## {}{}\n", static_cast<char>(std::toupper(group.front())), group.substr(1));
        }
        if (one.asked.extreme != extreme) {
            extreme = one.asked.extreme;
            text += fmt::format(
                "\n### {}{}\n\n"
                "| value | peak radiance | POV-Ray: radiance | signals, of promised | tracer: "
                "radiance | signals | what happens |\n|---|---|---|---|---|---|---|\n",
                static_cast<char>(std::toupper(extreme.front())),
                extreme.substr(1));
        }
        text += row(one);
    }
    return text;
}

Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json();
}

Json json_of(const StressFound& found) {
    return {{"group", found.asked.group},
            {"extreme", found.asked.extreme},
            {"value", found.asked.value},
            {"folder", found.asked.name},
            {"expected", answer_word(found.asked.expected)},
            {"found", answer_word(found.answer)},
            {"as_expected", found.as_expected()},
            {"peak_radiance", number(found.peak)},
            {"povray_radiance_error", number(found.povray_radiance)},
            {"povray_signal_error", number(found.povray_signal)},
            {"promise", number(found.promise)},
            {"traced_radiance_error", number(found.traced_radiance)},
            {"traced_signal_error", number(found.traced_signal)},
            {"pixels_on_edges", found.on_edges},
            {"message", found.said}};
}

}  // namespace

std::string stress_json(std::span<const StressFound> found) {
    Json all = Json::array();
    for (const StressFound& one : found) all.push_back(json_of(one));
    return json_text(all);
}

void write_stress(std::span<const StressFound> found, const std::filesystem::path& folder) {
    write_text_file(folder / "stress.json", stress_json(found));
    write_text_file(folder / "stress.md", markdown(found));
}

}  // namespace aphotic
