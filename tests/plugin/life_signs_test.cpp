// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/life_signs.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <limits>
#include <thread>

namespace aphotic::life_signs_test {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kPoll = std::chrono::milliseconds(5);
// Far more than any wait here takes.
constexpr auto kPatience = std::chrono::seconds(20);

// A process group that computes, in a child of its leader, or sleeps.
class Group {
  public:
    explicit Group(bool computes) : leader_(::fork()) {
        if (leader_ == 0) {
            ::setpgid(0, 0);
            if (computes && ::fork() == 0) {
                while (::getppid() > 0) {
                }
            }
            for (;;) ::pause();
        }
        ::setpgid(leader_, leader_);
    }
    ~Group() {
        ::kill(-leader_, SIGKILL);
        ::waitpid(leader_, nullptr, 0);
    }
    Group(const Group&) = delete;
    Group& operator=(const Group&) = delete;

    [[nodiscard]] pid_t number() const { return leader_; }

  private:
    pid_t leader_;
};

bool comes_true(const std::function<bool()>& condition) {
    const auto deadline = Clock::now() + kPatience;
    while (!condition()) {
        if (Clock::now() > deadline) return false;
        std::this_thread::sleep_for(kPoll);
    }
    return true;
}

TEST(LifeSigns, ProcessorTimeIsThatOfTheWholeGroup) {
    const Group computing(true);
    constexpr std::uintmax_t kSomeTicks = 5;
    EXPECT_TRUE(comes_true([&] { return processor_ticks_of(computing.number()) > kSomeTicks; }));
    const Group sleeping(false);
    EXPECT_LE(processor_ticks_of(sleeping.number()), 1U);
}

TEST(LifeSigns, AreGoneWhenNothingChanges) {
    const Group sleeping(false);
    LifeSigns signs(sleeping.number(), 0.2);
    EXPECT_FALSE(signs.are_gone(7)) << "at once";
    EXPECT_TRUE(comes_true([&] { return signs.are_gone(7); }));
}

// Ten times its patience.
TEST(LifeSigns, AreThereWhileSomethingIsWritten) {
    const Group sleeping(false);
    LifeSigns signs(sleeping.number(), 0.2);
    std::uintmax_t written = 0;
    for (const auto end = Clock::now() + std::chrono::seconds(2); Clock::now() < end;) {
        EXPECT_FALSE(signs.are_gone(++written));
        std::this_thread::sleep_for(kPoll);
    }
}

TEST(LifeSigns, PatienceWithoutEndHasNoEnd) {
    LifeSigns signs(::getpgrp(), std::numeric_limits<double>::infinity());
    for (int i = 0; i < 100; ++i) EXPECT_FALSE(signs.are_gone(0));
}

}  // namespace
}  // namespace aphotic::life_signs_test
