// SPDX-License-Identifier: BSD-3-Clause
//
// Each case in a process of its own, which the signal may end.
#include "base/interruption.h"

#include "base/atomic_file.h"
#include "plugin/scratch_folder.h"
#include "tests/support/temp_folder.h"
#include "tests/support/thread_sanitizer.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iterator>
#include <thread>

namespace aphotic::interruption_test {
namespace {

constexpr int kWentOn = 40;
constexpr int kWasTold = 41;

// What a shell would tell of a process that does this.
int status_of(const std::function<int()>& action) {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(action());
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

TEST(Interruption, WithoutAHoldASignalEndsAtOnce) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        EXPECT_EQ(status_of([&] {
                      { const InterruptionHold gone; }
                      ::raise(signal);
                      return kWentOn;
                  }),
                  128 + signal);
    }
}

TEST(Interruption, LastWordsAreSaidByASignalAlone) {
    testing::internal::CaptureStderr();
    EXPECT_EQ(status_of([] {
                  const LastWords words("images are kept\n");
                  ::raise(SIGTERM);
                  return kWentOn;
              }),
              128 + SIGTERM);
    EXPECT_EQ(status_of([] {
                  { const LastWords gone("images are kept\n"); }
                  return kWentOn;
              }),
              kWentOn);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "images are kept\n");
}

TEST(Interruption, IsToldToWhoeverAsks) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        EXPECT_EQ(status_of([&] {
                      const InterruptionHold hold;
                      throw_if_interrupted();
                      ::raise(signal);
                      try {
                          throw_if_interrupted();
                      } catch (const Interrupted& interrupted) {
                          return interrupted.signal() == signal ? kWasTold : kWentOn;
                      }
                      return kWentOn;
                  }),
                  kWasTold);
    }
}

// Without the hold nearly every one of these processes dies with its text half written.
TEST(Interruption, WaitsUntilATextIsWritten) {
    constexpr int kProcesses = 20;
    for (int k = 0; k < kProcesses; ++k) {
        const TempFolder folder;
        const auto file = folder.path() / "note.json";
        const pid_t child = ::fork();
        if (child == 0) {
            for (;;) write_text_file(file, "{}");
        }
        while (!std::filesystem::exists(file)) std::this_thread::yield();
        ::kill(child, SIGTERM);
        int status = 0;
        ::waitpid(child, &status, 0);
        EXPECT_TRUE(is_ended_by(status, SIGTERM)) << status;
        const std::filesystem::directory_iterator left(folder.path());
        EXPECT_EQ(std::distance(begin(left), end(left)), 1) << "files, the whole one included";
    }
}

TEST(Interruption, ThatNobodyAsksAboutEndsWithTheLastHold) {
    EXPECT_EQ(status_of([] {
                  auto outer = std::make_unique<InterruptionHold>();
                  {
                      const InterruptionHold inner;
                      ::raise(SIGTERM);
                  }
                  // Still here: the outer one holds.
                  ::write(STDERR_FILENO, "", 0);
                  outer.reset();
                  return kWentOn;
              }),
              128 + SIGTERM);
}

TEST(Interruption, ThatWasToldDoesNotEndTwice) {
    EXPECT_EQ(status_of([] {
                  try {
                      const InterruptionHold hold;
                      ::raise(SIGINT);
                      throw_if_interrupted();
                  } catch (const Interrupted&) {
                      return kWasTold;
                  }
                  return kWentOn;
              }),
              kWasTold);
}

TEST(Interruption, EndsAsTheSignalWould) {
    EXPECT_EQ(status_of([]() -> int { end_by_signal(SIGINT); }), 128 + SIGINT);
}

// As nohup starts us.
TEST(Interruption, IgnoredSignalsStayIgnored) {
    EXPECT_EQ(status_of([] {
                  ::signal(SIGHUP, SIG_IGN);
                  const InterruptionHold hold;
                  ::raise(SIGHUP);
                  throw_if_interrupted();
                  return kWentOn;
              }),
              kWentOn);
}

TEST(Interruption, LeavesNoScratchFolder) {
    const TempFolder folder;
    EXPECT_EQ(status_of([&] {
                  ::setenv("TMPDIR", folder.path().c_str(), 1);
                  const ScratchFolder scratch;
                  if (std::filesystem::is_empty(folder.path())) return kWentOn;
                  ::raise(SIGINT);
                  return kWasTold;
              }),
              128 + SIGINT);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace aphotic::interruption_test
