// SPDX-License-Identifier: BSD-3-Clause
//
// Rigs and folders that were made to do harm: their texts stay texts, for POV-Ray, for its settings
// and for a shell. tests/scene_gen/rig_reader_test.cpp has what is refused when a rig is read,
// tests/validation/*_browser_test.cpp what a browser makes of such names.
#include "support/command_test.h"
#include "support/exr_file.h"
#include "support/scene_text.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <nlohmann/json.hpp>

namespace aphotic::hostile_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMud = "wavelength_nm,reflectance\n300,0.25\n900,0.5\n";
constexpr const char* kClay = "wavelength_nm,reflectance\n300,0.75\n900,0.125\n";
constexpr const char* kFlash = "wavelength_nm,relative_power\n300,1\n900,0.5\n";

// What stands in every text of a rig. The tables are files: their names have no slash.
struct Texts {
    std::string title;
    std::string name;
    std::string mud;
    std::string clay;
    std::string flash;
};

const Texts kInnocent{"a rig", "name", "mud.csv", "clay.csv", "flash.csv"};

const std::vector<Texts> kHostile{
    {R"(*/ sphere { 0, 9 } /* // " #end)",
     R"(" } #end light_source { 0, 9 } #macro M ( " ")",
     R"(" } sphere { 0, 9 pigment { rgb 1 } } #if (0) ".csv)",
     R"(#include "colors.inc".csv)",
     R"(\" #debug "owned".csv)"},
    {"/* never closed", "\\", "a\\.csv", "a\".csv", "a'.csv"},
    {R"(%s%n {} {0} ${HOME} $(touch owned) `touch owned` ; touch owned)",
     R"(Output_File_Name=owned +Oowned [x] #declare Aphotic_Fade_Distance = 9;)",
     "-O owned.csv",
     "+Oowned.csv",
     "; touch owned;.csv"},
    // POV-Ray makes blanks of non-ASCII letters: these tables must stay two.
    {"K\xC3\xB6ln \xE2\x80\xAE \xF0\x9F\x90\x9A",
     "\xC3\xA4",
     "\xC3\xA4.csv",
     "\xC3\xB6.csv",
     "\xC3\xBC.csv"},
    {std::string(1000, 'a'),
     std::string(1000, '"'),
     std::string(240, '"') + "1.csv",
     std::string(240, '"') + "2.csv",
     std::string(240, '\'') + ".csv"},
};

std::string toml_text(const std::string& text) {
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') quoted += '\\';
        quoted += c;
    }
    return quoted + "\"";
}

std::string rig_of(const Texts& texts) {
    const std::string name = toml_text(texts.name);
    return fmt::format(R"(title = {0}
[sled]
altitude_m = 2
[camera]
resolution = [16, 12]
pixel_pitch_um = 500
focal_length_mm = 12
range_nm = [420, 680]
response = "nikon-d5100"
[water]
[seafloor]
reflectance = {2}
[beam.{1}]
cones = [{{ part = {1}, half_angle_deg = 60, weight = 1 }}]
[[strobe]]
name = {1}
position_m = [0.5, 0, 0]
aim = {{ tilt_deg = 14, toward = "axis" }}
beam = {1}
spectrum = {4}
[[object]]
name = {1}
shape = "sphere"
centre_m = [0, 0.1, 1.8]
radius_m = 0.25
reflectance = {3}
)",
                       toml_text(texts.title),
                       name,
                       toml_text(texts.mud),
                       toml_text(texts.clay),
                       toml_text(texts.flash));
}

void put_rig(const fs::path& folder, const Texts& texts) {
    fs::create_directories(folder);
    write_file(folder / "rig.toml", rig_of(texts));
    write_file(folder / texts.mud, kMud);
    write_file(folder / texts.clay, kClay);
    write_file(folder / texts.flash, kFlash);
}

using Hostile = CommandTest;

TEST_F(Hostile, TextsOfARigChangeNoBitOfItsImage) {
    const auto render = [&](const std::string& name) {
        done(run_aphotic(path(name), "render rig.toml -o out --fitted 3"));
        return read_exr(path(name + "/out/image.exr"));
    };
    const auto rendered = [&](const std::string& name, const Texts& texts) {
        put_rig(path(name), texts);
        return render(name);
    };
    const std::vector<float> innocent = rendered("innocent", kInnocent);
    for (std::size_t i = 0; i < kHostile.size(); ++i) {
        EXPECT_EQ(rendered(std::to_string(i), kHostile[i]), innocent) << kHostile[i].title;
        EXPECT_FALSE(fs::exists(path(std::to_string(i) + "/owned")));
    }
    // The test sees a difference where there is one.
    write_file(path("innocent/" + kInnocent.clay), kMud);
    EXPECT_NE(read_exr(path("0/out/image.exr")), render("innocent"));
}

const std::vector<std::string> kFolderNames{
    "it's \"so\"", "-o", "two\nlines", "K\xC3\xB6ln", "; #x = %s{} $(touch owned)"};

TEST_F(Hostile, FoldersOfAnyNameHoldRigsAndRenders) {
    put_rig(home_, kInnocent);
    done("render rig.toml -o out --fitted 3");
    const std::vector<float> expected = read_exr(path("out/image.exr"));
    for (const std::string& name : kFolderNames) {
        put_rig(path(name), kInnocent);
        done({"render", "./" + name + "/rig.toml", "--output=" + name + "/out", "--fitted", "3"});
        EXPECT_EQ(read_exr(path(name) / "out" / "image.exr"), expected) << name;
    }
    EXPECT_FALSE(fs::exists(path("owned")));
}

// POV-Ray reads "a[b]" as the section b of the settings a.
// JSON must be UTF-8, names of folders need not.
TEST_F(Hostile, FoldersOfAnyNameAreToldInJson) {
    write_file(path("rig.toml"), scene_text("one-lamp.toml"));
    const auto json = json_by("generate rig.toml --wavelengths 550 --json -o \xff\xfe");
    EXPECT_EQ(json.at("folder"), "\uFFFD\uFFFD");
}

TEST_F(Hostile, FolderThatPovRayCannotReadIsRefusedBeforeAnythingIsWritten) {
    put_rig(home_, kInnocent);
    refused("render rig.toml -o a[b] --fitted 3", "a[b]: found a '['");
}

// The lines that generate prints go through a shell, with a POV-Ray that says what it is given.
TEST_F(Hostile, PrintedCommandsNameFoldersAsAShellTakesThem) {
    for (const std::string& name : kFolderNames) {
        put_rig(home_, kInnocent);
        const fs::path out = path("called");
        fs::remove(out);
        fs::create_directory(path("bin"));
        write_script(
            path("bin/povray"),
            "pwd >> '" + out.string() + "'\nprintf '%s\\n' \"$@\" >> '" + out.string() + "'\n");
        const CommandResult run =
            done({"generate", "rig.toml", "--output=" + name, "--wavelengths", "500"});
        const std::size_t from = run.out.find("  (cd ");
        const std::size_t to = run.out.find("done)\n") + 5;
        ASSERT_LT(from, to) << run.out;
        const ProcessEnd end = by_shell("PATH=$PWD/bin:$PATH\n" + run.out.substr(from, to - from));
        EXPECT_TRUE(end.succeeded()) << text_of("log");
        EXPECT_EQ(
            read_text_file(out),
            (fs::canonical(path(name)) / "povray").string() + "\nrender.ini\n+Iband_500nm.pov\n");
        EXPECT_FALSE(fs::exists(path(name) / "povray" / "owned"));
    }
}

// A scene of the user's own brings the folder's path into POV-Ray's settings.
TEST_F(Hostile, FolderThatWouldAddASettingIsRefused) {
    put_rig(home_, kInnocent);
    write_file(path("own.pov"),
               "#version 3.7;\n#include \"aphotic.inc\"\nAphotic_Rig ()\n"
               "Aphotic_Seafloor (2, 0, 0, \"sand\")\n");
    for (const std::string name : {"x\nOutput_File_Name=owned", "x\" y"}) {
        refused({"generate", "rig.toml", "--scene", "own.pov", "-o", name, "--wavelengths", "500"},
                "since POV-Ray cannot read them");
    }
}

// A pipe that nobody writes to, and a device without end, in the place of a frame.
TEST_F(Hostile, FramesThatAreNoFilesAreRefusedWithoutWaiting) {
    put_rig(home_, kInnocent);
    done("render rig.toml -o out --wavelengths 500");
    const fs::path frame = path("out/povray/frames/band_500nm.exr");
    const char* why = "band_500nm.exr: cannot be read";
    fs::remove(frame);
    ASSERT_EQ(::mkfifo(frame.c_str(), 0600), 0);
    refused("integrate out", why, kRunFailed);
    fs::remove(frame);
    fs::create_symlink("/dev/zero", frame);
    refused("integrate out", why, kRunFailed);
}

}  // namespace
}  // namespace aphotic::hostile_test
