// SPDX-License-Identifier: BSD-3-Clause
//
// A scene's text through real POV-Ray, with the include library beside it, as a user runs it: the
// stock settings, no command of ours.
#pragma once

#include "base/atomic_file.h"
#include "image/exr.h"
#include "plugin/povray.h"
#include "plugin/povray_log.h"
#include "plugin/process.h"
#include "scene_gen/band_sdl.h"
#include "scene_gen/include_library.h"
#include "support/temp_folder.h"

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

struct PovRayRun {
    ProcessEnd end;
    std::string log;
    int width_px = 0;
    std::vector<float> samples;  // planes R, G, B; empty when it failed

    // What it said behind its banner, less its own headings. Not sorted by stage: about one in a
    // hundred messages overtakes the heading of its stage when the machine is busy.
    [[nodiscard]] std::string said() const {
        std::string all;
        bool is_banner = true;
        for (const std::string& statement : statements_in_log(log)) {
            if (statement.starts_with("Support libraries used by POV-Ray")) is_banner = false;
            if (is_banner || statement.empty() || is_heading(statement)) continue;
            all += statement + "\n";
        }
        return all;
    }
    static bool is_heading(std::string_view statement) {
        return statement.starts_with("Support libraries") || statement.starts_with("  ") ||
               statement.starts_with("==== [") || statement == "POV-Ray finished";
    }
    [[nodiscard]] double at(std::size_t channel, int column, int row) const {
        const auto pixels = samples.size() / 3;
        return samples.at(channel * pixels + static_cast<std::size_t>(row * width_px + column));
    }
};

inline PovRayRun run_povray(const std::filesystem::path& folder,
                            const std::string& sdl,
                            int width_px = 8,
                            int height_px = 8,
                            const std::vector<std::string>& settings = {}) {
    constexpr double kTimeoutS = 120.0;
    for (const IncludeFile& file : include_library()) {
        write_file(folder / file.name, file.text);
    }
    write_file(folder / "scene.pov", sdl);
    const std::filesystem::path image = folder / "scene.exr";
    std::filesystem::remove(image);
    PovRayRun run;
    std::vector<std::string> arguments{"+Iscene.pov",
                                       "+Oscene.exr",
                                       "+FE",
                                       "-D",
                                       "-A",
                                       "-V",
                                       "-GR",
                                       "-GS",
                                       fmt::format("+W{}", width_px),
                                       fmt::format("+H{}", height_px)};
    arguments.insert(arguments.end(), settings.begin(), settings.end());
    run.end = run_process({.executable = find_povray("").executable,
                           .arguments = arguments,
                           .folder = folder,
                           .environment = {},
                           .log = folder / "scene.log"},
                          kTimeoutS);
    run.log = read_text_file(folder / "scene.log");
    run.width_px = width_px;
    if (!run.end.succeeded()) return run;
    run.samples.resize(3 * static_cast<std::size_t>(width_px) *
                       static_cast<std::size_t>(height_px));
    const std::vector<std::string> channels{"R", "G", "B"};
    ExrReader(image).read_rows(0, height_px, channels, run.samples);
    return run;
}

// Of three wavelengths, numbers without any likeness: what a frame would declare.
inline Band odd_band() {
    const auto line = [](const std::string& name, double first, double last) {
        return Spectrum(name, {400.0, 700.0}, {first, last});
    };
    return {.lambda_nm = {450.0, 550.0, 650.0},
            .exposure = {64.0, 128.0, 256.0},
            .attenuation_per_m = {0.05, 0.11, 0.37},
            .water_index = 1.34,
            .glasses = {{.name = "bk7", .index = 1.52}},
            .lamps = {{.name = "flash", .spectrum = line("flash", 0.9, 0.7)},
                      {.name = "arc", .spectrum = line("arc", 0.2, 0.5)}},
            .reflectances = {{.name = "light", .spectrum = line("light", 0.9, 0.6)},
                             {.name = "dark", .spectrum = line("dark", 0.1, 0.3)}}};
}

// The scene in that band, beginning with the include.
inline std::string in_band(const Band& band, const std::string& scene) {
    return "#version 3.7;\n" + band_sdl(band) + "#include \"aphotic.inc\"\n" + scene;
}

}  // namespace aphotic
