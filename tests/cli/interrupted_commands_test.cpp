// SPDX-License-Identifier: BSD-3-Clause
//
// Every command that writes, but for render, which has tests of its own, struck at random moments
// by SIGINT, SIGTERM and SIGKILL. Nothing is left half written or running, and the
// same command given again ends in the same files.
#include "base/sha256.h"
#include "support/command_test.h"
#include "support/command_under_way.h"
#include "support/small_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

namespace aphotic::interrupted_commands_test {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kBlows = 6;
constexpr int kMostBlows = 60;  // when all come too late

struct Struck {
    const char* name;
    Arguments arguments;
};
void PrintTo(const Struck& struck, std::ostream* out) {
    *out << struck.name;
}

const std::vector<Struck> kCommands{
    {"Baseline", "baseline local-equalisation raw -o out"},
    {"Correct", "correct raw --rig rig.toml --nav nav.eic -o out"},
    {"Compare", "compare raw/0.exr raw/1.exr --report out/page.html"},
    {"Generate", "generate rig.toml -o out --bands 30"},
    {"Integrate", "integrate render -o out"},
    {"Lightmap", "lightmap rig.toml --per-cone -o out/map.exr"},
    {"MapsByAltitude", "lightmap rig.toml --altitude 1:3:0.25 -o out"},
    {"Oplab", "lightmap rig.toml --altitude 1:3:0.1 --export oplab -o out"},
    {"Observe", "observe raw --nav nav.eic --altitude 2 -o out/map.exr"},
    {"Plan", "plan rig.toml --plot out/plan.svg"},
    {"Survey", "survey rig.toml --images 8 -o out"},
    {"Study", "study rig.toml -o out --quick"},
    {"Trace", "trace rig.toml -o out"},
    {"Validate", "validate rig.toml -o out --bands 6"}};

// What a file of these names says depends on the clock, on the frames' own times, or on what an
// earlier run had done.
bool tells_the_time(const fs::path& file) {
    static const Arguments kNames(
        "baseline.json correction.json corrected.jsonl manifest.json validation.json trace.json "
        "report.html study.html study.csv study.json");
    const fs::path folder = file.parent_path().filename();
    return folder == "frames" || folder == "logs" || folder == "settings" ||
           folder == "reference" ||
           std::ranges::find(kNames, file.filename().string()) != kNames.end();
}

// By the file's path below the folder, its checksum.
std::map<std::string, std::string> results_in(const fs::path& folder) {
    std::map<std::string, std::string> results;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;
        results[fs::relative(entry.path(), folder).string()] =
            tells_the_time(entry.path()) ? "" : sha256_of_file(entry.path());
    }
    return results;
}

class InterruptedCommand : public CommandTest, public testing::WithParamInterface<Struck> {
  protected:
    void SetUp() override {
        home_ = fs::canonical(home_);
        write_file(path("rig.toml"), small_scene("habcam.toml"));
        const std::string& command = GetParam().arguments.front();
        if (command == "integrate") done("render rig.toml -o render --bands 3");
        if (command == "observe" || command == "baseline" || command == "compare" ||
            command == "correct")
            take_images();
        clear("tmp");
        clear("out");
    }

    void clear(const char* folder) {
        fs::remove_all(path(folder));
        fs::create_directory(path(folder));
    }

    void take_images() {
        constexpr int kImages = 12;
        fs::create_directory(path("raw"));
        done("lightmap rig.toml -o raw/0.exr");
        std::string lines;
        for (int i = 0; i < kImages; ++i) {
            if (i > 0) fs::copy_file(path("raw/0.exr"), home_ / fmt::format("raw/{}.exr", i));
            lines += fmt::format("{}.exr 2 0 0\n", i);
        }
        write_file(path("nav.eic"), lines);
    }

    // Whether it was struck before it ended.
    bool strike(double delay_s, int signal) {
        Command command(home_, GetParam().arguments, {{"TMPDIR", path("tmp").string()}});
        const auto moment = Clock::now() + std::chrono::duration<double>(delay_s);
        while (Clock::now() < moment && !command.has_ended()) std::this_thread::sleep_for(kPoll);
        if (!command.has_ended()) ::kill(command.pid(), signal);
        const int status = command.wait();
        EXPECT_TRUE(status == 0 || status == 128 + signal) << text_of("stderr");
        expect_no_process_in(home_);
        if (status != 128 + SIGKILL) {
            EXPECT_TRUE(fs::is_empty(path("tmp"))) << "left in TMPDIR";
            expect_no_leftovers(path("out"), fmt::format("-{}", command.pid()));
        }
        clear("tmp");
        if (status == 0) clear("out");  // it came too late: the next begins afresh
        return status != 0;
    }
};

TEST_P(InterruptedCommand, GivenAgainEndsInTheSameFiles) {
    const unsigned seed = seed_of_this_run();
    fmt::print("seed {} (APHOTIC_TEST_SEED)\n", seed);
    const auto start = Clock::now();
    done(GetParam().arguments);
    const double whole_s = std::chrono::duration<double>(Clock::now() - start).count();
    const auto expected = results_in(path("out"));
    ASSERT_FALSE(expected.empty());
    clear("out");

    std::mt19937 random(seed);
    int struck = 0;
    for (int i = 0; i < kBlows || (struck == 0 && i < kMostBlows); ++i) {
        const int signal = std::array{SIGINT, SIGTERM, SIGKILL}[static_cast<std::size_t>(i % 3)];
        struck += strike(std::uniform_real_distribution(0.0, whole_s)(random), signal) ? 1 : 0;
    }
    EXPECT_GT(struck, 0);
    done(GetParam().arguments);
    EXPECT_EQ(results_in(path("out")), expected);
}

INSTANTIATE_TEST_SUITE_P(All,
                         InterruptedCommand,
                         testing::ValuesIn(kCommands),
                         [](const auto& struck) { return std::string(struck.param.name); });

}  // namespace
}  // namespace aphotic::interrupted_commands_test
