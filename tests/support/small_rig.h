// SPDX-License-Identifier: BSD-3-Clause
//
// A folder with HabCam of a few pixels, rig.toml, whose lamps are a table beside it.
#pragma once

#include "base/atomic_file.h"
#include "support/temp_folder.h"

#include <filesystem>
#include <regex>
#include <string>

namespace aphotic {

class SmallRig {
  public:
    SmallRig() {
        std::string text = read_text_file(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml");
        text = std::regex_replace(
            text, std::regex(R"(\n\s*resolution\s*=[^\n]*)"), "\nresolution = [16, 12]");
        text = std::regex_replace(
            text, std::regex(R"(spectrum\s*=\s*"xenon-flash")"), "spectrum = \"lamps/lamp.csv\"");
        std::filesystem::create_directories(folder() / "lamps");
        write_file(folder() / "lamps/lamp.csv",
                   "wavelength_nm,relative_power\n400,1\n500,1.5\n720,1\n");
        write_file(folder() / "rig.toml", text);
    }

    [[nodiscard]] const std::filesystem::path& folder() const { return temp_.path(); }

  private:
    TempFolder temp_;
};

}  // namespace aphotic
