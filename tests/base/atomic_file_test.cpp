// SPDX-License-Identifier: BSD-3-Clause
#include "base/atomic_file.h"

#include "base/error.h"
#include "support/refusal.h"
#include "tests/support/abandoned_file.h"
#include "tests/support/temp_folder.h"
#include "tests/support/thread_sanitizer.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <linux/magic.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/statfs.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fcntl.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace aphotic::atomic_file_test {
namespace {

// What the calls that follow were made on, in their order, and what fsync fails with. Threads call
// them, too.
std::mutex disk_calls_mutex;
std::vector<std::string> disk_calls;
void note_call(std::string call) {
    const std::scoped_lock lock(disk_calls_mutex);
    disk_calls.push_back(std::move(call));
}
int fsync_error = 0;
long file_system = 0;  // what statfs tells; 0: the truth

}  // namespace
}  // namespace aphotic::atomic_file_test

// In place of the C library's, which all of this program calls.
extern "C" int fsync(int descriptor) {
    using namespace aphotic::atomic_file_test;
    const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
    note_call("fsync " + std::filesystem::read_symlink(link).string());
    if (fsync_error != 0) {
        errno = fsync_error;
        return -1;
    }
    return static_cast<int>(::syscall(SYS_fsync, descriptor));
}

extern "C" int rename(const char* from, const char* to) noexcept {
    aphotic::atomic_file_test::note_call("rename " + std::string(from));
    return static_cast<int>(::syscall(SYS_renameat, AT_FDCWD, from, AT_FDCWD, to));
}

extern "C" int statfs(const char* path, struct statfs* system) noexcept {
    const auto status = static_cast<int>(::syscall(SYS_statfs, path, system));
    const long told = aphotic::atomic_file_test::file_system;
    if (told != 0) system->f_type = static_cast<decltype(system->f_type)>(told);
    return status;
}

namespace aphotic::atomic_file_test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) {
        names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

TEST(AtomicFile, AppearsUnderItsNameOnlyWhenCommitted) {
    const TempFolder folder;
    const fs::path file = folder.path() / "out.txt";
    AtomicFile out(file);
    write_file(out.temporary(), "whole");
    EXPECT_FALSE(fs::exists(file));
    out.commit();
    EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"out.txt"});
    EXPECT_EQ(read_text_file(file), "whole");
}

TEST(AtomicFile, IsOnTheDiskBeforeItsNameIs) {
    const TempFolder folder;
    AtomicFile out(folder.path() / "out.txt");
    const std::string temporary = out.temporary().string();
    write_file(temporary, "whole");
    disk_calls.clear();
    out.commit();
    EXPECT_EQ(disk_calls,
              (std::vector<std::string>{
                  "fsync " + temporary, "rename " + temporary, "fsync " + folder.path().string()}));
}

TEST(AtomicFile, ThatDoesNotReachTheDiskDoesNotTakeItsPlace) {
    const TempFolder folder;
    const fs::path file = folder.path() / "out.txt";
    write_file(file, "before");
    const auto write = [&](int error) {
        return run_error_of([&] {
            AtomicFile out(file);
            write_file(out.temporary(), "after");
            fsync_error = error;
            out.commit();
        });
    };
    for (const int error : {EIO, ENOSPC}) {
        EXPECT_EQ(write(error),
                  file.string() + ": cannot be written: " + std::string(std::strerror(error)));
        EXPECT_EQ(read_text_file(file), "before");
        EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"out.txt"});
    }
    // A file system that knows no fsync keeps files as it does.
    EXPECT_EQ(write(EINVAL), kAccepted);
    fsync_error = 0;
    EXPECT_EQ(read_text_file(file), "after");
}

TEST(AtomicFile, LeavesTheOldFileWithoutCommit) {
    const TempFolder folder;
    const fs::path file = folder.path() / "out.txt";
    write_file(file, "old");
    {
        const AtomicFile out(file);
        write_file(out.temporary(), "half");
    }
    EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"out.txt"});
    EXPECT_EQ(read_text_file(file), "old");
}

// The next writer of the same file may be at work already when the first one's object goes.
TEST(AtomicFile, TouchesNothingAfterCommit) {
    const TempFolder folder;
    const fs::path file = folder.path() / "out.txt";
    auto first = std::make_unique<AtomicFile>(file);
    write_file(first->temporary(), "first");
    first->commit();
    AtomicFile second(file);
    write_file(second.temporary(), "second");
    first.reset();
    second.commit();
    EXPECT_EQ(read_text_file(file), "second");
}

// A rename is atomic within one folder only, and some writers go by the extension.
TEST(AtomicFile, IsWrittenBesideItsPlaceWithItsExtension) {
    const AtomicFile out("some/folder/image.exr");
    EXPECT_EQ(out.final_path(), "some/folder/image.exr");
    EXPECT_EQ(out.temporary().parent_path(), "some/folder");
    EXPECT_EQ(out.temporary().extension(), ".exr");
    EXPECT_NE(out.temporary(), out.final_path());
}

TEST(AtomicFile, AFailedCommitNamesTheFileAndLeavesNothing) {
    const TempFolder folder;
    const fs::path file = folder.path() / "taken";
    make_folder(file / "inside");  // no file can replace a folder that holds something
    {
        AtomicFile out(file);
        write_file(out.temporary(), "text");
        const std::string message = run_error_of([&] { out.commit(); });
        EXPECT_TRUE(message.starts_with(file.string() + ": cannot be written: ")) << message;
    }
    EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"taken"});
}

TEST(AtomicFile, OfAKilledProcessIsTakenAwayAndNoOther) {
    const TempFolder folder;
    const pid_t killed = ::fork();
    if (killed == 0) {
        const AtomicFile file(folder.path() / "image.exr");
        write_file(file.temporary(), "half");
        ::_exit(0);
    }
    ::waitpid(killed, nullptr, 0);
    const AtomicFile living(folder.path() / "image.exr");
    write_file(living.temporary(), "half");
    // Of the users' own.
    const std::vector<std::string> others{
        ".notes", "image.part.exr", ".a.part.b", ".image.1x.part.exr", "image.1.part.exr"};
    for (const std::string& name : others) write_file(folder.path() / name, "");
    ASSERT_EQ(names_in(folder.path()).size(), others.size() + 2);
    remove_abandoned_files(folder.path());
    EXPECT_EQ(names_in(folder.path()).size(), others.size() + 1);
    EXPECT_TRUE(fs::exists(living.temporary()));
    for (const std::string& name : others) EXPECT_TRUE(fs::exists(folder.path() / name)) << name;
    EXPECT_NO_THROW(remove_abandoned_files(folder.path() / "missing"));
}

TEST(AtomicFile, OfAKilledProcessIsTakenAwayByTheNameOfItsFile) {
    const TempFolder folder;
    const pid_t killed = ::fork();
    if (killed == 0) {
        const AtomicFile map(folder.path() / "map.exr");
        const AtomicFile other(folder.path() / "map.png");
        write_file(map.temporary(), "half");
        write_file(other.temporary(), "half");
        ::_exit(0);
    }
    ::waitpid(killed, nullptr, 0);
    remove_abandoned_of(folder.path() / "map.exr");
    const auto left = names_in(folder.path());
    ASSERT_EQ(left.size(), 1U);
    EXPECT_TRUE(left.front().ends_with(".png")) << left.front();
}

// As one of another boot or container is named, whose process has the number of one that is gone.
fs::path named_otherwise(const fs::path& ours, bool other_boot) {
    const std::string name = ours.filename().string();
    const std::size_t boot = name.find_last_of('.', name.find(".part") - 1) + 1;
    const std::size_t numbers = name.find('-', boot) + 1;
    std::string other = name;
    char& digit = other[other_boot ? boot : numbers];
    digit = digit == '0' ? '1' : '0';
    return ours.parent_path() / other;
}

// Process numbers of elsewhere mean nothing here: the one that writes may live.
TEST(AtomicFile, OfAnotherMachineOrContainerIsKept) {
    const TempFolder folder;
    const fs::path ours = abandon(folder.path() / "image.exr");
    const fs::path of_container = named_otherwise(ours, false);
    const fs::path of_machine = named_otherwise(ours, true);
    const fs::path of_version_0_2 = folder.path() / ".image.999999999.part.exr";
    for (const fs::path& file : {of_container, of_machine, of_version_0_2}) write_file(file, "");
    for (const long network : {long{NFS_SUPER_MAGIC}, long{CIFS_SUPER_MAGIC}, long{0x0BD00BD0}}) {
        file_system = network;
        remove_abandoned_files(folder.path());
        remove_abandoned_of(folder.path() / "image.exr");
        for (const fs::path& file : {of_container, of_machine, of_version_0_2})
            EXPECT_TRUE(fs::exists(file)) << file << " on " << network;
    }
    EXPECT_FALSE(fs::exists(ours));
    // No other machine has this one's disk: the boot is over, and all its processes.
    file_system = EXT4_SUPER_MAGIC;
    remove_abandoned_files(folder.path());
    file_system = 0;
    EXPECT_FALSE(fs::exists(of_machine));
    EXPECT_TRUE(fs::exists(of_container));
}

TEST(AtomicFile, MayHaveTheLongestName) {
    constexpr std::size_t kLongest = 255;
    const TempFolder folder;
    const std::string same(kLongest - 5, 'a');
    const fs::path one = folder.path() / (same + "1.exr");
    const fs::path two = folder.path() / (same + "2.exr");
    EXPECT_NE(AtomicFile(one).temporary(), AtomicFile(two).temporary());
    EXPECT_NO_THROW(write_text_file(one, "whole"));
    EXPECT_EQ(read_text_file(one), "whole");
    const fs::path left = abandon(two);
    EXPECT_TRUE(fs::exists(left));
    remove_abandoned_of(two);
    EXPECT_FALSE(fs::exists(left));
}

// Struck while four threads begin, write and commit files, as correct does: whole ones stay alone.
TEST(AtomicFile, OfAProcessThatASignalEndsIsRemoved) {
    constexpr int kThreads = 4;
    for (const int signal : {SIGTERM, SIGINT, SIGHUP, SIGTERM, SIGINT, SIGHUP}) {
        const TempFolder folder;
        const pid_t child = ::fork();
        if (child == 0) {
            ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // else it writes until the disk is full
            std::vector<std::jthread> threads;
            for (int thread = 0; thread < kThreads; ++thread) {
                threads.emplace_back([&, thread] {
                    for (int i = 0;; ++i) {
                        AtomicFile file(folder.path() / fmt::format("{}-{}.txt", thread, i));
                        std::ofstream(file.temporary()) << "whole";
                        std::error_code error;
                        // Not synced, which would take nearly all of the time.
                        if (i % 2 == 0) fs::rename(file.temporary(), file.final_path(), error);
                    }
                });
            }
            threads.clear();
        }
        while (names_in(folder.path()).size() < 20) std::this_thread::yield();
        ::kill(child, signal);
        int status = 0;
        ::waitpid(child, &status, 0);
        EXPECT_TRUE(is_ended_by(status, signal)) << status;
        for (const std::string& name : names_in(folder.path()))
            EXPECT_FALSE(name.starts_with('.')) << name;
    }
}

// A handler of the host's is left to decide, and the file becomes whole.
TEST(AtomicFile, WaitsForTheHostsHandlerOfASignal) {
    const TempFolder folder;
    static std::atomic<int> handled = 0;
    handled = 0;
    const auto before = ::signal(SIGINT, [](int) { ++handled; });
    {
        AtomicFile file(folder.path() / "out.txt");
        write_file(file.temporary(), "whole");
        ::raise(SIGINT);
        EXPECT_EQ(handled, 0);
        file.commit();
        EXPECT_EQ(handled, 1);
    }
    ::signal(SIGINT, before);
    EXPECT_EQ(read_text_file(folder.path() / "out.txt"), "whole");
}

TEST(TextFile, ComesBackByteForByte) {
    const TempFolder folder;
    const fs::path file = folder.path() / "text";
    const std::string text("a\r\n\0b\xFF\n", 7);
    write_text_file(file, text);
    EXPECT_EQ(read_text_file(file), text);
    write_text_file(file, "");
    EXPECT_EQ(read_text_file(file), "");
    EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"text"});
}

TEST(TextFile, AFailedWriteIsARunErrorThatNamesTheFile) {
    const TempFolder folder;
    const fs::path file = folder.path() / "missing" / "text";
    EXPECT_EQ(run_error_of([&] { write_text_file(file, "x"); }),
              file.string() + ": cannot be written: No such file or directory");
}

TEST(TextFile, AnUnreadableOneIsAnInputErrorThatNamesIt) {
    const TempFolder folder;
    const fs::path missing = folder.path() / "missing";
    EXPECT_EQ(refusal_of([&] { return read_text_file(missing); }),
              missing.string() + ": cannot be read: No such file or directory");
    EXPECT_EQ(refusal_of([&] { return read_text_file(folder.path()); }),
              folder.path().string() + ": cannot be read: it is a folder");
}

// Whoever reads it: no reader need ask for a limit.
TEST(TextFile, AnEndlessOneIsRefused) {
    const TempFolder folder;
    const fs::path sparse = folder.path() / "sparse";
    write_text_file(sparse, "");
    fs::resize_file(sparse, kMostTextFile_bytes + 1);
    EXPECT_EQ(refusal_of([&] { return read_text_file(sparse); }),
              sparse.string() + ": found more than 256 MiB; allowed: 256 MiB or less");
    const fs::path pipe = folder.path() / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const std::string yes = "yes > '" + pipe.string() + "' 2> /dev/null &";
    ASSERT_EQ(std::system(yes.c_str()), 0);  // it ends when nobody reads any more
    EXPECT_EQ(refusal_of([&] { return read_text_file(pipe, kMebibyte); }),
              pipe.string() + ": found more than 1 MiB; allowed: 1 MiB or less");
}

TEST(MakeFolder, MakesParentsAndAcceptsWhatIsThere) {
    const TempFolder folder;
    const fs::path deep = folder.path() / "a" / "b" / "c";
    make_folder(deep);
    EXPECT_TRUE(fs::is_directory(deep));
    EXPECT_NO_THROW(make_folder(deep));
}

TEST(MakeFolder, NamesTheFolderThatCannotBeMade) {
    const TempFolder folder;
    const fs::path file = folder.path() / "file";
    write_file(file, "");
    for (const fs::path& wanted : {file, file / "below"}) {
        EXPECT_EQ(run_error_of([&] { make_folder(wanted); }),
                  wanted.string() + ": cannot be created: Not a directory");
    }
}

TEST(MakeFolder, NamesTheFolderThatCannotBeWrittenTo) {
    if (::geteuid() == 0) GTEST_SKIP() << "root may write anywhere";
    const TempFolder folder;
    const fs::path locked = folder.path() / "locked";
    make_folder(locked);
    fs::permissions(locked, fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_EQ(run_error_of([&] { make_folder(locked); }),
              locked.string() + ": cannot be written to: Permission denied");
}

}  // namespace
}  // namespace aphotic::atomic_file_test
