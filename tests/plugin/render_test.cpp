// SPDX-License-Identifier: BSD-3-Clause
//
// Renders that are repeated, interrupted, changed, or run with another number of jobs.
#include "plugin/render.h"

#include "base/error.h"
#include "base/sha256.h"
#include "spectral/integrator.h"
#include "support/rendered.h"
#include "support/run_command.h"

namespace aphotic::render_test {
namespace {

namespace fs = std::filesystem;

class Render : public testing::Test {
  protected:
    RenderResult run(const SceneSet& set, int jobs = 2) {
        return render(povray_, folder_.path(), set, {.jobs = jobs, .report = {}});
    }

    TempFolder folder_;
    PovRay povray_ = find_povray("");
    Rig rig_ = small_habcam(32, 24);
    SceneSet set_ = scenes_of(rig_, {430.0, 470.0, 520.0, 560.0, 600.0, 640.0, 700.0});
};

TEST_F(Render, JobsChangeNoBit) {
    const RenderResult two = run(set_, 2);
    integrate(folder_.path(), two.manifest);
    const TempFolder other;
    const RenderResult one = render(povray_, other.path(), set_, {.jobs = 1, .report = {}});
    integrate(other.path(), one.manifest);
    for (const char* file : {"image.exr", "spectral.exr"}) {
        EXPECT_EQ(sha256_of_file(folder_.path() / file), sha256_of_file(other.path() / file))
            << file;
    }
}

TEST_F(Render, FinishedFramesAreKept) {
    EXPECT_EQ(run(set_).rendered, 3U);
    const RenderResult again = run(set_);
    EXPECT_EQ(again.rendered, 0U);
    EXPECT_EQ(again.kept, 3U);
}

TEST_F(Render, LostAndAlteredFramesAreRenderedAgain) {
    const Manifest manifest = run(set_).manifest;
    fs::remove(image_path(folder_.path(), manifest.frames[0]));
    fs::copy_file(image_path(folder_.path(), manifest.frames[2]),
                  image_path(folder_.path(), manifest.frames[1]),
                  fs::copy_options::overwrite_existing);
    EXPECT_EQ(run(set_).rendered, 2U);
    EXPECT_NO_THROW(integrate(folder_.path(), run(set_).manifest));
}

TEST_F(Render, ChangedRigIsRenderedAgain) {
    run(set_);
    rig_.sled.altitude_m = 2.5;
    const SceneSet changed = scenes_of(rig_, {430.0, 470.0, 520.0, 560.0, 600.0, 640.0, 700.0});
    EXPECT_EQ(run(changed).rendered, 3U);
}

TEST_F(Render, OtherPovRayRendersAgain) {
    run(set_);
    povray_.version = "3.7.0.99";
    EXPECT_EQ(run(set_).rendered, 3U);
}

// POV-Ray dies at the second frame: the first is kept, and the next run makes the rest.
TEST_F(Render, GoesOnWhereItStopped) {
    const std::string real = povray_.executable.string();
    PovRay dying = povray_;
    dying.executable =
        write_script(folder_.path() / "dying.sh",
                     "case \"$1\" in *520*) exec " + real + " \"$@\" ;; *430*) exec " + real +
                         " \"$@\" ;; esac\nkill -9 $$\n");
    EXPECT_THROW(render(dying, folder_.path(), set_, {.jobs = 1, .report = {}}), RunError);
    const Manifest left = read_manifest(folder_.path());
    EXPECT_TRUE(left.frames[0].done());
    EXPECT_FALSE(left.frames[2].done());

    const RenderResult finished = run(set_);
    EXPECT_EQ(finished.kept, 1U);
    integrate(folder_.path(), finished.manifest);
    const TempFolder undisturbed;
    integrate(undisturbed.path(),
              render(povray_, undisturbed.path(), set_, {.jobs = 2, .report = {}}).manifest);
    EXPECT_EQ(sha256_of_file(folder_.path() / "image.exr"),
              sha256_of_file(undisturbed.path() / "image.exr"));
}

// `generate`, then POV-Ray by hand as the scenes say, then `integrate`: the same image.
TEST_F(Render, GeneratedScenesRenderWithPlainPovRay) {
    const Manifest manifest = generate(folder_.path(), set_);
    for (const ManifestFrame& frame : manifest.frames) {
        const ProcessEnd end = run_process({.executable = povray_.executable,
                                            .arguments = {"render.ini", "+I" + frame.name + ".pov"},
                                            .folder = folder_.path() / "povray",
                                            .environment = {},
                                            .log = folder_.path() / "log"},
                                           60.0);
        ASSERT_TRUE(end.succeeded()) << read_text_file(folder_.path() / "log");
    }
    const CameraImage by_hand = integrate(folder_.path(), read_manifest(folder_.path()));
    const TempFolder other;
    const CameraImage by_us = integrate(
        other.path(), render(povray_, other.path(), set_, {.jobs = 2, .report = {}}).manifest);
    EXPECT_EQ(by_hand.samples, by_us.samples);
}

// Frames of an earlier rig under the same names must not pass for those of this one.
TEST_F(Render, GenerateTakesAwayFramesOfOtherScenes) {
    run(set_);
    rig_.sled.altitude_m = 3.0;
    const SceneSet changed = scenes_of(rig_, {430.0, 470.0, 520.0, 560.0, 600.0, 640.0, 700.0});
    const Manifest manifest = generate(folder_.path(), changed);
    EXPECT_THROW(integrate(folder_.path(), manifest), RunError);
}

}  // namespace
}  // namespace aphotic::render_test
