// SPDX-License-Identifier: BSD-3-Clause
#include "validation/patch_file.h"

#include "base/csv.h"
#include "base/error.h"
#include "base/nearest.h"
#include "base/number.h"
#include "base/printable.h"
#include "spectral/colour_chart.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace aphotic {
namespace {

constexpr std::array<std::string_view, 6> kPatchColumns{"patch", "x", "y", "w", "h", "reference"};
constexpr std::size_t kNeededPatchColumns = 5;  // of these

// The column of each of kPatchColumns in a line; beyond its end: absent.
using PatchLayout = std::array<std::size_t, kPatchColumns.size()>;

PatchLayout layout_of(const std::string& name,
                      std::size_t line,
                      const std::vector<std::string_view>& columns) {
    PatchLayout layout{};
    for (std::size_t i = 0; i < kPatchColumns.size(); ++i) {
        const auto found = std::ranges::find(columns, kPatchColumns[i]);
        layout[i] = static_cast<std::size_t>(found - columns.begin());
        if (std::ranges::count(columns, kPatchColumns[i]) > 1)
            fail_at_line(name, line, "duplicate column '{}'", kPatchColumns[i]);
        if (i >= kNeededPatchColumns || found != columns.end()) continue;
        fail_at_line(name,
                     line,
                     "found the columns {}; allowed: patch, x, y, w, h and reference",
                     fmt::join(columns, ", "));
    }
    return layout;
}

std::vector<double> numbers_in(std::string_view text) {
    std::vector<double> numbers;
    while (!(text = trimmed(text)).empty()) {
        const std::size_t end = std::min(text.find_first_of(kBlanks), text.size());
        const auto number = read_number<double>(text.substr(0, end));
        if (!number || !std::isfinite(*number)) return {};
        numbers.push_back(*number);
        text.remove_prefix(end);
    }
    return numbers;
}

// Parses the reference. False if it is not recognised.
bool take_reference(Patch& patch) {
    constexpr double kMostLightness = 100.0;
    constexpr double kMostChroma = 200.0;
    const std::string& text = patch.reference;
    if (text.empty()) return true;
    if (text == "grey" || text == "gray") return patch.is_grey = true;
    if (const std::vector<double> numbers = numbers_in(text); !numbers.empty()) {
        if (numbers.size() == 1 && numbers[0] > 0.0 && numbers[0] <= 1.0) {
            patch.lab = Lab{.L = lightness_of(numbers[0])};
            return patch.is_grey = true;
        }
        if (numbers.size() != 3 || numbers[0] < 0.0 || numbers[0] > kMostLightness ||
            std::abs(numbers[1]) > kMostChroma || std::abs(numbers[2]) > kMostChroma)
            return false;
        patch.lab = Lab{.L = numbers[0], .a = numbers[1], .b = numbers[2]};
        patch.is_grey = numbers[1] == 0.0 && numbers[2] == 0.0;
        return true;
    }
    const auto found = std::ranges::find(kChartPatches, text, &ChartPatch::name);
    if (found == kChartPatches.end()) return false;
    patch.lab = found->lab;
    patch.is_grey = found - kChartPatches.begin() >= static_cast<std::ptrdiff_t>(kFirstGreyPatch);
    return true;
}

[[noreturn]] void fail_at_reference(const std::string& name, const Patch& patch) {
    std::vector<std::string> known{"grey"};
    for (const ChartPatch& one : kChartPatches) known.emplace_back(one.name);
    const std::string near = nearest_name(patch.reference, known);
    fail_at_line(
        name,
        patch.line,
        "reference: found '{}'{}; allowed: grey, a reflectance up to 1, L a b, or a chart's "
        "patch such as light-skin",
        excerpt(patch.reference),
        near.empty() ? "" : fmt::format(" (is it '{}'?)", near));
}

Patch patch_in(const std::string& name,
               std::size_t line,
               const PatchLayout& layout,
               const std::vector<std::string_view>& fields) {
    const auto field = [&](std::size_t column) {
        return layout[column] < fields.size() ? fields[layout[column]] : std::string_view();
    };
    Patch patch{.name = std::string(field(0)), .line = line};
    if (patch.name.empty()) fail_at_line(name, line, "patch: found no name; allowed: any name");
    constexpr int kMost_px = 1 << 20;
    const std::array<int*, 4> sizes{&patch.x_px, &patch.y_px, &patch.width_px, &patch.height_px};
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        const int least = i < 2 ? 0 : 1;
        const auto pixels = read_number<int>(field(1 + i));
        if (!pixels || *pixels < least || *pixels > kMost_px) {
            fail_at_line(name,
                         line,
                         "{}: found '{}'; allowed: whole pixels, {} or more",
                         kPatchColumns[1 + i],
                         excerpt(field(1 + i)),
                         least);
        }
        *sizes[i] = *pixels;
    }
    patch.reference = std::string(field(kNeededPatchColumns));
    if (!take_reference(patch)) fail_at_reference(name, patch);
    return patch;
}

}  // namespace

std::vector<Patch> parse_patches(const std::string& name, std::string_view text) {
    std::vector<Patch> patches;
    std::optional<PatchLayout> layout;
    const std::size_t lines = for_each_line(text, [&](std::size_t line, std::string_view words) {
        const std::string_view content = trimmed(words);
        if (content.empty() || content.front() == '#') return;
        const std::vector<std::string_view> fields = comma_fields(content);
        if (layout)
            patches.push_back(patch_in(name, line, *layout, fields));
        else
            layout = layout_of(name, line, fields);
    });
    if (patches.empty()) fail_at_line(name, lines + 1, "the file ends without a patch");
    return patches;
}

}  // namespace aphotic
