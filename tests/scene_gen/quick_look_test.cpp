// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/quick_look.h"

#include "rig/file/rig_reader.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

namespace aphotic::quick_look_test {
namespace {

namespace fs = std::filesystem;

// Spectra are called as they lie from the rig's folder, wherever that folder lies: under a long
// way, with letters that POV-Ray cannot hold.
TEST(QuickLook, IsTheSameWhereverTheSceneLies) {
    const TempFolder folder;
    const fs::path shipped = fs::path(APHOTIC_SOURCE_DIR) / "scenes" / "user" / "chart";
    const fs::path near = folder.path() / "chart";
    const fs::path far = folder.path() / std::string(100, 'x') / "it, \"too\" ä" / "chart";
    fs::create_directories(far.parent_path());
    for (const fs::path& home : {near, far}) fs::copy(shipped, home, fs::copy_options::recursive);

    const std::string sdl = quick_look_sdl(read_rig(near / "chart.toml"), near);
    EXPECT_EQ(quick_look_sdl(read_rig(far / "chart.toml"), far), sdl);
    EXPECT_NE(sdl.find("\"patches/01-dark-skin.csv\""), std::string::npos);
}

}  // namespace
}  // namespace aphotic::quick_look_test
