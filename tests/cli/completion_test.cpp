// SPDX-License-Identifier: BSD-3-Clause
//
// Completion in the shells themselves, held against --help.
#include "support/command_test.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <sstream>

namespace aphotic::completion_test {
namespace {

namespace fs = std::filesystem;

std::set<std::string> words_in(const std::string& text) {
    std::istringstream words(text);
    std::set<std::string> all;
    for (std::string word; words >> word;) all.insert(word);
    return all;
}

// The first long name of each line, as --help begins it.
constexpr const char* kOption = "\n  (?:-[a-z], )?(--[a-z0-9-]+)";
constexpr const char* kCommand = "\n  ([a-z]+) {2,}";
std::set<std::string> found_in(const std::string& help, const std::string& pattern) {
    const std::regex name(pattern);
    std::set<std::string> names;
    for (std::sregex_iterator at(help.begin(), help.end(), name), end; at != end; ++at)
        names.insert((*at)[1].str());
    return names;
}

bool is_installed(const std::string& program) {
    return fs::exists("/usr/bin/" + program) || fs::exists("/bin/" + program);
}

class Completion : public CommandTest {
  protected:
    void SetUp() override { write_file(path("my-rig.toml"), ""); }

    void save_script(const std::string& shell, const std::string& name) const {
        write_file(path(name), done(fmt::format("--completion {}", shell)).out);
    }

    [[nodiscard]] std::string said_by(const std::string& shell, const Arguments& arguments) const {
        const ProcessEnd end = by(shell, arguments, {{"HOME", home_.string()}});
        std::string said = text_of("log");
        EXPECT_TRUE(end.succeeded()) << shell << ": " << end.words() << "\n" << said;
        return said;
    }

    // What bash makes of the words, the last of which is to be completed.
    [[nodiscard]] std::set<std::string> by_bash(const Arguments& words) const {
        const Arguments completed{
            "--norc",
            "-c",
            "source ./aphotic.bash && COMP_WORDS=(\"$0\" \"$@\") && COMP_CWORD=$# && "
            "_aphotic && echo \"${COMPREPLY[@]}\"",
            "aphotic"};
        return words_in(said_by("/bin/bash", completed + words));
    }

    // An interactive zsh, of a terminal: what the command is given once the line was completed.
    [[nodiscard]] std::string by_zsh(const std::string& line) const {
        write_file(path("type.zsh"), R"(zmodload zsh/zpty
zpty shell zsh -f -i
zpty -w shell "fpath=($1 \$fpath); autoload -U compinit; compinit -u -D; aphotic() { print -r -- got \${(j:,:)@}; }; print rea''dy"
zpty -r -m shell out '*ready*'
zpty -w shell "aphotic $2"$'\t'
zpty -r -m shell out $'*\ngot *\n*'
print -r -- $out
)");
        const std::string said = said_by("/usr/bin/zsh", {"-f", "type.zsh", home_.string(), line});
        std::smatch found;
        return std::regex_search(said, found, std::regex("got ([^\r\n]*)")) ? found[1].str() : said;
    }

    // Its lines are words with a tab and a description.
    [[nodiscard]] std::set<std::string> by_fish(const std::string& line) const {
        const std::string said =
            said_by("/usr/bin/fish",
                    {"--no-config", "-c", "source aphotic.fish; complete -C'" + line + "'"});
        std::istringstream lines(said);
        std::set<std::string> words;
        for (std::string one; std::getline(lines, one);)
            words.insert(one.substr(0, one.find('\t')));
        return words;
    }
};

using Words = std::set<std::string>;

TEST_F(Completion, BashOffersTheCommandsAndOptionsOfHelp) {
    save_script("bash", "aphotic.bash");
    const std::set<std::string> commands = found_in(aphotic("--help").out, kCommand);
    EXPECT_TRUE(commands.contains("render") && commands.contains("help"));
    EXPECT_EQ(by_bash({""}), commands);
    for (const std::string& command : commands) {
        const std::set<std::string> options = found_in(aphotic(command + " --help").out, kOption);
        EXPECT_TRUE(options.contains("--help")) << command;
        EXPECT_EQ(by_bash(fmt::format("{} --", command)), options) << command;
    }
}

TEST_F(Completion, BashOffersWordsAndFiles) {
    save_script("bash", "aphotic.bash");
    write_file(path("notes.txt"), "");
    fs::create_directory(path("frames"));
    EXPECT_EQ(by_bash({"pl"}), Words{"plan"});
    EXPECT_EQ(by_bash({"--completion", ""}), (Words{"bash", "zsh", "fish"}));
    EXPECT_EQ(by_bash({"render", "r.toml", "--veil", ""}), (Words{"quadrature", "povray"}));
    EXPECT_EQ(by_bash("render r.toml --veil = p"), Words{"povray"});
    EXPECT_EQ(by_bash({"render", "r.toml", "-o", ""}), Words{"frames"});
    EXPECT_EQ(by_bash({"plan", ""}), (Words{"my-rig.toml", "frames"}));
    EXPECT_EQ(by_bash({"plan", "r.toml", "--tolerance", ""}), Words{});
    EXPECT_EQ(by_bash({"help", "lightm"}), Words{"lightmap"});
    for (const char* command : {"compare", "data", "beam"})
        EXPECT_TRUE(by_bash({command, ""}).contains("my-rig.toml")) << command;
    // An old spelling is not offered and goes on working.
    EXPECT_EQ(by_bash({"lightmap", "--altitude-m", ""}), Words{});
}

TEST_F(Completion, ZshCompletes) {
    if (!is_installed("zsh")) GTEST_SKIP() << "zsh is not installed";
    save_script("zsh", "_aphotic");
    EXPECT_EQ(said_by("/usr/bin/zsh", "-n _aphotic"), "");
    EXPECT_EQ(by_zsh("rend"), "render");
    EXPECT_EQ(by_zsh("plan my"), "plan,my-rig.toml");
    EXPECT_EQ(by_zsh("plan --plo"), "plan,--plot");
    EXPECT_EQ(by_zsh("lightmap --preview-white im"), "lightmap,--preview-white,image");
    EXPECT_EQ(by_zsh("help lightm"), "help,lightmap");
    EXPECT_EQ(by_zsh("beam my"), "beam,my-rig.toml");
}

TEST_F(Completion, FishCompletes) {
    if (!is_installed("fish")) GTEST_SKIP() << "fish is not installed";
    save_script("fish", "aphotic.fish");
    EXPECT_EQ(by_fish("aphotic pla"), Words{"plan"});
    EXPECT_EQ(by_fish("aphotic plan my"), Words{"my-rig.toml"});
    EXPECT_EQ(by_fish("aphotic plan --plo"), std::set<std::string>{"--plot"});
    EXPECT_EQ(by_fish("aphotic lightmap --preview-white "), (Words{"lamp", "image", "none"}));
    EXPECT_EQ(by_fish("aphotic help lightm"), Words{"lightmap"});
    EXPECT_TRUE(by_fish("aphotic beam my").contains("my-rig.toml"));
}

TEST_F(Completion, OfAnotherShellIsRefused) {
    refused("--completion tcsh", "tcsh not in {bash,zsh,fish}");
}

}  // namespace
}  // namespace aphotic::completion_test
