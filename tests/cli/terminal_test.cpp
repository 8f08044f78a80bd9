// SPDX-License-Identifier: BSD-3-Clause
//
// Names of files and cells of tables that steer a terminal, feign a message of ours or have no end,
// through every command that reads: what is printed of them is plain, and has an end.
#include "base/printable.h"
#include "support/command_test.h"
#include "support/exr_file.h"
#include "support/has.h"
#include "support/scene_text.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace aphotic::terminal_test {
namespace {

namespace fs = std::filesystem;

// Clears the screen, rings, goes back to the line's beginning, and says that all is well.
constexpr const char* kEvil = "\x1b[2J\x1b]0;x\x07\r\naphotic: done\xC2\x9B";
constexpr const char* kEvilAsShown = "\\x1b[2J\\x1b]0;x\\x07\\x0d\\x0aaphotic: done\\x9b";
constexpr std::size_t kLongCell_bytes = 1'000'000;
// A whole message, "aphotic: " and the line's end.
constexpr std::size_t kMostPrinted_bytes = kMostMessage_bytes + 100;

void expect_plain(const std::string& said, const std::string& what) {
    EXPECT_FALSE(has_control_characters([&] {
        std::string text = said;
        std::erase_if(text, [](char c) { return c == '\n' || c == '\t'; });
        return text;
    }()))
        << what;
    EXPECT_FALSE(has(said, "\naphotic: done")) << what;
}

class Terminal : public CommandTest {
  protected:
    Terminal() {
        write_file(path("rig.toml"), scene_text("habcam.toml"));
        write_exr(path("a.exr"), 20, std::vector<float>(3 * 20 * 12, 0.5F));
        write_file(path("nav.csv"), "image,altitude_m,pitch_deg,roll_deg\na.exr,2,0,0\n");
    }

    // One message, of some kind of refusal.
    void expect_refused(const Arguments& arguments, const std::string& shown = "") {
        const CommandResult run = aphotic(arguments);
        const std::string what = arguments.front() + " said: " + printable(run.err.substr(0, 300));
        EXPECT_TRUE(run.status == kBadInput || run.status == kAnswerIsNo) << what;
        EXPECT_LT(run.err.size(), kMostPrinted_bytes) << what;
        EXPECT_LE(std::ranges::count(run.err, '\n'), 2) << what;
        EXPECT_TRUE(has(run.err, shown)) << what;
        expect_plain(run.err, what);
        expect_plain(run.out, what);
    }
};

TEST_F(Terminal, IsNotSteeredByTheNameOfAFileThatIsNotThere) {
    const std::string evil = kEvil;
    const std::string shown = kEvilAsShown;
    const std::vector<Arguments> commands{
        {"plan", evil + ".toml"},
        {"lightmap", evil + ".toml", "-o", "m.exr"},
        {"trace", evil + ".toml", "-o", "out"},
        {"render", evil + ".toml", "-o", "out"},
        {"generate", evil + ".toml", "-o", "out"},
        {"validate", evil + ".toml", "-o", "out"},
        {"integrate", evil},
        {"design", evil + ".toml", "--vary", "strobe.*.power", "-o", "out"},
        {"survey", evil + ".toml", "-o", "out"},
        {"fit", evil + ".toml", "--maps", "a.exr", "-o", "out"},
        {"observe", evil + ".exr", "--nav", "nav.csv", "--altitude", "2", "-o", "m.exr"},
        {"observe", "a.exr", "--nav", evil, "--altitude", "2", "-o", "m.exr"},
        {"correct", evil + ".tif", "--map", "a.exr", "-o", "out"},
        {"correct", "a.exr", "--map", evil + ".exr", "-o", "out"},
        {"baseline", "local-equalisation", evil + ".tif", "-o", "out"},
        {"compare", evil + ".exr", "a.exr"},
        {"compare", "a.exr", evil + ".exr"},
        {"beam", evil + ".ies"},
        {"data", evil},
        {"plan", "rig.toml", "--tolerance", evil},
        {"plan", "rig.toml", "--" + evil},
        {evil}};
    for (const Arguments& command : commands) expect_refused(command, shown);
}

TEST_F(Terminal, IsNotSteeredByTheNameOfAFileThatIsThere) {
    const std::string evil = kEvil;
    fs::copy_file(path("a.exr"), path(evil + ".exr"));
    fs::copy_file(path("rig.toml"), path(evil + ".toml"));
    const std::vector<Arguments> commands{
        {"compare", evil + ".exr", "a.exr"},
        {"plan", evil + ".toml", "--bands", "3"},
        {"observe", evil + ".exr", "a.exr", "--nav", "nav.csv", "--altitude", "2", "-o", "m.exr"},
        {"observe", "a.exr", "--nav", "nav.csv", "--altitude", "2", "-o", evil + ".map.exr"}};
    for (const Arguments& command : commands) {
        const CommandResult run = aphotic(command);
        const std::string what = printable(fmt::format("{}", fmt::join(command, " ")));
        EXPECT_TRUE(run.status == 0 || run.status == kAnswerIsNo || run.status == kBadInput)
            << what << run.err;
        expect_plain(run.out + run.err, what + ": " + printable(run.out + run.err));
    }
    // JSON is still JSON, and the name in it the file's.
    const CommandResult run = aphotic({"compare", evil + ".exr", "a.exr", "--json"});
    expect_plain(run.out, run.out);
    EXPECT_EQ(nlohmann::json::parse(run.out).at("image"), evil + ".exr");
}

TEST_F(Terminal, IsNotFloodedOrSteeredByACell) {
    const std::string nav = "image,altitude_m,pitch_deg,roll_deg\n";
    const std::string csv = "wavelength_nm,reflectance\n300,0.5\n";
    const std::string habcam = text_of("rig.toml");
    const auto rig_with = [&](const std::string& key, const std::string& value) {
        return fmt::format("{} = \"{}\"\n{}", key, value, habcam);
    };
    const Arguments observe("observe a.exr --nav cell --altitude 2 -o m.exr");
    const Arguments plan("plan cell.toml");
    for (const std::string& cell :
         {std::string(kLongCell_bytes, 'x'), "\x1b[2J\x07" + std::string("aphotic: done")}) {
        const std::vector<std::pair<std::string, Arguments>> files{
            {nav + "a.exr," + cell + ",0,0\n", observe},
            {nav + "a.exr,2,0,0\na.exr,2,0,0\n" + cell + "\n", observe},
            {cell + "," + nav + "a.exr,2,0,0\n", observe},
            {"image-set-header:\n  image-set-ifdo-version: '" + cell + "'\nimage-set-items: {}\n",
             observe},
            {rig_with("titel", cell), plan},
            {rig_with("title", cell), plan},
            {cell + " = 1\n" + habcam, plan},
            {"title = " + cell + "\n", plan}};
        for (const auto& [text, arguments] : files) {
            write_file(path(arguments.front() == "plan" ? "cell.toml" : "cell"), text);
            expect_refused(arguments);
        }
        write_file(path("mud.csv"), csv + "400," + cell + "\n");
        write_file(path("cell.toml"), habcam + "\n[material.mud]\nreflectance = \"mud.csv\"\n");
        expect_refused(plan);
        write_file(path("beam.ies"), "IESNA:LM-63-2002\nTILT=" + cell + "\n");
        expect_refused("beam beam.ies");
    }
}

// OpenImageIO takes what follows a question mark for options.
TEST_F(Terminal, IsToldOfQuestionMarksInThePathsOfImages) {
    write_file(path("a?b=c.tif"), "no image");
    write_file(path("a%04d#.tif"), "no image");
    expect_refused("baseline local-equalisation a?b=c.tif -o out",
                   "found a question mark in the path");
    expect_refused("compare a?b=c.tif a.exr", "found a question mark in the path");
    expect_refused("compare a%04d#.tif a.exr", "a%04d#.tif: cannot be read: ");
}

}  // namespace
}  // namespace aphotic::terminal_test
