// SPDX-License-Identifier: BSD-3-Clause
//
// A simulated survey of small images, in a folder of its own: the rig and scene of scenes/survey
// with fewer pixels, and `aphotic survey` run on them.
#pragma once

#include "base/atomic_file.h"
#include "base/degrees.h"
#include "support/run_command.h"
#include "support/scene_text.h"
#include "support/temp_folder.h"
#include "survey/simulate/flight.h"

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

namespace aphotic {

class SmallSurvey {
  public:
    SmallSurvey() {
        namespace fs = std::filesystem;
        fs::create_directories(folder() / "scenes/user");
        fs::copy(scene_file("survey"), folder() / "scenes/survey");
        fs::copy(scene_file("user/reef"), folder() / "scenes/user/reef");
        write_file(rig(),
                   with(read_text_file(rig()),
                        {{"resolution", "[170, 128]"}, {"pixel_pitch_um", "51.6"}}));
    }

    [[nodiscard]] const std::filesystem::path& folder() const { return temp_.path(); }
    [[nodiscard]] std::filesystem::path rig() const {
        return folder() / "scenes/survey/survey.toml";
    }

    // The rig over its own bare floor, where the sled was at an image.
    [[nodiscard]] std::filesystem::path rig_at(const Leg& leg) const {
        const std::filesystem::path file = rig().parent_path() / (leg.name + ".toml");
        write_file(file,
                   with(read_text_file(rig()),
                        {{"altitude_m", fmt::format("{}", leg.sled.altitude_m)},
                         {"pitch_deg", fmt::format("{}", leg.sled.pitch_rad * kDegreesPerRadian)},
                         {"roll_deg", fmt::format("{}", leg.sled.roll_rad * kDegreesPerRadian)}}));
        return file;
    }

    // Into folder()/output, by the plan of docs/background/accuracy.md.
    [[nodiscard]] CommandResult make(const Arguments& arguments,
                                     const std::string& output = "out") const {
        const std::string scene = (rig().parent_path() / "survey.pov").string();
        return run_aphotic(folder(),
                           Arguments{"survey", rig().string(), "-o", output, "--scene", scene} +
                               "--paths-m 2.4,7.7 --fitted 9" + arguments);
    }

  private:
    TempFolder temp_;
};

}  // namespace aphotic
