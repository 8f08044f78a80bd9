// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/process.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "support/refusal.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <thread>
#include <utility>

namespace aphotic::process_test {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// Far more than a shell takes to start on a machine with far more work than cores.
constexpr double kPatienceS = 120.0;
constexpr auto kPatience = std::chrono::duration<double>(kPatienceS);
constexpr auto kPoll = std::chrono::milliseconds(5);

// A shell script run in a folder of its own.
class Script {
  public:
    explicit Script(const std::string& text) {
        request_.executable = "/bin/sh";
        request_.arguments = {"-c", text};
        request_.folder = folder_.path();
        request_.log = folder_.path() / "log.txt";
    }

    ProcessRequest& request() { return request_; }
    [[nodiscard]] fs::path file(const std::string& name) const { return folder_.path() / name; }
    [[nodiscard]] std::string log() const { return read_text_file(request_.log); }
    ProcessEnd run() { return run_process(request_, kPatienceS); }

  private:
    TempFolder folder_;
    ProcessRequest request_;
};

bool comes_true(const std::function<bool()>& condition) {
    const auto deadline = Clock::now() + kPatience;
    while (!condition()) {
        if (Clock::now() > deadline) return false;
        std::this_thread::sleep_for(kPoll);
    }
    return true;
}

// Waits until the script has written its process number to this file.
pid_t pid_in(const fs::path& file) {
    const bool written =
        comes_true([&] { return fs::exists(file) && read_text_file(file).ends_with('\n'); });
    return written ? static_cast<pid_t>(std::stol(read_text_file(file))) : -1;
}

bool runs(pid_t pid) {
    return ::kill(pid, 0) == 0;
}

// A zombie that nobody has buried yet runs no more.
bool is_gone(pid_t pid) {
    if (!runs(pid)) return true;
    const fs::path stat = "/proc/" + std::to_string(pid) + "/stat";
    return !fs::exists(stat) || read_text_file(stat).find(") Z ") != std::string::npos;
}

TEST(Process, TellsTheExitStatus) {
    for (const int status : {0, 1, 2, 255}) {
        const ProcessEnd end = Script("exit " + std::to_string(status)).run();
        EXPECT_EQ(end.exit_code, status);
        EXPECT_EQ(end.signal, 0);
        EXPECT_EQ(end.succeeded(), status == 0);
        EXPECT_EQ(end.words(), "exit status " + std::to_string(status));
    }
}

TEST(Process, TellsTheSignalThatEndedIt) {
    for (const int signal : {SIGKILL, SIGTERM}) {
        const ProcessEnd end = Script("kill -" + std::to_string(signal) + " $$").run();
        EXPECT_EQ(end.signal, signal);
        EXPECT_FALSE(end.succeeded());
        EXPECT_EQ(end.words(), "killed by signal " + std::to_string(signal));
    }
}

TEST(Process, WritesBothOutputsToTheLogInTheirOrder) {
    Script script("echo one; echo two >&2; echo three");
    script.run();
    EXPECT_EQ(script.log(), "one\ntwo\nthree\n");
}

TEST(Process, StartsTheLogAfresh) {
    Script script("echo new");
    write_file(script.request().log, "an old log that is longer than the new one\n");
    script.run();
    EXPECT_EQ(script.log(), "new\n");
}

TEST(Process, PassesArgumentsAsTheyAre) {
    Script script("");
    script.request().arguments = {
        "-c", "for a; do echo \"[$a]\"; done", "sh", "two words", "", "$HOME", "*", "a\"b'c"};
    script.run();
    EXPECT_EQ(script.log(), "[two words]\n[]\n[$HOME]\n[*]\n[a\"b'c]\n");
}

TEST(Process, RunsInItsFolder) {
    Script script("pwd -P");
    script.run();
    EXPECT_EQ(script.log(), fs::canonical(script.request().folder).string() + "\n");
}

TEST(Process, HasNoInput) {
    Script script("cat; echo end");
    EXPECT_TRUE(script.run().succeeded());
    EXPECT_EQ(script.log(), "end\n");
}

TEST(Process, AddsReplacesAndRemovesVariables) {
    ASSERT_EQ(::setenv("APHOTIC_TEST_KEPT", "kept", 1), 0);
    ASSERT_EQ(::setenv("APHOTIC_TEST_REPLACED", "before", 1), 0);
    ASSERT_EQ(::setenv("APHOTIC_TEST_REMOVED", "before", 1), 0);
    Script script(
        "echo \"$APHOTIC_TEST_KEPT $APHOTIC_TEST_ADDED $APHOTIC_TEST_REPLACED "
        "${APHOTIC_TEST_REMOVED-none}\"");
    script.request().environment = {{"APHOTIC_TEST_ADDED", "added"},
                                    {"APHOTIC_TEST_REPLACED", "after"},
                                    {"APHOTIC_TEST_REMOVED", ""}};
    script.run();
    EXPECT_EQ(script.log(), "kept added after none\n");
    EXPECT_STREQ(std::getenv("APHOTIC_TEST_REMOVED"), "before") << "our own stays as it was";
    EXPECT_EQ(std::getenv("APHOTIC_TEST_ADDED"), nullptr);
    for (const char* name :
         {"APHOTIC_TEST_KEPT", "APHOTIC_TEST_REPLACED", "APHOTIC_TEST_REMOVED"}) {
        ::unsetenv(name);
    }
}

TEST(Process, IsPolledWithoutWaiting) {
    Script script("while [ ! -e go ]; do sleep 0.01; done; exit 3");
    Process process(script.request());
    EXPECT_FALSE(process.poll().has_value());
    write_file(script.file("go"), "");
    std::optional<ProcessEnd> end;
    EXPECT_TRUE(comes_true([&] { return (end = process.poll()).has_value(); }));
    ASSERT_TRUE(end.has_value());
    EXPECT_EQ(end->exit_code, 3);
    // And again, for whoever asks twice.
    end = process.poll();
    ASSERT_TRUE(end.has_value());
    EXPECT_EQ(end->exit_code, 3);
}

TEST(Process, ThatIsMissingIsARunErrorThatNamesIt) {
    Script script("");
    script.request().executable = script.file("none");
    EXPECT_EQ(run_error_of([&] { script.run(); }),
              script.file("none").string() + ": cannot be started: No such file or directory");
    write_file(script.file("none"), "no program");
    EXPECT_EQ(run_error_of([&] { script.run(); }),
              script.file("none").string() + ": cannot be started: Permission denied");
}

TEST(Process, WithoutItsFolderOrLogIsARunErrorThatNamesIt) {
    Script elsewhere("true");
    elsewhere.request().folder = elsewhere.file("missing");
    EXPECT_EQ(
        run_error_of([&] { elsewhere.run(); }),
        "/bin/sh: cannot be started: " + elsewhere.file("missing").string() + " is not a folder");
    Script unheard("touch ran");
    unheard.request().log = unheard.file("missing") / "log.txt";
    EXPECT_EQ(run_error_of([&] { unheard.run(); }),
              unheard.request().log.string() + ": cannot be written: No such file or directory");
    EXPECT_FALSE(fs::exists(unheard.file("ran"))) << "it was started all the same";
}

TEST(Process, IsKilledWhenItsTimeIsUp) {
    Script script("echo $$ > pid; exec sleep 60");
    constexpr double kTimeoutS = 0.5;
    const auto before = Clock::now();
    EXPECT_EQ(run_error_of([&] { static_cast<void>(run_process(script.request(), kTimeoutS)); }),
              "/bin/sh: did not answer within 0.5 s");
    EXPECT_LT(Clock::now() - before, kPatience);
    const pid_t pid = pid_in(script.file("pid"));
    ASSERT_GT(pid, 0);
    EXPECT_FALSE(runs(pid)) << pid << " still runs";
}

TEST(Process, IsGoneWithItsObject) {
    Script script("echo $$ > pid; exec sleep 60");
    pid_t pid = -1;
    {
        const Process process(script.request());
        pid = pid_in(script.file("pid"));
        ASSERT_GT(pid, 0);
        EXPECT_TRUE(runs(pid));
    }
    // Not even a zombie: its number is free.
    EXPECT_FALSE(runs(pid)) << pid << " still runs";
}

// A program of ours that is killed takes the child with it, though no destructor runs.
TEST(Process, IsGoneWhenWeAreKilled) {
    Script script("echo $$ > pid; exec sleep 60");
    const pid_t ours = ::fork();
    ASSERT_GE(ours, 0);
    if (ours == 0) {
        const Process process(script.request());
        ::pause();
        ::_exit(0);
    }
    const pid_t pid = pid_in(script.file("pid"));
    EXPECT_GT(pid, 0);
    EXPECT_TRUE(pid > 0 && runs(pid));
    ::kill(ours, SIGKILL);
    ::waitpid(ours, nullptr, 0);
    EXPECT_TRUE(pid > 0 && comes_true([&] { return is_gone(pid); })) << pid << " still runs";
}

// POV-Ray, started by a script around it.
TEST(Process, TakesWhatItStartedWithIt) {
    Script script("sleep 60 & echo $! > pid; trap '' TERM INT; wait; wait");
    pid_t pid = -1;
    {
        const Process process(script.request());
        pid = pid_in(script.file("pid"));
        ASSERT_GT(pid, 0);
        EXPECT_FALSE(is_gone(pid));
    }
    EXPECT_TRUE(comes_true([&] { return is_gone(pid); })) << pid << " still runs";
}

TEST(Process, ThatEndedLeavesNothingRunning) {
    Script script("sleep 60 & echo $! > pid; exit 3");
    EXPECT_EQ(script.run().exit_code, 3);
    const pid_t pid = pid_in(script.file("pid"));
    ASSERT_GT(pid, 0);
    EXPECT_TRUE(comes_true([&] { return is_gone(pid); })) << pid << " still runs";
}

// Short, so that the test is; the looks are an eighth of it apart.
constexpr double kShortStallS = 0.4;

Clock::time_point after_twice_the_stall() {
    return Clock::now() + std::chrono::duration_cast<Clock::duration>(
                              std::chrono::duration<double>(2.0 * kShortStallS));
}

// Polls the script, once it runs, until it is stopped: what was said then.
std::string why_stopped(Script& script) {
    script.request().stall_s = kShortStallS;
    Process process(script.request());
    const pid_t pid = pid_in(script.file("pid"));
    EXPECT_GT(pid, 0);
    const std::string why =
        run_error_of([&] { comes_true([&] { return process.poll().has_value(); }); });
    EXPECT_TRUE(pid > 0 && is_gone(pid));
    return why;
}

TEST(Process, WithoutASignOfLifeIsStopped) {
    Script script("trap '' TERM INT; echo $$ > pid; exec sleep 60");
    EXPECT_EQ(why_stopped(script),
              "/bin/sh was stopped: for 0.4 s it neither printed anything nor used the processor\n"
              "Its log: " +
                  script.request().log.string());
}

TEST(Process, PutToSleepIsStopped) {
    Script script("echo $$ > pid; kill -STOP $$");
    EXPECT_NE(why_stopped(script).find("was stopped: for 0.4 s"), std::string::npos);
}

// Twice its patience. However slow the machine is: the log is longer at each look.
TEST(Process, ThatPrintsIsLeftAlone) {
    Script script("exec sleep 60");
    script.request().stall_s = kShortStallS;
    Process process(script.request());
    for (const auto end = after_twice_the_stall(); Clock::now() < end;) {
        std::ofstream(script.request().log, std::ios::app) << "more\n";
        ASSERT_NO_THROW(EXPECT_FALSE(process.poll().has_value()));
        std::this_thread::sleep_for(kPoll);
    }
}

// Nor does it have to get the processor: it wants it. The child computes, the program itself waits.
TEST(Process, ThatComputesIsLeftAlone) {
    Script script("(echo 1 > started; while :; do :; done) & wait");
    script.request().stall_s = kShortStallS;
    Process process(script.request());
    ASSERT_GT(pid_in(script.file("started")), 0);
    for (const auto end = after_twice_the_stall(); Clock::now() < end;) {
        ASSERT_NO_THROW(EXPECT_FALSE(process.poll().has_value()));
        std::this_thread::sleep_for(kPoll);
    }
}

TEST(Process, ThatPrintsWithoutEndIsStopped) {
    Script script("echo $$ > pid; exec yes");
    EXPECT_EQ(run_error_of([&] { script.run(); }),
              "/bin/sh was stopped: it printed more than 64 MiB\nIts log: " +
                  script.request().log.string());
    EXPECT_TRUE(is_gone(pid_in(script.file("pid"))));
}

}  // namespace
}  // namespace aphotic::process_test
