// SPDX-License-Identifier: BSD-3-Clause
//
// A folder with HabCam of a few pixels, rig.toml, whose lamps are a table beside it, and sweeps of
// it.
#pragma once

#include "base/atomic_file.h"
#include "support/temp_folder.h"

#include <filesystem>
#include <regex>
#include <string>

namespace aphotic {

class SmallSweep {
  public:
    SmallSweep() {
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

    std::filesystem::path write(const std::string& command, const std::string& more) const {
        const std::filesystem::path file = folder() / "sweep.toml";
        write_file(file, "command = \"" + command + "\"\nrig = \"rig.toml\"\n" + more);
        return file;
    }

  private:
    TempFolder temp_;
};

inline constexpr const char* kThreeWaters =
    "[[vary]]\nkey = \"water.multiple\"\nvalues = [0.5, 1, 2]\n";

}  // namespace aphotic
