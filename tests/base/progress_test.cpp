// SPDX-License-Identifier: BSD-3-Clause
#include "base/progress.h"

#include "support/has.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace aphotic::progress_test {
namespace {

using namespace std::chrono_literals;

constexpr auto kLong = 1s;  // a thousand times as long as a line waits here

// Standard error, which is a file here, as by a redirection.
template <typename Work>
std::string printed_by(const Work& work) {
    testing::internal::CaptureStderr();
    work();
    return testing::internal::GetCapturedStderr();
}

TEST(Progress, TimesAreInTheUnitsThatPeopleRead) {
    EXPECT_EQ(duration_in_words(0.2), "0 s");
    EXPECT_EQ(duration_in_words(41.4), "41 s");
    EXPECT_EQ(duration_in_words(59.6), "1:00 min");
    EXPECT_EQ(duration_in_words(130.0), "2:10 min");
    EXPECT_EQ(duration_in_words(3599.4), "59:59 min");
    EXPECT_EQ(duration_in_words(3725.0), "1:02 h");
}

TEST(Progress, AFileHasALineWithTheTimeLeft) {
    const std::string printed = printed_by([] {
        ProgressLine line(1ms);
        line.show("rendering", 1.0);
        std::this_thread::sleep_for(kLong);
    });
    EXPECT_TRUE(printed.starts_with("aphotic: rendering: 100 %, 0 s left\n")) << printed;
    EXPECT_EQ(printed.find('\r'), std::string::npos);
}

TEST(Progress, IsSilentUntilItIsDue) {
    EXPECT_EQ(printed_by([] {
                  ProgressLine line(1h);
                  line.show("rendering", 0.25);
                  line.wipe();
              }),
              "");
}

// For the whole process, so in one of its own.
TEST(Progress, IsHushed) {
    const std::string printed = printed_by([] {
        const pid_t child = ::fork();
        if (child == 0) {
            hush_progress();
            ProgressLine line(1ms);
            line.show("rendering", 0.25);
            std::this_thread::sleep_for(50ms);
            line.show("rendering", 0.5);
            ::_exit(0);
        }
        ::waitpid(child, nullptr, 0);
    });
    EXPECT_EQ(printed, "");
}

// What share is left is that of the part under way, not of all that went before.
TEST(Progress, APartHasItsOwnTime) {
    const std::string printed = printed_by([] {
        ProgressLine line(1ms);
        line.show("reading", 0.9);
        std::this_thread::sleep_for(3s);
        line.show("fitting", 0.5);
        std::this_thread::sleep_for(kLong);
    });
    // Of the whole it would be 3 s and more.
    EXPECT_TRUE(has(printed, "fitting: 50 %, 0 s left") || has(printed, "fitting: 50 %, 1 s left"))
        << printed;
}

TEST(Progress, IsRepeatedWhileNothingIsReported) {
    const std::string printed = printed_by([] {
        ProgressLine line(1ms);
        line.show("planning", 0.0);
        std::this_thread::sleep_for(kLong);
    });
    EXPECT_TRUE(has(printed, "aphotic: planning: 0 s so far\naphotic: planning: 0 s so far\n"));
}

}  // namespace
}  // namespace aphotic::progress_test
