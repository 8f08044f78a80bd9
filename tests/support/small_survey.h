// SPDX-License-Identifier: BSD-3-Clause
//
// A simulated survey of small images, in a folder of its own: the rig and scene of scenes/survey
// with fewer pixels, and the program `survey` run on them.
#pragma once

#include "base/atomic_file.h"
#include "bench/survey/flight.h"
#include "plugin/process.h"
#include "support/temp_folder.h"

#include <fmt/format.h>

#include <filesystem>
#include <regex>
#include <string>
#include <vector>

namespace aphotic::survey {

class SmallSurvey {
  public:
    SmallSurvey() {
        namespace fs = std::filesystem;
        const fs::path scenes = fs::path(APHOTIC_SOURCE_DIR) / "scenes";
        fs::create_directories(folder() / "scenes/user");
        fs::copy(scenes / "survey", folder() / "scenes/survey");
        fs::copy(scenes / "user/reef", folder() / "scenes/user/reef");
        write_file(
            rig(),
            with(
                "pixel_pitch_um", "51.6", with("resolution", "[170, 128]", read_text_file(rig()))));
    }

    [[nodiscard]] const std::filesystem::path& folder() const { return temp_.path(); }
    [[nodiscard]] std::filesystem::path rig() const {
        return folder() / "scenes/survey/survey.toml";
    }

    // The rig over its own bare floor, where the sled was at an image.
    [[nodiscard]] std::filesystem::path rig_at(const Leg& leg) const {
        std::string text =
            with("altitude_m", fmt::format("{}", leg.altitude_m), read_text_file(rig()));
        text = with("pitch_deg", fmt::format("{}", leg.pitch_deg), text);
        text = with("roll_deg", fmt::format("{}", leg.roll_deg), text);
        const std::filesystem::path file = rig().parent_path() / (leg.name + ".toml");
        write_file(file, text);
        return file;
    }

    // Into folder()/output. Returns the exit status.
    [[nodiscard]] int make(std::vector<std::string> arguments,
                           const std::string& output = "out") const {
        constexpr double kTimeout_s = 280.0;
        arguments.insert(arguments.begin(), {"-o", output, "--rig", rig().string()});
        return run_process({.executable = APHOTIC_SURVEY,
                            .arguments = arguments,
                            .folder = folder(),
                            .environment = {},
                            .log = folder() / "log"},
                           kTimeout_s)
            .exit_code;
    }
    [[nodiscard]] std::string said() const { return read_text_file(folder() / "log"); }

  private:
    // A key's line with another value.
    static std::string with(const std::string& key,
                            const std::string& value,
                            const std::string& text) {
        return std::regex_replace(
            text, std::regex("\n" + key + " *= [^\n]*"), "\n" + key + " = " + value);
    }

    TempFolder temp_;
};

}  // namespace aphotic::survey
