// SPDX-License-Identifier: BSD-3-Clause
//
// A sweep as a user runs it, by one machine: its tasks, how they stand, what is collected.
#include "support/command_under_way.h"
#include "support/page.h"
#include "support/run_command.h"
#include "support/small_sweep.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace aphotic::cli_sweep_test {
namespace {

namespace fs = std::filesystem;

constexpr auto kLongest = std::chrono::minutes(15);  // for what hangs
constexpr const char* kResult = "task-0001/result.json";

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

class CommandSweep : public testing::Test {
  protected:
    [[nodiscard]] CommandResult sweep(
        const std::vector<std::string>& arguments,
        const std::map<std::string, std::string>& environment = {}) const {
        std::vector<std::string> all{"sweep"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        return run_aphotic(small_.folder(), all, environment);
    }

    void make(const std::string& command, const std::string& more) const {
        small_.write(command, more);
        const CommandResult run = sweep({"sweep.toml", "-o", "out"});
        ASSERT_EQ(run.status, 0) << run.err;
    }

    [[nodiscard]] fs::path out(const std::string& file) const {
        return small_.folder() / "out" / file;
    }

    SmallSweep small_;
};

TEST_F(CommandSweep, ATaskMakesWhatTheCommandMakesByItself) {
    make("lightmap", kThreeWaters);
    for (const char* number : {"1", "2", "3"}) {
        const CommandResult run = sweep({"out", "--task", number});
        ASSERT_EQ(run.status, 0) << run.err;
        EXPECT_EQ(run.out, "");
    }
    const std::vector<std::pair<std::string, std::string>> tasks{
        {"0.5", "task-0001"}, {"1", "task-0002"}, {"2", "task-0003"}};
    for (const auto& [multiple, task] : tasks) {
        const CommandResult alone =
            run_aphotic(small_.folder(),
                        {"lightmap", "rig.toml", "--water-multiple", multiple, "-o", "alone.exr"});
        ASSERT_EQ(alone.status, 0) << alone.err;
        // Metadata name another rig's digest; samples do not.
        const CommandResult same =
            run_aphotic(small_.folder(),
                        {"compare", "alone.exr", "out/" + task + "/out/lightmap.exr", "--json"});
        EXPECT_EQ(same.status, 0) << same.out << same.err;
    }
}

TEST_F(CommandSweep, ATaskThatIsDoneIsNotDoneAgain) {
    make("lightmap", kThreeWaters);
    ASSERT_EQ(sweep({"out", "--task", "1"}).status, 0);
    const std::string map = read_text_file(out("task-0001/out/lightmap.exr"));
    fs::remove(out("task-0001/out/lightmap.exr"));
    ASSERT_EQ(sweep({"out", "--task", "1"}).status, 0);
    EXPECT_FALSE(fs::exists(out("task-0001/out/lightmap.exr")));
    fs::remove(out(kResult));
    ASSERT_EQ(sweep({"out", "--task", "1"}).status, 0);
    EXPECT_EQ(read_text_file(out("task-0001/out/lightmap.exr")), map);
}

TEST_F(CommandSweep, AnotherRigIsAnotherTask) {
    make("lightmap", kThreeWaters);
    ASSERT_EQ(sweep({"out", "--task", "1"}).status, 0);
    make("lightmap", "[[vary]]\nkey = \"water.multiple\"\nvalues = [0.7, 1, 2]\n");
    const CommandResult status = sweep({"out", "--status"});
    EXPECT_EQ(status.status, 1);
    EXPECT_TRUE(contains(status.out, "0 done")) << status.out;
}

TEST_F(CommandSweep, TellsHowItsTasksStand) {
    make("lightmap", kThreeWaters);
    ASSERT_EQ(sweep({"out", "--task", "2"}).status, 0);
    // Its table is gone.
    fs::remove(out("task-0003/lamps/lamp.csv"));
    const CommandResult failed = sweep({"out", "--task", "3"});
    EXPECT_EQ(failed.status, 2);
    EXPECT_TRUE(failed.err.starts_with("aphotic: task 3: ")) << failed.err;
    EXPECT_EQ(lines_of(failed.err).size(), 1U);
    CommandResult status = sweep({"out", "--status"});
    EXPECT_EQ(status.status, 1);
    EXPECT_TRUE(status.out.starts_with(
        "3 tasks: 1 done, 1 failed, 0 interrupted, 0 running, 1 pending\n  task 3 failed: "))
        << status.out;
    EXPECT_TRUE(contains(status.out, "lamp.csv")) << status.out;
    EXPECT_TRUE(contains(status.out, "  not done: 1,3\n")) << status.out;

    // Repaired, a failed task is run again.
    fs::copy(small_.folder() / "lamps/lamp.csv", out("task-0003/lamps/lamp.csv"));
    EXPECT_EQ(sweep({"out", "--task", "3"}).status, 0);
    EXPECT_EQ(sweep({"out", "--task", "1"}).status, 0);
    status = sweep({"out", "--status", "--json"});
    EXPECT_EQ(status.status, 0);
    const auto json = nlohmann::json::parse(status.out);
    EXPECT_EQ(json.at("done"), 3);
    EXPECT_EQ(json.at("not_done"), "");
    EXPECT_EQ(json.at("failures").size(), 0U);
}

TEST_F(CommandSweep, CollectsKeysResultsTimesAndPictures) {
    make("lightmap",
         std::string(kThreeWaters) +
             "[[vary]]\nkey = \"strobe.fore.position_m\"\nvalues = [[0.5, 0, 0], [0.6, 0, 0]]\n");
    for (int number = 1; number <= 5; ++number)
        ASSERT_EQ(sweep({"out", "--task", std::to_string(number)}).status, 0);
    const CommandResult collected = sweep({"out", "--collect"});
    EXPECT_EQ(collected.status, 1);  // one is not done
    EXPECT_TRUE(contains(collected.out, "out/results.csv")) << collected.out;
    const std::vector<std::string> lines = lines_of(read_text_file(out("results.csv")));
    ASSERT_EQ(lines.size(), 7U);
    EXPECT_TRUE(lines[0].starts_with(
        "task,water.multiple,strobe.fore.position_m,state,exit_status,task_seconds,message,"))
        << lines[0];
    EXPECT_TRUE(lines[1].starts_with("1,0.5,0.5 0 0,done,0,")) << lines[1];
    EXPECT_TRUE(lines[4].starts_with("4,1,0.6 0 0,done,0,")) << lines[4];
    EXPECT_TRUE(lines[6].starts_with("6,2,0.6 0 0,pending,,,,")) << lines[6];
    const auto cells = [](const std::string& line) {
        bool is_quoted = false;
        return std::ranges::count_if(line, [&](char c) {
            if (c == '"') is_quoted = !is_quoted;
            return c == ',' && !is_quoted;
        });
    };
    for (const std::string& line : lines) EXPECT_EQ(cells(line), cells(lines[0])) << line;
    EXPECT_TRUE(contains(lines[0], ",altitude_m,")) << lines[0];
    EXPECT_TRUE(contains(lines[0], ",peak.0,")) << lines[0];

    const std::string page = read_text_file(out("contact_sheet.html"));
    EXPECT_EQ(first_unbalanced(page), "");
    EXPECT_TRUE(contains(words_of(page), "5 of 6 tasks done")) << words_of(page);
    std::size_t pictures = 0;
    for (std::size_t at = page.find("<img"); at != std::string::npos;
         at = page.find("<img", at + 1))
        ++pictures;
    EXPECT_EQ(pictures, 5U);
    expect_no_leftovers(out(""));
}

// Two machines that share a folder see no locks of each other.
TEST_F(CommandSweep, TasksSideBySideNeedNoLocks) {
    make("lightmap", kThreeWaters);
    ASSERT_EQ(sweep({"sweep.toml", "-o", "alone"}).status, 0);
    for (const char* number : {"1", "2"}) ASSERT_EQ(sweep({"alone", "--task", number}).status, 0);
    const std::map<std::string, std::string> no_locks{{"LD_PRELOAD", APHOTIC_NO_LOCKS},
                                                      {"ASAN_OPTIONS", "verify_asan_link_order=0"}};
    std::vector<std::unique_ptr<Command>> commands;
    std::array<TempFolder, 2> lanes;
    for (std::size_t i = 0; i < lanes.size(); ++i)
        commands.push_back(std::make_unique<Command>(
            lanes[i].path(),
            std::vector<std::string>{"sweep", out("").string(), "--task", std::to_string(i + 1)},
            no_locks));
    for (const auto& command : commands) EXPECT_EQ(command->wait(kLongest), 0);
    for (const char* file : {"task-0001/out/lightmap.exr", "task-0002/out/lightmap.exr"})
        EXPECT_EQ(read_text_file(out(file)), read_text_file(small_.folder() / "alone" / file));
    expect_no_leftovers(out(""));
}

TEST_F(CommandSweep, AKilledTaskIsInterruptedAndThenDone) {
    make("lightmap", kThreeWaters);
    // As one that was killed leaves it, an hour ago; and a moment ago.
    write_file(out("task-0001/running"), "");
    write_file(out("task-0002/running"), "");
    fs::last_write_time(out("task-0001/running"),
                        fs::file_time_type::clock::now() - std::chrono::hours(1));
    const CommandResult status = sweep({"out", "--status"});
    EXPECT_TRUE(contains(status.out, "1 interrupted, 1 running, 1 pending")) << status.out;
    ASSERT_EQ(sweep({"out", "--task", "1"}).status, 0);
    EXPECT_FALSE(fs::exists(out("task-0001/running")));
}

TEST_F(CommandSweep, SaysWhatIsWrong) {
    make("lightmap", kThreeWaters);
    const auto expect = [&](const std::vector<std::string>& arguments, const std::string& part) {
        const CommandResult run = sweep(arguments);
        EXPECT_EQ(run.status, 2) << run.err;
        EXPECT_EQ(run.out, "");
        EXPECT_TRUE(contains(run.err, part)) << run.err;
    };
    expect({"out", "--task", "4"}, "--task: found 4; allowed: 1 to 3");
    expect({"out", "--task", "0"}, "--task");
    expect({"out"}, "found none of -o, --task, --status and --collect");
    expect({"lamps", "--status"}, "lamps: found no sweep");
    expect({"sweep.toml", "-o", "other", "--status"}, "excludes");
    expect({"no-such.toml", "-o", "other"}, "no-such.toml: cannot be read");
    EXPECT_FALSE(fs::exists(small_.folder() / "other"));
}

TEST_F(CommandSweep, ArgumentsThatItsCommandDoesNotTakeAreFoundBeforeAnyTask) {
    const std::vector<std::pair<std::string, std::string>> wrong{
        {R"("--prevew", "x.png")", "found --prevew; no such option: did you mean --preview?"},
        {R"("--model-tolerance", "much")", "much"},
        {R"("--help")", "found --help or --version; allowed: "}};
    for (const auto& [arguments, found] : wrong) {
        small_.write("lightmap", "arguments = [" + arguments + "]\n" + kThreeWaters);
        const CommandResult run = sweep({"sweep.toml", "-o", "out"});
        EXPECT_EQ(run.status, 2);
        EXPECT_EQ(run.err.find("aphotic: sweep.toml: arguments: "), 0U) << run.err;
        EXPECT_NE(run.err.find(found), std::string::npos) << run.err;
        EXPECT_FALSE(fs::exists(out("")));
    }
}

// run-task takes its number from the argument or from the engine.
TEST_F(CommandSweep, RunTaskTakesItsNumberFromTheEngine) {
    make("lightmap", kThreeWaters);
    const auto run = [&](const std::vector<std::string>& arguments,
                         const std::map<std::string, std::string>& environment) {
        return run_process({.executable = out("run-task"),
                            .arguments = arguments,
                            .folder = "/",
                            .environment = environment,
                            .log = small_.folder() / "log"},
                           600.0)
            .exit_code;
    };
    const auto is_done = [&](int number) {
        return fs::exists(out("task-000" + std::to_string(number) + "/result.json"));
    };
    EXPECT_EQ(run({"1"}, {}), 0);
    EXPECT_TRUE(is_done(1));
    EXPECT_EQ(run({}, {{"SLURM_ARRAY_TASK_ID", "2"}}), 0);
    EXPECT_TRUE(is_done(2));
    EXPECT_EQ(run({}, {{"PBS_ARRAY_INDEX", "1"}, {"OFFSET", "2"}}), 0);
    EXPECT_TRUE(is_done(3));
    EXPECT_EQ(run({}, {{"SGE_TASK_ID", "undefined"}}), 2);  // of a job that is no array
    EXPECT_EQ(run({"0"}, {}), 2);
    EXPECT_EQ(run({"08"}, {}), 2);  // no octal number
    EXPECT_EQ(run({"4"}, {}), 2);
    EXPECT_TRUE(contains(read_text_file(small_.folder() / "log"), "allowed: 1 to 3"));
}

}  // namespace
}  // namespace aphotic::cli_sweep_test
