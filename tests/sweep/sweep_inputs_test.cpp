// SPDX-License-Identifier: BSD-3-Clause
#include "sweep/sweep_inputs.h"

#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <chrono>

namespace aphotic::sweep_inputs_test {
namespace {

namespace fs = std::filesystem;

class SweepInputsTest : public testing::Test {
  protected:
    SweepInputsTest() {
        for (const char* folder : {"dive", "parts", "out/point-0001"})
            fs::create_directories(home() / folder);
        write_file(home() / "dive/1.tif", "one");
        write_file(home() / "dive/notes.txt", "none of the images");
        write_file(home() / "nav.csv", "there");
        write_file(home() / "my.pov",
                   "#version 3.7;\n#include \"sled.inc\"\n#include \"math.inc\"\n");
        write_file(home() / "sled.inc", "# include \"parts/lamp.inc\"\n#include \"my.pov\"\n");
        write_file(home() / "lamp.inc", "no part of it");
        write_file(home() / "parts/lamp.inc", "#include \"glass.inc\"\n");
        write_file(home() / "glass.inc", "sphere { 0, 1 }");
    }

    [[nodiscard]] const fs::path& home() const { return folder_.path(); }
    [[nodiscard]] std::string state() const {
        return state_of({.home = home(),
                         .images = {"dive", "not-yet"},
                         .arguments = {"--nav", "nav.csv", "--bayer", "RGGB"},
                         .scene = home() / "my.pov",
                         .folder = home() / "out"});
    }

  private:
    TempFolder folder_;
};

// As a file that is made again within one tick of the clock would not.
void make_older(const fs::path& file) {
    fs::last_write_time(file, fs::last_write_time(file) - std::chrono::seconds(1));
}

TEST_F(SweepInputsTest, AreTheSameUntilOneOfThemChanges) {
    std::string before = state();
    EXPECT_EQ(state(), before);
    const auto expect_changed = [&](const char* what) {
        const std::string after = state();
        EXPECT_NE(after, before) << what;
        before = after;
    };
    make_older(home() / "dive/1.tif");
    expect_changed("an image's time");
    write_file(home() / "dive/2.tif", "two");
    expect_changed("another image");
    make_older(home() / "nav.csv");
    expect_changed("the navigation's time");
    write_file(home() / "my.pov", "#include \"sled.inc\"\n");
    expect_changed("the scene");
    write_file(home() / "glass.inc", "box { 0, 1 }");
    expect_changed("what an include includes");
}

TEST_F(SweepInputsTest, AreTheSameWhereASurveyMovesWithItsSweep) {
    const auto state_in = [](const fs::path& cruise) {
        return state_of({.home = cruise,
                         .images = {"dive"},
                         .arguments = {"--nav", "nav.csv"},
                         .scene = {},
                         .folder = cruise / "out"});
    };
    fs::create_directories(home() / "cruise");
    fs::rename(home() / "dive", home() / "cruise/dive");
    fs::rename(home() / "nav.csv", home() / "cruise/nav.csv");
    const std::string before = state_in(home() / "cruise");
    fs::rename(home() / "cruise", home() / "elsewhere");
    EXPECT_EQ(state_in(home() / "elsewhere"), before);
    make_older(home() / "elsewhere/dive/1.tif");
    EXPECT_NE(state_in(home() / "elsewhere"), before);
}

TEST_F(SweepInputsTest, AreNoneOfTheOtherFilesNorTheTimesOfScenes) {
    const std::string before = state();
    write_file(home() / "dive/notes.txt", "other notes");
    write_file(home() / "lamp.inc", "another");
    write_file(home() / "out/point-0001/1.tif", "a result");
    make_older(home() / "parts/lamp.inc");
    EXPECT_EQ(state(), before);
}

}  // namespace
}  // namespace aphotic::sweep_inputs_test
