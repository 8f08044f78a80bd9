// SPDX-License-Identifier: BSD-3-Clause
//
// Locks, shares, and that nothing comes of nothing; the journal's tests are those of a run of
// images (survey/correct/image_run_test.cpp).
#include "base/work_folder.h"

#include "base/error.h"
#include "support/abandoned_file.h"
#include "support/refusal.h"
#include "support/temp_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

namespace aphotic::work_folder_test {
namespace {

namespace fs = std::filesystem;

std::string refusal(const std::filesystem::path& folder, FolderUse use) {
    return run_error_of([&] { const FolderLock lock(folder, use); });
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
        ": this folder is in use by another aphotic; allowed: one at a time";
    const std::string with_process =
        folder.path().string() +
        fmt::format(
            ": this folder is in use by another aphotic (process {}); allowed: one at a time",
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
    EXPECT_NE(refusal(folder.path(), FolderUse::Write), kAccepted);
    holder.kill();
    EXPECT_EQ(refusal(folder.path(), FolderUse::Write), kAccepted);
}

TEST(FolderLock, LetsReadersInTogetherButNoWriter) {
    const TempFolder folder;
    const Holder holder(folder.path(), FolderUse::Read);
    EXPECT_EQ(refusal(folder.path(), FolderUse::Read), kAccepted);
    EXPECT_NE(refusal(folder.path(), FolderUse::Write), kAccepted);
}

TEST(FolderLock, LeavesNoFile) {
    const TempFolder folder;
    const FolderLock lock(folder.path(), FolderUse::Write);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(FolderLock, OfAMissingFolderIsNone) {
    const TempFolder folder;
    EXPECT_EQ(refusal(folder.path() / "missing", FolderUse::Write), kAccepted);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "missing"));
}

TEST(Share, SharesTogetherAreAllWorkOnce) {
    std::vector<int> all(23);
    std::iota(all.begin(), all.end(), 0);
    for (std::size_t of = 1; of <= 30; ++of) {
        std::vector<int> together;
        std::size_t least = all.size();
        std::size_t most = 0;
        for (std::size_t number = 1; number <= of; ++number) {
            const std::vector<int> own = share_of(all, {number, of});
            least = std::min(least, own.size());
            most = std::max(most, own.size());
            together.insert(together.end(), own.begin(), own.end());
        }
        std::ranges::sort(together);
        EXPECT_EQ(together, all) << of;
        EXPECT_LE(most - least, 1U) << of;  // alike
    }
}

TEST(Share, IsWrittenAsTwoNumbers) {
    EXPECT_EQ(parse_share("2/4").number, 2U);
    EXPECT_EQ(parse_share("2/4").of, 4U);
    EXPECT_TRUE(parse_share("1/1").is_whole());
    for (const char* wrong : {"",
                              "2",
                              "/",
                              "2/",
                              "/4",
                              "0/4",
                              "5/4",
                              "2/4/6",
                              "2 /4",
                              "-1/4",
                              "+1/4",
                              "1/100001",
                              "a/4",
                              "2/4 ",
                              "1/99999999999999999999"}) {
        EXPECT_THROW((void)parse_share(wrong), InputError) << wrong;
    }
}

TEST(Share, HasAFolderOfItsOwn) {
    const TempFolder temp;
    EXPECT_EQ(share_folder(temp.path(), {}), temp.path());
    for (const char* name : {"share-1-of-2", "share-2-of-2", "share-x-of-2", "other"})
        fs::create_directories(temp.path() / name);
    write_file(temp.path() / "share-3-of-3", "");
    EXPECT_EQ(share_folders(temp.path()),
              (std::vector<fs::path>{share_folder(temp.path(), {1, 2}),
                                     share_folder(temp.path(), {2, 2})}));
    EXPECT_TRUE(share_folders(temp.path() / "nowhere").empty());
}

TEST(Share, LeavesWhatIsNotOurs) {
    const TempFolder temp;
    const fs::path share = share_folder(temp.path(), {1, 2});
    fs::create_directories(share / "a/b");
    fs::create_directories(share / "c");
    write_file(share / "ours", "");
    write_file(share / "a/theirs", "");
    remove_joined(share, {"ours"});
    EXPECT_FALSE(fs::exists(share / "ours"));
    EXPECT_FALSE(fs::exists(share / "a/b"));
    EXPECT_FALSE(fs::exists(share / "c"));
    EXPECT_TRUE(fs::exists(share / "a/theirs"));
    fs::remove(share / "a/theirs");
    remove_joined(share, {});
    EXPECT_FALSE(fs::exists(share));
}

}  // namespace
}  // namespace aphotic::work_folder_test
