// SPDX-License-Identifier: BSD-3-Clause
#include "base/folder_lock.h"

#include "base/error.h"
#include "tests/support/temp_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>

namespace aphotic::folder_lock_test {
namespace {

std::string refusal(const std::filesystem::path& folder, FolderUse use) {
    try {
        const FolderLock lock(folder, use);
    } catch (const RunError& error) {
        return error.what();
    }
    return "no error";
}

// A process that holds the folder until it is killed.
class Holder {
  public:
    Holder(const std::filesystem::path& folder, FolderUse use) {
        std::array<int, 2> ready{};
        if (::pipe(ready.data()) != 0) throw std::runtime_error("no pipe");
        pid_ = ::fork();
        if (pid_ == 0) {
            const FolderLock lock(folder, use);
            static_cast<void>(!::write(ready[1], "x", 1));
            for (;;) ::pause();
        }
        char sign = ' ';
        EXPECT_EQ(::read(ready[0], &sign, 1), 1);
        ::close(ready[0]);
        ::close(ready[1]);
    }
    ~Holder() { kill(); }
    Holder(const Holder&) = delete;
    Holder& operator=(const Holder&) = delete;

    void kill() {
        if (pid_ < 0) return;
        ::kill(pid_, SIGKILL);
        ::waitpid(pid_, nullptr, 0);
        pid_ = -1;
    }
    [[nodiscard]] pid_t pid() const { return pid_; }

  private:
    pid_t pid_ = -1;
};

TEST(FolderLock, RefusesASecondWriterAtOnceAndNamesTheFirst) {
    const TempFolder folder;
    const Holder holder(folder.path(), FolderUse::Write);
    const std::string without_process =
        folder.path().string() +
        ": another aphotic is at work in this folder; allowed: one at a time";
    const std::string with_process =
        folder.path().string() +
        fmt::format(
            ": another aphotic is at work in this folder (process {}); allowed: one at a time",
            holder.pid());
    // File systems of layers tell the kernel's list another device than stat().
    for (const FolderUse use : {FolderUse::Write, FolderUse::Read}) {
        const std::string found = refusal(folder.path(), use);
        EXPECT_TRUE(found == with_process || found == without_process) << found;
    }
}

TEST(FolderLock, GoesWithItsProcessHoweverThatEnded) {
    const TempFolder folder;
    Holder holder(folder.path(), FolderUse::Write);
    EXPECT_NE(refusal(folder.path(), FolderUse::Write), "no error");
    holder.kill();
    EXPECT_EQ(refusal(folder.path(), FolderUse::Write), "no error");
}

TEST(FolderLock, LetsReadersInTogetherButNoWriter) {
    const TempFolder folder;
    const Holder holder(folder.path(), FolderUse::Read);
    EXPECT_EQ(refusal(folder.path(), FolderUse::Read), "no error");
    EXPECT_NE(refusal(folder.path(), FolderUse::Write), "no error");
}

TEST(FolderLock, LeavesNoFile) {
    const TempFolder folder;
    const FolderLock lock(folder.path(), FolderUse::Write);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(FolderLock, OfAMissingFolderIsNone) {
    const TempFolder folder;
    EXPECT_EQ(refusal(folder.path() / "missing", FolderUse::Write), "no error");
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "missing"));
}

}  // namespace
}  // namespace aphotic::folder_lock_test
