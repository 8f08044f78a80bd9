// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/life_signs.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
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
constexpr auto kPatience = std::chrono::seconds(120);

// Leaves this process one processor, which it shares with others that do the same.
void stay_on_one_processor() {
    cpu_set_t allowed;
    ::sched_getaffinity(0, sizeof allowed, &allowed);
    std::size_t first = 0;
    while (!CPU_ISSET(first, &allowed)) ++first;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(first, &one);
    ::sched_setaffinity(0, sizeof one, &one);
}

// Gets the processor when nobody else wants it: next to a program that computes, a three-hundredth.
void come_last() {
    stay_on_one_processor();
    const sched_param none{};
    ::sched_setscheduler(0, SCHED_IDLE, &none);
}

// A process group that computes, in a child of its leader, or sleeps.
class Group {
  public:
    explicit Group(
        bool computes, void (*prepare)() = [] {})
        : leader_(::fork()) {
        if (leader_ == 0) {
            ::prctl(PR_SET_PDEATHSIG, SIGKILL);
            ::setpgid(0, 0);
            prepare();
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

// Five times its patience, in which it gets three hundredths of a second: it prints nothing and
// uses next to nothing, and would if it could.
TEST(LifeSigns, AreThereWhileOthersHaveTheProcessor) {
    const Group starved(true, come_last);
    const Group busy(true, stay_on_one_processor);
    LifeSigns signs(starved.number(), 0.2);
    for (const auto end = Clock::now() + std::chrono::seconds(1); Clock::now() < end;) {
        ASSERT_FALSE(signs.are_gone(7));
        std::this_thread::sleep_for(kPoll);
    }
}

TEST(LifeSigns, AreGoneOfASleeperWhileOthersHaveTheProcessor) {
    const Group sleeping(false, come_last);
    const Group busy(true, stay_on_one_processor);
    LifeSigns signs(sleeping.number(), 0.2);
    EXPECT_TRUE(comes_true([&] { return signs.are_gone(7); }));
}

TEST(LifeSigns, PatienceWithoutEndHasNoEnd) {
    LifeSigns signs(::getpgrp(), std::numeric_limits<double>::infinity());
    for (int i = 0; i < 100; ++i) EXPECT_FALSE(signs.are_gone(0));
}

}  // namespace
}  // namespace aphotic::life_signs_test
