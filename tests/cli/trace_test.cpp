// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic trace beside renders: its images are never taken for POV-Ray's.
#include "image/traced_image.h"
#include "support/command_test.h"
#include "support/has.h"
#include "support/small_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace aphotic::trace_test {
namespace {

namespace fs = std::filesystem;

constexpr int kBadInput = 2;
const std::vector<std::string> kImages{"image.exr", "spectral.exr", "preview.png"};

class CommandTrace : public CommandTest {
  protected:
    void SetUp() override {
        write_file(path("rig.toml"),
                   small_scene(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml"));
    }

    [[nodiscard]] CommandResult run(const std::string& command, const std::string& folder) const {
        return aphotic(
            fmt::format("{} rig.toml -o {} --wavelengths 470,550,620 --json", command, folder));
    }

    [[nodiscard]] CommandResult validate(const std::string& rendered) const {
        return aphotic(
            fmt::format("validate rig.toml -o validation --rendered {} --json", rendered));
    }
};

TEST_F(CommandTrace, RefusesTheFolderOfARender) {
    ASSERT_EQ(run("render", "out").status, 0);
    const std::string image = text_of("out/image.exr");
    const CommandResult trace = run("trace", "out");
    EXPECT_EQ(trace.status, kBadInput);
    EXPECT_TRUE(has(trace.err, "out/manifest.json: found the manifest of a render; allowed: "));
    EXPECT_EQ(text_of("out/image.exr"), image);
    EXPECT_FALSE(fs::exists(path("out/trace.json")));
}

TEST_F(CommandTrace, RefusesTheFolderOfScenesThatAreToBeRendered) {
    ASSERT_EQ(run("generate", "out").status, 0);
    EXPECT_EQ(run("trace", "out").status, kBadInput);
    EXPECT_FALSE(fs::exists(path("out/image.exr")));
}

TEST_F(CommandTrace, ItsImagesGiveWayToARender) {
    ASSERT_EQ(run("trace", "out").status, 0);
    ASSERT_TRUE(is_traced(path("out/image.exr")));
    ASSERT_TRUE(is_traced(path("out/spectral.exr")));
    ASSERT_EQ(run("generate", "out").status, 0);
    for (const std::string& image : kImages) EXPECT_FALSE(fs::exists(path("out/" + image)));
    EXPECT_FALSE(fs::exists(path("out/trace.json")));

    ASSERT_EQ(run("trace", "again").status, 0);
    ASSERT_EQ(run("render", "again").status, 0);
    EXPECT_FALSE(is_traced(path("again/image.exr")));
    EXPECT_FALSE(is_traced(path("again/spectral.exr")));
    EXPECT_FALSE(fs::exists(path("again/trace.json")));
}

TEST_F(CommandTrace, IntegrationsKeepOutOfOtherImagesFolders) {
    ASSERT_EQ(run("trace", "traced").status, 0);
    ASSERT_EQ(run("render", "rendered").status, 0);
    fs::copy(path("rendered"), path("other"), fs::copy_options::recursive);
    const auto integrate = [&](const Arguments& arguments) {
        return aphotic("integrate rendered" + arguments);
    };
    const auto expect_refused = [&](const Arguments& arguments, const std::string& notes) {
        const fs::path image = path(notes).parent_path() / "image.exr";
        const std::string before = read_text_file(image);
        const CommandResult refused = integrate(arguments);
        EXPECT_EQ(refused.status, kBadInput);
        EXPECT_TRUE(has(refused.err, notes + ": found the notes of a render or trace; allowed: "));
        EXPECT_EQ(read_text_file(image), before);
    };
    expect_refused("-o traced", "traced/trace.json");
    expect_refused("-o other", "other/manifest.json");
    expect_refused("--rig rig.toml --tolerance 0.5 -o rendered", "rendered/manifest.json");
    EXPECT_EQ(integrate("-o rendered").status, 0);
    EXPECT_EQ(integrate("-o elsewhere").status, 0);
    EXPECT_EQ(integrate("-o elsewhere").status, 0) << "once more";
}

TEST_F(CommandTrace, IsNotHeldAgainstItself) {
    ASSERT_EQ(run("render", "rendered").status, 0);
    ASSERT_EQ(run("trace", "traced").status, 0);
    for (const char* image : {"image.exr", "spectral.exr"}) {
        const std::string mixed = std::string("with-traced-") + image;
        fs::copy(path("rendered"), path(mixed), fs::copy_options::recursive);
        fs::copy_file(
            path("traced") / image, path(mixed) / image, fs::copy_options::overwrite_existing);
        const CommandResult refused = validate(mixed);
        EXPECT_EQ(refused.status, kBadInput) << refused.out;
        EXPECT_TRUE(
            has(refused.err, mixed + "/" + image + ": found an image of the reference tracer"));
        EXPECT_FALSE(fs::exists(path("validation"))) << "and leaves no folder";
        // As the message says, the frames are still there.
        ASSERT_EQ(aphotic(fmt::format("integrate {}", mixed)).status, 0);
        EXPECT_EQ(validate(mixed).status, 0);
        fs::remove_all(path("validation"));
    }
}

}  // namespace
}  // namespace aphotic::trace_test
