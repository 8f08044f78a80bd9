// SPDX-License-Identifier: BSD-3-Clause
//
// What becomes of a run when POV-Ray does not do as it should, and when it does.
#include "plugin/frame_runner.h"

#include "base/error.h"
#include "base/sha256.h"
#include "support/refusal.h"
#include "support/rendered.h"
#include "support/run_command.h"
#include "support/variable.h"

namespace aphotic::frame_runner_test {
namespace {

namespace fs = std::filesystem;

class FrameRunner : public testing::Test {
  protected:
    // Renders one small frame with a POV-Ray of the test's own making; the message of its failure.
    std::string failure_of(const std::string& script_body) {
        const PovRay povray{.executable = write_script(folder_.path() / "povray.sh", script_body),
                            .version = "3.7.0.10"};
        return run_error_of(
            [&] { render(povray, folder_.path(), set_, {.jobs = 2, .report = {}}); });
    }

    [[nodiscard]] bool has_frames() const {
        return !fs::is_empty(folder_.path() / "povray" / "frames");
    }

    TempFolder folder_;
    Rig rig_ = small_habcam(16, 12);
    SceneSet set_ = scenes_of(rig_, {550.0});
    std::string real_povray_ = find_povray("").executable.string();
};

TEST_F(FrameRunner, ParseErrorComesWithTheScenesLine) {
    set_.scenes[0].sdl = "#version 3.7;\nglobal_settings { assumed_gamma 1 }\ncamera { sphere }\n";
    const std::string message = failure_of("exec " + real_povray_ + " \"$@\"\n");
    EXPECT_NE(message.find("band_550nm.pov' line 3: Parse Error"), std::string::npos) << message;
    EXPECT_NE(message.find("exit status 1"), std::string::npos) << message;
    EXPECT_FALSE(has_frames());
}

TEST_F(FrameRunner, KilledPovRayIsNamedAndLeavesNoFrame) {
    const std::string message = failure_of("kill -9 $$\n");
    EXPECT_NE(message.find("killed by signal 9"), std::string::npos) << message;
    EXPECT_NE(message.find("band_550nm.pov"), std::string::npos) << message;
    EXPECT_FALSE(has_frames());
}

TEST_F(FrameRunner, SuccessWithoutAnImageIsAFailure) {
    const std::string message = failure_of("exit 0\n");
    EXPECT_NE(message.find("exited normally without an image"), std::string::npos) << message;
}

TEST_F(FrameRunner, ImageOfTheWrongSizeIsRefused) {
    const std::string message = failure_of("exec " + real_povray_ + " \"$@\" +W8 +H8\n");
    EXPECT_NE(message.find("found 8 x 8 pixels; allowed: 16 x 12"), std::string::npos) << message;
    EXPECT_FALSE(fs::exists(image_path(folder_.path(), set_.manifest.frames[0])));
}

TEST_F(FrameRunner, SaturatedFrameNamesThePixel) {
    set_.scenes[0].sdl =
        "#version 3.7;\nglobal_settings { assumed_gamma 1 }\n"
        "background { rgb <1, 1e6, 1> }\ncamera { location 0 }\n";
    const std::string message = failure_of("exec " + real_povray_ + " \"$@\"\n");
    EXPECT_NE(message.find("channel G is inf at column 0, row 0"), std::string::npos) << message;
    EXPECT_FALSE(fs::exists(image_path(folder_.path(), set_.manifest.frames[0])));
}

// A user's own settings must not reach our frames.
TEST_F(FrameRunner, UsersIniIsNotInherited) {
    const TempFolder home;
    const std::string hostile = "Width=8\nHeight=8\nAntialias=on\nQuality=1\nFile_Gamma=2.2\n";
    write_file(home.path() / "povray.ini", hostile);
    fs::create_directories(home.path() / ".povray" / "3.7");
    write_file(home.path() / ".povray" / "3.7" / "povray.ini", hostile);
    fs::create_directories(folder_.path() / "povray");
    write_file(folder_.path() / "povray" / "povray.ini", hostile);

    const Difference clean = against_closed_form(rig_, set_);
    const Variable users_ini("POVINI", home.path() / "povray.ini");
    const Variable users_home("HOME", home.path());
    const Difference found = against_closed_form(rig_, set_);
    EXPECT_EQ(found.worst, clean.worst);
    EXPECT_LE(found.worst, kHalfFloatError);
}

// So what stands in its place can only be what was noted, also when we are killed in between.
TEST_F(FrameRunner, NotesAFrameBeforeItTakesItsPlace) {
    const fs::path place = image_path(folder_.path(), set_.manifest.frames[0]);
    std::string noted;
    RunOptions options{.jobs = 1, .report = {}};
    options.arrived = [&](const ManifestFrame&) {
        noted = read_manifest(folder_.path()).frames[0].image_sha256;
        EXPECT_EQ(noted, sha256_of_file(place));
    };
    render(find_povray(""), folder_.path(), set_, options);
    EXPECT_FALSE(noted.empty());

    fs::remove(place);
    int checked = 0;
    options.checked = [&](const ManifestFrame&, const fs::path& image) {
        EXPECT_TRUE(fs::exists(image));
        EXPECT_FALSE(fs::exists(place));
        ++checked;
    };
    options.arrived = {};
    run_frames(find_povray(""), folder_.path(), set_.manifest.frames, 16, 12, options);
    EXPECT_EQ(checked, 1);
    EXPECT_TRUE(fs::exists(place));
}

TEST_F(FrameRunner, ProgressRunsToTheEnd) {
    set_ = scenes_of(rig_, {450.0, 500.0, 550.0, 600.0});
    std::vector<FrameProgress> reports;
    RunOptions options{.jobs = 2, .report = [&](const FrameProgress& p) { reports.push_back(p); }};
    render(find_povray(""), folder_.path(), set_, options);
    ASSERT_FALSE(reports.empty());
    for (std::size_t i = 0; i < reports.size(); ++i) {
        EXPECT_EQ(reports[i].frames, 2U);
        EXPECT_GE(reports[i].share, i == 0 ? 0.0 : reports[i - 1].share);
        EXPECT_LE(reports[i].share, 1.0);
    }
}

}  // namespace
}  // namespace aphotic::frame_runner_test
