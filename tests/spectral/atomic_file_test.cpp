// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/atomic_file.h"

#include "spectral/error.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace aphotic {
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

template <typename Error>
std::string message_of(const auto& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
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

TEST(AtomicFile, LeavesNothingWithoutCommit) {
    const TempFolder folder;
    {
        const AtomicFile out(folder.path() / "out.txt");
        write_file(out.temporary(), "half");
        EXPECT_EQ(names_in(folder.path()).size(), 1U);
    }
    EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{});
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
        const std::string message = message_of<RunError>([&] { out.commit(); });
        EXPECT_TRUE(message.starts_with(file.string() + ": cannot be written: ")) << message;
    }
    EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"taken"});
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
    EXPECT_EQ(message_of<RunError>([&] { write_text_file(file, "x"); }),
              file.string() + ": cannot be written: No such file or directory");
}

TEST(TextFile, AnUnreadableOneIsAnInputErrorThatNamesIt) {
    const TempFolder folder;
    const fs::path missing = folder.path() / "missing";
    EXPECT_EQ(message_of<InputError>([&] { static_cast<void>(read_text_file(missing)); }),
              missing.string() + ": cannot be read: No such file or directory");
    EXPECT_EQ(message_of<InputError>([&] { static_cast<void>(read_text_file(folder.path())); }),
              folder.path().string() + ": cannot be read: it is a folder");
}

TEST(MakeFolder, MakesParentsAndAcceptsWhatIsThere) {
    const TempFolder folder;
    const fs::path deep = folder.path() / "a" / "b" / "c";
    make_folder(deep);
    EXPECT_TRUE(fs::is_directory(deep));
    EXPECT_NO_THROW(make_folder(deep));
}

TEST(RemoveAbandoned, TakesWhatTheDeadLeftAndNothingElse) {
    constexpr long kNobody = 999999999;  // over the kernel's largest process number, 2^22
    const TempFolder folder;
    make_folder(folder.path() / "below");
    const std::string of_the_dead = "image." + std::to_string(kNobody) + ".part.tif";
    const std::string ours = ".image." + std::to_string(::getpid()) + ".part.tif";
    write_file(folder.path() / "below" / ("." + of_the_dead), "");
    const std::vector<std::string> stay{
        ".part.tif", ".x.part", ours, of_the_dead, "image.tif", ".image.12x.part.tif"};
    for (const std::string& name : stay) write_file(folder.path() / name, "");
    remove_abandoned(folder.path());
    for (const std::string& name : stay) EXPECT_TRUE(fs::exists(folder.path() / name)) << name;
    EXPECT_TRUE(fs::is_empty(folder.path() / "below"));
}

TEST(MakeFolder, NamesTheFolderThatCannotBeMade) {
    const TempFolder folder;
    const fs::path file = folder.path() / "file";
    write_file(file, "");
    for (const fs::path& wanted : {file, file / "below"}) {
        EXPECT_EQ(message_of<RunError>([&] { make_folder(wanted); }),
                  wanted.string() + ": cannot be made: Not a directory");
    }
}

TEST(MakeFolder, NamesTheFolderThatCannotBeWrittenTo) {
    if (::geteuid() == 0) GTEST_SKIP() << "root may write anywhere";
    const TempFolder folder;
    const fs::path locked = folder.path() / "locked";
    make_folder(locked);
    fs::permissions(locked, fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_EQ(message_of<RunError>([&] { make_folder(locked); }),
              locked.string() + ": cannot be written to: Permission denied");
}

}  // namespace
}  // namespace aphotic
