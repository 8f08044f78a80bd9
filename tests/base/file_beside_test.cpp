// SPDX-License-Identifier: BSD-3-Clause
#include "base/file_beside.h"

#include "base/error.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <sys/stat.h>

namespace aphotic::file_beside_test {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kAllowed = "; allowed: a file in the same folder or below it";

// A folder "rig" of files and links, and beside it what is none of the rig's business.
class FileBeside : public testing::Test {
  protected:
    void SetUp() override {
        fs::create_directories(rig_ / "tables");
        fs::create_directories(folder_.path() / "rig-of-others");
        write_file(rig_ / "mud.csv", "mine");
        write_file(rig_ / "tables" / "mud.csv", "mine");
        write_file(folder_.path() / "secret.csv", "not mine");
        write_file(folder_.path() / "rig-of-others" / "secret.csv", "not mine");
    }

    [[nodiscard]] std::string error_of(const std::string& name) const {
        try {
            return "no error: " + file_beside(rig_, name).string();
        } catch (const InputError& error) {
            return error.what();
        }
    }

    void expect_refused_link(const std::string& name, const fs::path& end) const {
        EXPECT_EQ(error_of(name),
                  (rig_ / name).string() + ": found a link that leads to " +
                      fs::canonical(end).string() + std::string(kAllowed));
    }

    TempFolder folder_;
    fs::path rig_ = folder_.path() / "rig";
};

TEST_F(FileBeside, TakesWhatIsInTheFolderOrBelowIt) {
    for (const std::string name :
         {"mud.csv", "tables/mud.csv", "./mud.csv", "tables/../mud.csv", "tables//mud.csv"}) {
        EXPECT_EQ(file_beside(rig_, name), rig_ / name);
    }
}

TEST_F(FileBeside, TakesAnEmptyFolderForTheWorkingDirectory) {
    EXPECT_THROW(static_cast<void>(file_beside("", "no-such-file")), InputError);
    EXPECT_THROW(static_cast<void>(file_beside("", "../" + fs::current_path().filename().string())),
                 InputError);
}

TEST_F(FileBeside, RefusesPathsThatLeaveTheFolderWhetherOrNotTheyLeadAnywhere) {
    for (const std::string& name : {std::string("../secret.csv"),
                                    std::string("../nothing.csv"),
                                    std::string("tables/../../secret.csv"),
                                    std::string("../rig-of-others/secret.csv"),
                                    std::string("/dev/zero"),
                                    std::string(".."),
                                    std::string(),
                                    (rig_ / "mud.csv").string()}) {
        EXPECT_EQ(error_of(name), "found '" + name + "'" + std::string(kAllowed));
    }
}

TEST_F(FileBeside, FollowsLinksThatStay) {
    fs::create_symlink("tables/mud.csv", rig_ / "link.csv");
    fs::create_directory_symlink("tables", rig_ / "more");
    EXPECT_EQ(file_beside(rig_, "link.csv"), rig_ / "link.csv");
    EXPECT_EQ(file_beside(rig_, "more/mud.csv"), rig_ / "more/mud.csv");
    // The rig's own folder may be reached through a link.
    fs::create_directory_symlink("rig", folder_.path() / "by-link");
    EXPECT_EQ(file_beside(folder_.path() / "by-link", "mud.csv"),
              folder_.path() / "by-link" / "mud.csv");
}

TEST_F(FileBeside, RefusesLinksThatLeaveTheFolderWhereverTheyStand) {
    fs::create_symlink("../secret.csv", rig_ / "out.csv");
    fs::create_symlink("/dev/zero", rig_ / "zero.csv");
    fs::create_symlink("out.csv", rig_ / "twice.csv");
    // "rig-of-others" begins with the letters of "rig".
    fs::create_directory_symlink("../../rig-of-others", rig_ / "tables" / "others");
    expect_refused_link("out.csv", folder_.path() / "secret.csv");
    expect_refused_link("twice.csv", folder_.path() / "secret.csv");
    expect_refused_link("zero.csv", "/dev/zero");
    expect_refused_link("tables/others/secret.csv", folder_.path() / "rig-of-others/secret.csv");
}

TEST_F(FileBeside, RefusesLinksThatLeadNowhere) {
    fs::create_symlink("nothing", rig_ / "dangling.csv");
    fs::create_symlink("loop.csv", rig_ / "loop.csv");
    EXPECT_EQ(error_of("dangling.csv"),
              (rig_ / "dangling.csv").string() + ": cannot be read: it is a broken link");
    EXPECT_EQ(error_of("loop.csv"),
              (rig_ / "loop.csv").string() + ": cannot be read: Too many levels of symbolic links");
    EXPECT_EQ(error_of("none.csv"),
              (rig_ / "none.csv").string() + ": cannot be read: No such file or directory");
}

TEST_F(FileBeside, RefusesPipesAndFoldersWithoutWaiting) {
    ASSERT_EQ(::mkfifo((rig_ / "pipe.csv").c_str(), 0600), 0);
    EXPECT_EQ(error_of("pipe.csv"),
              (rig_ / "pipe.csv").string() +
                  ": cannot be read: it is a pipe, a device or a socket" + std::string(kAllowed));
    EXPECT_EQ(
        error_of("tables"),
        (rig_ / "tables").string() + ": cannot be read: it is a folder" + std::string(kAllowed));
    EXPECT_EQ(error_of("."),
              (rig_ / ".").string() + ": cannot be read: it is a folder" + std::string(kAllowed));
}

}  // namespace
}  // namespace aphotic::file_beside_test
