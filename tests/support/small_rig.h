// SPDX-License-Identifier: BSD-3-Clause
//
// Tests of the command in a folder with HabCam of a few pixels, rig.toml, whose lamps are a table
// beside it.
#pragma once

#include "support/command_test.h"
#include "support/scene_text.h"

#include <filesystem>

namespace aphotic {

class SmallRigTest : public CommandTest {
  protected:
    SmallRigTest() {
        std::filesystem::create_directories(path("lamps"));
        write_file(path("lamps/lamp.csv"), "wavelength_nm,relative_power\n400,1\n500,1.5\n720,1\n");
        write_file(path("rig.toml"),
                   with(scene_text("habcam.toml"),
                        {{"resolution", "[16, 12]"}, {"spectrum", "\"lamps/lamp.csv\""}}));
    }
};

}  // namespace aphotic
