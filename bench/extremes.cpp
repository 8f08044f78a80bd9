// SPDX-License-Identifier: BSD-3-Clause
//
// The table of extremes as Markdown, row by row: both renderers against long double
// (docs/background/accuracy.md).
//
//   extremes DIR [WIDTH]    for images WIDTH pixels wide, default 24; keeps rigs and images in DIR
#include "support/extremes.h"
#include "base/number.h"

#include <cstdio>
#include <cstdlib>

namespace aphotic::extremes {
namespace {

std::string row_text(const Extreme& row, const ExtremeFound& found) {
    const std::string outcome =
        is_as_expected(row, found) ? found.outcome : "**NOT AS EXPECTED:** " + found.outcome;
    if (!found.said.empty()) return fmt::format("| {} | | | | | | {} |\n", row.value, outcome);
    return fmt::format("| {} | {:.2e} | {:.1e} | {:.1e} of {:.1e} | {:.1e} | {:.1e} | {} |\n",
                       row.value,
                       found.peak,
                       found.povray_radiance,
                       found.povray_signal,
                       found.promise,
                       found.traced_radiance,
                       found.traced_signal,
                       outcome);
}

int print_table(const std::filesystem::path& folder, int width_px) {
    std::string what;
    bool all_as_expected = true;
    for (const Extreme& row : all_extremes(width_px)) {
        if (row.what != what) {
            what = row.what;
            fmt::print(
                "\n### {}: {}\n\n| value | peak radiance | POV-Ray: radiance | signals, of "
                "promised | tracer: radiance | signals | what happens "
                "|\n|---|---|---|---|---|---|---|\n",
                row.group,
                what);
        }
        const ExtremeFound found = measure(row, folder / row.name, render_by_povray);
        all_as_expected &= is_as_expected(row, found);
        fmt::print("{}", row_text(row, found));
        std::fflush(stdout);
    }
    return all_as_expected ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace
}  // namespace aphotic::extremes

int main(int argc, char** argv) {
    constexpr int kWidth_px = 24;
    const auto width_px = argc > 2 ? aphotic::read_number<int>(argv[2]) : kWidth_px;
    if (argc < 2 || !width_px || *width_px < 1) {
        fmt::print(stderr, "usage: extremes DIR [WIDTH], a width of 1 pixel or more\n");
        return EXIT_FAILURE;
    }
    return aphotic::extremes::print_table(argv[1], *width_px);
}
