// SPDX-License-Identifier: BSD-3-Clause
//
// What goes wrong for users: one clear message, the right exit status, nothing half written.
#include "support/command_test.h"
#include "support/has.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace aphotic::errors_test {
namespace {

namespace fs = std::filesystem;

constexpr int kBadInput = 2;
constexpr int kRunFailed = 3;

const Arguments kCommands(
    "render plan generate integrate trace lightmap design validate study survey correct observe "
    "fit baseline beam compare data help");

class CommandErrors : public CommandTest {
  protected:
    void SetUp() override {
        std::string text = read_text_file(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml");
        text = std::regex_replace(
            text, std::regex(R"(\n\s*resolution\s*=[^\n]*)"), "\nresolution = [16, 12]");
        write_file(path("rig.toml"), text);
    }

    [[nodiscard]] CommandResult render(
        const std::map<std::string, std::string>& environment = {}) const {
        return aphotic("render rig.toml -o out --wavelengths 478,576,638", environment);
    }

    void change_rig(const std::string& from, const std::string& to) const {
        std::string text = text_of("rig.toml");
        ASSERT_TRUE(has(text, from)) << from;
        write_file(path("rig.toml"), text.replace(text.find(from), from.size(), to));
    }

    static void expect_one_message(const CommandResult& run, int status, const std::string& part) {
        EXPECT_EQ(run.status, status) << run.err;
        EXPECT_EQ(run.out, "");
        EXPECT_TRUE(run.err.starts_with("aphotic: ")) << run.err;
        EXPECT_TRUE(has(run.err, part));
    }
};

TEST_F(CommandErrors, UnknownKeyNamesFileLineAndTheNearestKey) {
    change_rig("altitude_m = 2.0", "altitude = 2.0");
    expect_one_message(render(), kBadInput, "altitude");
    EXPECT_FALSE(fs::exists(path("out")));
}

TEST_F(CommandErrors, RigThatIsNotThere) {
    const CommandResult run = aphotic("plan no-such.toml");
    expect_one_message(run, kBadInput, "no-such.toml: cannot be read: No such file or directory");
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
                                "data --csv"}) {
        const CommandResult run = aphotic(arguments);
        EXPECT_EQ(run.status, kBadInput) << testing::PrintToString(arguments);
        EXPECT_NE(run.err, "") << testing::PrintToString(arguments);
        EXPECT_EQ(run.out, "") << testing::PrintToString(arguments);
    }
}

TEST_F(CommandErrors, NumbersAndNamesThatAreNotAllowed) {
    const std::string observe = "observe raw --nav n -o m.exr --altitude ";
    const std::string correct = "correct raw --rig rig.toml --nav n -o out ";
    const std::vector<std::pair<std::string, std::string>> cases{
        {observe + "2 --trim 0.5", "--trim: found 0.5; allowed: 0 to 0.49"},
        {observe + "-1", "--altitude: found -1; allowed: more than 0"},
        {observe + "2 --within inf", "--within: found inf; allowed: 0 or more"},
        {observe + "2 --longest-gap-s 0", "--longest-gap-s: found 0; allowed: more than 0"},
        {observe + "2 --clock-offset-s x", "--clock-offset-s"},
        {observe + "2 --allow-skipped 2%%",
         "--allow-skipped: found '2%%'; allowed: a number of images, or a share such as 0.01 or "
         "1%"},
        {correct + "--columns alt=h",
         "--columns: found 'alt=h'; allowed: NAME=COLUMN, NAME one of image, time, altitude_m, "
         "pitch_deg, roll_deg"},
        {correct + "--columns image=", "--columns: found 'image='; allowed: NAME=COLUMN"},
        {correct + "--angles-in grad", "--angles-in"},
        {correct + "--image-time YYMM",
         "--image-time: found 'YYMM', which has not YYYY in one place; allowed: YYYY, MM, DD"},
        {correct + "--altitude-is up", "--altitude-is"},
        {"baseline homomorphic raw -o out --nav n --altitude-offset-m 1001",
         "--altitude-offset-m: found 1001; allowed: -1000 to 1000"},
        {"baseline homomorphic raw -o out --allow-skipped 1.01",
         "--allow-skipped: found '1.01'; allowed: a number of images, or a share"},
        {"baseline altitude-exponential raw -o out --bin 0",
         "--bin: found 0; allowed: 0.001 to 10000"},
        {"compare a.exr --patches p.csv --encoding gamma",
         "--encoding: gamma not in {linear,srgb}"},
        {"lightmap rig.toml -o out --altitude 1 --export oplap", "--export: oplap not in {oplab}"},
        {"lightmap rig.toml -o map.exr --altitude-m nan", "found nan; allowed: "},
        {"lightmap rig.toml -o map.png",
         "--output: found map.png; allowed: a name that ends in .exr"},
        {"trace rig.toml -o out --threads 0", "--jobs: found 0; allowed: 1 to "},
        {"plan rig.toml --tolerance nan", "found nan; allowed: "},
        {"plan rig.toml --plot plan.png",
         "--plot: found plan.png; allowed: a name that ends in .svg"}};
    for (const auto& [words, message] : cases) {
        const CommandResult run = aphotic(words);
        EXPECT_EQ(run.status, kBadInput) << words;
        EXPECT_TRUE(has(run.err, message));
    }
    EXPECT_FALSE(fs::exists(path("map.exr")));
    EXPECT_FALSE(fs::exists(path("map.png")));
}

// What a script passes for a variable that it never set: the folder that it runs in is not meant.
TEST_F(CommandErrors, AnEmptyNameIsNone) {
    for (const char* command : {"render", "generate", "trace", "validate", "study", "lightmap"}) {
        const CommandResult run = aphotic({command, "rig.toml", "-o", ""});
        EXPECT_EQ(run.status, kBadInput) << command;
        EXPECT_TRUE(has(run.err, "--output: found an empty text; allowed: a name"));
    }
    const CommandResult run = aphotic({"integrate", ""});
    EXPECT_EQ(run.status, kBadInput);
    EXPECT_TRUE(has(run.err, "DIR: found an empty text; allowed: a name"));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1) << "the rig alone";
}

TEST_F(CommandErrors, NoResultTakesThePlaceOfWhatItIsMadeFrom) {
    const std::string rig = text_of("rig.toml");
    write_file(path("rig.svg"), rig);
    expect_one_message(aphotic("plan rig.svg --plot rig.svg"),
                       kBadInput,
                       "--plot: found rig.svg, which RIG names too");
    EXPECT_EQ(text_of("rig.svg"), rig);
    fs::create_directory(path("raw"));
    write_file(path("raw/a.exr"), "raw");
    write_file(path("nav.csv"), "image,altitude_m\na.exr,2\n");
    expect_one_message(aphotic("observe raw --nav nav.csv --altitude 2 -o raw/a.exr"),
                       kBadInput,
                       "--output: found raw/a.exr, which IMAGES names too");
    EXPECT_EQ(text_of("raw/a.exr"), "raw");
}

TEST_F(CommandErrors, HelpAndVersionAreNoErrors) {
    for (const std::string& command : kCommands) {
        const CommandResult run = aphotic(fmt::format("{} --help", command));
        EXPECT_EQ(run.status, 0);
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

// In wide lines, so that no word is broken; empty where there is no groff. Its warnings fail.
std::string shown_by_groff(const std::filesystem::path& folder, const std::string& page) {
    const std::string groff = "/usr/bin/groff";
    if (!std::filesystem::exists(groff)) return "";
    const ProcessEnd end =
        run_process({.executable = groff,
                     .arguments = Arguments("-man -Tascii -P-bcou -ww -rLL=200n -rHY=0") + page,
                     .folder = folder,
                     .environment = {},
                     .log = folder / "shown"},
                    60.0);
    EXPECT_EQ(end.exit_code, 0);
    std::string text = read_text_file(folder / "shown");
    EXPECT_FALSE(has(text, "warning: ")) << text.substr(0, 2000);
    return text;
}

// As man shows it: without warnings of groff's, and with all that --help has.
TEST_F(CommandErrors, TheManPageHasEveryCommandOptionAndDefault) {
    const std::string all = aphotic("--help").out;
    const std::regex subcommand("\n  ([a-z]+) {2,}");
    std::set<std::string> commands;
    for (std::sregex_iterator at(all.begin(), all.end(), subcommand), end; at != end; ++at)
        commands.insert((*at)[1].str());
    EXPECT_EQ(commands, std::set<std::string>(kCommands.begin(), kCommands.end()));

    const CommandResult page = aphotic("--man-page");
    ASSERT_EQ(page.status, 0) << page.err;
    write_file(path("aphotic.1"), page.out);
    const std::string shown = shown_by_groff(folder_.path(), "aphotic.1");
    if (shown.empty()) GTEST_SKIP() << "groff is not installed";
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
                                "lightmap rig.toml -o a.exr --roll-deg 1 --threads 1"}) {
        EXPECT_EQ(aphotic(arguments).status, 0) << testing::PrintToString(arguments);
    }
    EXPECT_NE(aphotic("correct raw --map m.exr -o out --altitudes-m 4,1")
                  .err.find("--altitude: found 4,1; allowed: the lower first"),
              std::string::npos);
}

// The tracer makes the same images; and the command that is named does it.
TEST_F(CommandErrors, MissingPovRayNamesWhatRunsWithoutIt) {
    const std::map<std::string, std::string> none{{"APHOTIC_POVRAY", "/no/povray"}};
    for (const char* command : {"render", "validate"}) {
        const CommandResult run = aphotic(fmt::format("{} rig.toml -o out", command), none);
        expect_one_message(run, kRunFailed, "install povray");
        expect_one_message(
            run, kRunFailed, "`aphotic trace rig.toml -o out` makes the same images");
        EXPECT_FALSE(fs::exists(path("out"))) << command;
    }
    EXPECT_EQ(aphotic("trace rig.toml -o out", none).status, 0);
}

// Which the tracer cannot read.
TEST_F(CommandErrors, MissingPovRayNamesNoTracerForASceneOfTheUsersOwn) {
    write_file(path("own.pov"), "#include \"aphotic.inc\"\n");
    for (const char* command : {"render", "validate"}) {
        const CommandResult run =
            aphotic(fmt::format("{} rig.toml -o out --scene own.pov", command),
                    {{"APHOTIC_POVRAY", "/no/povray"}});
        expect_one_message(run, kRunFailed, "install povray");
        EXPECT_FALSE(has(run.err, "aphotic trace"));
        EXPECT_FALSE(fs::exists(path("out"))) << command;
    }
}

TEST_F(CommandErrors, AValidationThatIsRefusedLeavesNoFolder) {
    const std::string rig = text_of("rig.toml");
    ASSERT_EQ(aphotic("generate rig.toml -o other --fitted 3").status, 0);
    write_file(path("wider.toml"),
               std::regex_replace(rig, std::regex(R"(resolution\s*=\s*\[\s*)"), "resolution = [1"));
    expect_one_message(aphotic("validate wider.toml --rendered other -o out"),
                       kBadInput,
                       "other: found images of ");
    EXPECT_FALSE(fs::exists(path("out")));
}

TEST_F(CommandErrors, OutputThatCannotBeAFolder) {
    write_file(path("out"), "a file");
    expect_one_message(render(), kRunFailed, "out: cannot be created");
    EXPECT_EQ(text_of("out"), "a file");
}

// Root writes where it likes; /proc refuses even root.
TEST_F(CommandErrors, UnwritableFolder) {
    const CommandResult run = aphotic("generate rig.toml -o /proc/aphotic");
    expect_one_message(run, kRunFailed, "/proc/aphotic");
}

TEST_F(CommandErrors, IntegrateOfAStrangeFolder) {
    expect_one_message(aphotic("integrate ."), kBadInput, "manifest.json");
    write_file(path("manifest.json"), "{ \"format\": \"something\" }");
    expect_one_message(aphotic("integrate ."), kBadInput, "format");
}

TEST_F(CommandErrors, FullStandardOutput) {
    if (::access("/dev/full", W_OK) != 0) GTEST_SKIP() << "this system has no /dev/full";
    const ProcessEnd end =
        run_process({.executable = "/bin/sh",
                     .arguments = {"-c", "exec \"$0\" data > /dev/full", APHOTIC_COMMAND},
                     .folder = folder_.path(),
                     .environment = {},
                     .log = path("log")},
                    60.0);
    EXPECT_EQ(end.exit_code, kRunFailed) << text_of("log");
}

}  // namespace
}  // namespace aphotic::errors_test
