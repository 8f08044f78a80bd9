// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/library_paths.h"

#include "support/temp_folder.h"
#include "support/variable.h"

#include <gtest/gtest.h>

namespace aphotic::library_paths_test {
namespace {

using Paths = std::vector<std::string>;

TEST(LibraryPaths, AreThoseOfAnIniFilesLines) {
    EXPECT_EQ(
        library_paths_in("; Library_Path=no\nWidth=3\nLibrary_Path=\"/a b/c\"\n"
                         "library_path = /d/e ; a comment\n  Library_Path=/f\r\nLibrary_Path=\n"),
        (Paths{"/a b/c", "/d/e", "/f"}));
    EXPECT_EQ(library_paths_in(""), Paths{});
}

// A stranger's scene may bring its own file along.
TEST(LibraryPaths, AreNoneOfALineWithoutEnd) {
    EXPECT_EQ(library_paths_in("Library_Path=/a\nLibrary_Path=/" + std::string(3'000'000, 'b') +
                               "\nLibrary_Path=/c\n"),
              (Paths{"/a", "/c"}));
}

// Only the first file found counts: what POVINI names, then the folder's own.
TEST(LibraryPaths, AreOfTheFileThatPovrayWouldRead) {
    const TempFolder scene;
    const TempFolder home;
    write_file(scene.path() / "povray.ini", "Library_Path=here\n");
    std::filesystem::create_directories(home.path() / ".povray" / "3.7");
    write_file(home.path() / ".povray" / "3.7" / "povray.ini", "Library_Path=home\n");
    write_file(home.path() / "mine.ini", "Library_Path=mine\n");
    const Variable users_home("HOME", home.path());
    ::unsetenv("POVINI");
    EXPECT_EQ(library_paths(scene.path(), "3.7.0.10"), Paths{"here"});
    std::filesystem::remove(scene.path() / "povray.ini");
    EXPECT_EQ(library_paths(scene.path(), "3.7.0.10"), Paths{"home"});
    ::setenv("POVINI", (home.path() / "mine.ini").c_str(), 1);
    EXPECT_EQ(library_paths(scene.path(), "3.7.0.10"), Paths{"mine"});
    ::unsetenv("POVINI");
}

}  // namespace
}  // namespace aphotic::library_paths_test
