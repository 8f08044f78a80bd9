// SPDX-License-Identifier: BSD-3-Clause
//
// What goes wrong for users: one clear message, the right exit status, nothing half written.
#include "support/command_test.h"
#include "support/has.h"
#include "support/mistakes.h"
#include "support/scene_text.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace aphotic::errors_test {
namespace {

namespace fs = std::filesystem;

const Arguments kCommands(
    "init render plan generate integrate trace lightmap design validate study survey correct "
    "observe "
    "fit baseline beam compare data help");

const Arguments kRender("render rig.toml -o out --wavelengths 478,576,638");

class CommandErrors : public CommandTest {
  protected:
    void SetUp() override {
        write_file(path("rig.toml"), with(scene_text("habcam.toml"), {{"resolution", "[16, 12]"}}));
    }

    // One message of ours.
    void expect_message(const Arguments& arguments, const std::string& part, int status) const {
        EXPECT_TRUE(refused(arguments, part, status).err.starts_with("aphotic: "));
    }
};

TEST_F(CommandErrors, UnknownKeyNamesFileLineAndTheNearestKey) {
    write_file(path("rig.toml"), replaced(text_of("rig.toml"), "altitude_m", "altitude"));
    expect_message(kRender, "altitude", kBadInput);
}

TEST_F(CommandErrors, RigThatIsNotThere) {
    refused("plan no-such.toml",
            "aphotic: no-such.toml: cannot be read: No such file or directory");
}

TEST_F(CommandErrors, CommandLineMistakesAreBadInput) {
    for (const Arguments& arguments :
         std::vector<Arguments>{{},
                                {"rendr", "rig.toml"},
                                "render rig.toml",
                                "render rig.toml -o out --bands 0",
                                "render rig.toml -o out --bands many",
                                "render rig.toml -o out --bands 3 --wavelengths 500",
                                "plan rig.toml --jbos 2",
                                "data --csv"})
        refused(arguments, "");
}

TEST_F(CommandErrors, NumbersAndNamesThatAreNotAllowed) {
    for (const Mistake& mistake : mistakes_in("cli/mistakes/numbers_and_names.txt", 22)) {
        SCOPED_TRACE(testing::PrintToString(mistake));
        const auto& [command, rest] = mistake.parts.front();
        refused(command + " " + rest, mistake.message);
    }
}

// What a script passes for a variable that it never set: the folder that it runs in is not meant.
TEST_F(CommandErrors, AnEmptyNameIsNone) {
    for (const char* command : {"render", "generate", "trace", "validate", "study", "lightmap"})
        refused({command, "rig.toml", "-o", ""},
                "--output: found an empty string; allowed: a name");
    refused({"integrate", ""}, "DIR: found an empty string; allowed: a name");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1) << "the rig alone";
}

TEST_F(CommandErrors, NoResultTakesThePlaceOfWhatItIsMadeFrom) {
    const std::string rig = text_of("rig.toml");
    write_file(path("rig.svg"), rig);
    refused("plan rig.svg --plot rig.svg", "aphotic: --plot: found rig.svg, which RIG also names");
    EXPECT_EQ(text_of("rig.svg"), rig);
    fs::create_directory(path("raw"));
    write_file(path("raw/a.exr"), "raw");
    write_file(path("nav.csv"), "image,altitude_m\na.exr,2\n");
    refused("observe raw --nav nav.csv --altitude 2 -o raw/a.exr",
            "aphotic: --output: found raw/a.exr, which IMAGES also names");
    EXPECT_EQ(text_of("raw/a.exr"), "raw");
}

TEST_F(CommandErrors, HelpAndVersionAreNoErrors) {
    for (const std::string& command : kCommands) {
        const CommandResult run = done(fmt::format("{} --help", command));
        EXPECT_EQ(run.out.find("--json") == std::string::npos, command == "help") << command;
        EXPECT_EQ(run.err, "");
        std::istringstream lines(run.out);
        for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80U) << line;
    }
    EXPECT_TRUE(aphotic("--version").out.starts_with("aphotic "));
}

std::set<std::string> words_of(const std::string& text) {
    std::istringstream words(text);
    std::set<std::string> all;
    for (std::string word; words >> word;) all.insert(word);
    return all;
}

// As man shows it: without warnings of groff's, and with all that --help has.
TEST_F(CommandErrors, TheManPageHasEveryCommandOptionAndDefault) {
    const std::string all = aphotic("--help").out;
    const std::regex subcommand("\n  ([a-z]+) {2,}");
    std::set<std::string> commands;
    for (std::sregex_iterator at(all.begin(), all.end(), subcommand), end; at != end; ++at)
        commands.insert((*at)[1].str());
    EXPECT_EQ(commands, std::set<std::string>(kCommands.begin(), kCommands.end()));

    write_file(path("aphotic.1"), done("--man-page").out);
    if (!fs::exists("/usr/bin/groff")) GTEST_SKIP() << "groff is not installed";
    // In wide lines, so that no word is broken.
    EXPECT_TRUE(
        by("/usr/bin/groff", "-man -Tascii -P-bcou -ww -rLL=200n -rHY=0 aphotic.1").succeeded());
    const std::string shown = text_of("log");
    EXPECT_FALSE(has(shown, "warning: "));
    for (const std::string& command : kCommands) {
        const std::size_t at = shown.find("\n   aphotic " + command + "\n");
        ASSERT_NE(at, std::string::npos) << command << " is not in the man page";
        const std::string own = shown.substr(at + 1, shown.find("\n   aphotic ", at + 1) - at);
        const auto in_help = words_of(aphotic(fmt::format("{} --help", command)).out);
        const auto in_page = words_of(own);
        for (const std::string& word : in_help) {
            const bool is_said =
                word.starts_with("--") || (word.ends_with("]") && !word.starts_with("["));
            EXPECT_TRUE(!is_said || in_page.contains(word)) << command << ": " << word;
        }
    }
}

TEST_F(CommandErrors, TheNamesOfTheFirstVersionGoOn) {
    for (const Arguments& arguments :
         std::vector<Arguments>{"lightmap rig.toml -o a.exr --altitude-m 2 --pitch-deg 3",
                                "lightmap rig.toml -o a.exr --roll-deg 1 --threads 1"})
        done(arguments);
    refused("correct raw --map m.exr -o out --altitudes-m 4,1",
            "--altitude: found 4,1; allowed: the lower first");
}

// The tracer makes the same images; and the command that is named does it.
TEST_F(CommandErrors, MissingPovRayNamesWhatRunsWithoutIt) {
    const std::map<std::string, std::string> none{{"APHOTIC_POVRAY", "/no/povray"}};
    for (const char* command : {"render", "validate"}) {
        const CommandResult run = refused(aphotic(fmt::format("{} rig.toml -o out", command), none),
                                          "install povray",
                                          kRunFailed);
        EXPECT_TRUE(has(run.err, "`aphotic trace rig.toml -o out` makes the same images"));
        EXPECT_FALSE(fs::exists(path("out"))) << command;
    }
    done(aphotic("trace rig.toml -o out", none));
}

// Which the tracer cannot read.
TEST_F(CommandErrors, MissingPovRayNamesNoTracerForASceneOfTheUsersOwn) {
    write_file(path("own.pov"), "#include \"aphotic.inc\"\n");
    for (const char* command : {"render", "validate"}) {
        const CommandResult run =
            refused(aphotic(fmt::format("{} rig.toml -o out --scene own.pov", command),
                            {{"APHOTIC_POVRAY", "/no/povray"}}),
                    "install povray",
                    kRunFailed);
        EXPECT_FALSE(has(run.err, "aphotic trace"));
        EXPECT_FALSE(fs::exists(path("out"))) << command;
    }
}

TEST_F(CommandErrors, AValidationThatIsRefusedLeavesNoFolder) {
    done("generate rig.toml -o other --fitted 3");
    write_file(path("wider.toml"), with(text_of("rig.toml"), {{"resolution", "[116, 12]"}}));
    refused("validate wider.toml --rendered other -o out", "aphotic: other: found images of ");
}

TEST_F(CommandErrors, OutputThatCannotBeAFolder) {
    write_file(path("out"), "a file");
    refused(kRender, "aphotic: out: cannot be created", kRunFailed);
    EXPECT_EQ(text_of("out"), "a file");
}

// Root writes where it likes; /proc refuses even root.
TEST_F(CommandErrors, UnwritableFolder) {
    expect_message("generate rig.toml -o /proc/aphotic", "/proc/aphotic", kRunFailed);
}

TEST_F(CommandErrors, IntegrateOfAStrangeFolder) {
    expect_message("integrate .", "manifest.json", kBadInput);
    write_file(path("manifest.json"), "{ \"format\": \"something\" }");
    expect_message("integrate .", "format", kBadInput);
}

TEST_F(CommandErrors, FullStandardOutput) {
    if (::access("/dev/full", W_OK) != 0) GTEST_SKIP() << "this system has no /dev/full";
    const ProcessEnd end = by("/bin/sh", {"-c", "exec \"$0\" data > /dev/full", APHOTIC_COMMAND});
    EXPECT_EQ(end.exit_code, kRunFailed) << text_of("log");
}

}  // namespace
}  // namespace aphotic::errors_test
