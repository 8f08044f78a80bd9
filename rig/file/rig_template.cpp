// SPDX-License-Identifier: BSD-3-Clause
#include "rig/file/rig_template.h"

#include "base/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

namespace aphotic {
namespace {

struct Template {
    std::string_view name;
    std::string_view rig;  // of template_files()
    std::vector<std::string_view> files;
};

const std::array<Template, 3>& templates() {
    static const std::array<Template, 3> kTemplates{
        {{.name = "habcam", .rig = "habcam.toml", .files = {}},
         {.name = "led", .rig = "habcam-led.toml", .files = {}},
         {.name = "auv", .rig = "auv.toml", .files = {"auv-lamp.ies", "auv-camera.yml"}}}};
    return kTemplates;
}

constexpr std::string_view kHeading = "# From `aphotic init --like ";
constexpr std::string_view kMark = "# measure:";

const BuiltinTable& file_named(std::string_view name) {
    return *std::ranges::find(template_files(), name, &BuiltinTable::name);
}

const Template& template_named(std::string_view name) {
    return *std::ranges::find(templates(), name, &Template::name);
}

// Without the scene's own heading, which describes the example.
std::string_view without_heading(std::string_view text) {
    return text.substr(text.find("\n\n") + 1);
}

// The text before the mark, without spaces; empty without a mark.
std::string marked_value(std::string_view line) {
    const std::size_t mark = line.find(kMark);
    std::string value(mark == std::string_view::npos ? "" : line.substr(0, mark));
    std::erase(value, ' ');
    return value;
}

std::set<std::string> marked_values(std::string_view text) {
    std::set<std::string> values;
    while (!text.empty()) values.insert(marked_value(next_line(text)));
    return values;
}

}  // namespace

std::vector<std::string> template_names() {
    std::vector<std::string> names;
    for (const Template& one : templates()) names.emplace_back(one.name);
    return names;
}

RigTemplate rig_template(std::string_view name) {
    const Template& chosen = template_named(name);
    RigTemplate made{
        .rig = fmt::format(
            "{}{}`: a template to change. A line marked `measure` holds a guess.\n"
            "# Measure it on your sled, then delete the mark: `aphotic plan` lists those "
            "that are left.\n{}",
            kHeading,
            name,
            without_heading(file_named(chosen.rig).csv)),
        .files = {}};
    for (const std::string_view file : chosen.files) made.files.push_back(file_named(file));
    return made;
}

std::vector<UnmeasuredLine> unmeasured_lines(std::string_view rig) {
    // A fitted rig has a line of its own before it.
    const std::size_t heading = rig.find(kHeading);
    if (heading == std::string_view::npos) return {};
    const std::size_t at = heading + kHeading.size();
    const std::string_view name = rig.substr(at, rig.find('`', at) - at);
    if (std::ranges::find(templates(), name, &Template::name) == templates().end()) return {};
    const std::set<std::string> guesses = marked_values(file_named(template_named(name).rig).csv);
    std::vector<UnmeasuredLine> unmeasured;
    for (int number = 1; !rig.empty(); ++number) {
        const std::string_view line = next_line(rig);
        const std::string value = marked_value(line);
        if (value.empty() || !guesses.contains(value)) continue;
        const std::string_view text = line.substr(0, line.find(kMark));
        unmeasured.push_back({.line = number, .text = std::string(trimmed(text))});
    }
    return unmeasured;
}

}  // namespace aphotic
