// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic trace beside renders: its images are never taken for POV-Ray's.
#include "image/traced_image.h"
#include "support/run_command.h"
#include "support/small_scene.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace aphotic::trace_test {
namespace {

namespace fs = std::filesystem;

constexpr int kBadInput = 2;
const std::vector<std::string> kImages{"image.exr", "spectral.exr", "preview.png"};

class CommandTrace : public testing::Test {
  protected:
    void SetUp() override {
        write_file(file("rig.toml"),
                   small_scene(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml"));
    }

    [[nodiscard]] fs::path file(const std::string& name) const { return folder_.path() / name; }

    [[nodiscard]] CommandResult run(const std::string& command, const std::string& folder) const {
        return run_aphotic(
            folder_.path(),
            {command, "rig.toml", "-o", folder, "--wavelengths", "470,550,620", "--json"});
    }

    [[nodiscard]] CommandResult validate(const std::string& rendered) const {
        return run_aphotic(
            folder_.path(),
            {"validate", "rig.toml", "-o", "validation", "--rendered", rendered, "--json"});
    }

    TempFolder folder_;
};

TEST_F(CommandTrace, RefusesTheFolderOfARender) {
    ASSERT_EQ(run("render", "out").status, 0);
    const std::string image = read_text_file(file("out/image.exr"));
    const CommandResult trace = run("trace", "out");
    EXPECT_EQ(trace.status, kBadInput);
    EXPECT_NE(trace.err.find("out/manifest.json: found the manifest of a render; allowed: "),
              std::string::npos)
        << trace.err;
    EXPECT_EQ(read_text_file(file("out/image.exr")), image);
    EXPECT_FALSE(fs::exists(file("out/trace.json")));
}

TEST_F(CommandTrace, RefusesTheFolderOfScenesThatAreToBeRendered) {
    ASSERT_EQ(run("generate", "out").status, 0);
    EXPECT_EQ(run("trace", "out").status, kBadInput);
    EXPECT_FALSE(fs::exists(file("out/image.exr")));
}

TEST_F(CommandTrace, ItsImagesGiveWayToARender) {
    ASSERT_EQ(run("trace", "out").status, 0);
    ASSERT_TRUE(is_traced(file("out/image.exr")));
    ASSERT_TRUE(is_traced(file("out/spectral.exr")));
    ASSERT_EQ(run("generate", "out").status, 0);
    for (const std::string& image : kImages) EXPECT_FALSE(fs::exists(file("out/" + image)));
    EXPECT_FALSE(fs::exists(file("out/trace.json")));

    ASSERT_EQ(run("trace", "again").status, 0);
    ASSERT_EQ(run("render", "again").status, 0);
    EXPECT_FALSE(is_traced(file("again/image.exr")));
    EXPECT_FALSE(is_traced(file("again/spectral.exr")));
    EXPECT_FALSE(fs::exists(file("again/trace.json")));
}

TEST_F(CommandTrace, IntegrationsKeepOutOfOtherImagesFolders) {
    ASSERT_EQ(run("trace", "traced").status, 0);
    ASSERT_EQ(run("render", "rendered").status, 0);
    fs::copy(file("rendered"), file("other"), fs::copy_options::recursive);
    const auto integrate = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {"integrate", "rendered"});
        return run_aphotic(folder_.path(), arguments);
    };
    const auto expect_refused = [&](const std::vector<std::string>& arguments,
                                    const std::string& notes) {
        const fs::path image = file(notes).parent_path() / "image.exr";
        const std::string before = read_text_file(image);
        const CommandResult refused = integrate(arguments);
        EXPECT_EQ(refused.status, kBadInput);
        EXPECT_NE(refused.err.find(notes + ": found the notes of a render or trace; allowed: "),
                  std::string::npos)
            << refused.err;
        EXPECT_EQ(read_text_file(image), before);
    };
    expect_refused({"-o", "traced"}, "traced/trace.json");
    expect_refused({"-o", "other"}, "other/manifest.json");
    expect_refused({"--rig", "rig.toml", "--tolerance", "0.5", "-o", "rendered"},
                   "rendered/manifest.json");
    EXPECT_EQ(integrate({"-o", "rendered"}).status, 0);
    EXPECT_EQ(integrate({"-o", "elsewhere"}).status, 0);
    EXPECT_EQ(integrate({"-o", "elsewhere"}).status, 0) << "once more";
}

TEST_F(CommandTrace, IsNotHeldAgainstItself) {
    ASSERT_EQ(run("render", "rendered").status, 0);
    ASSERT_EQ(run("trace", "traced").status, 0);
    for (const char* image : {"image.exr", "spectral.exr"}) {
        const std::string mixed = std::string("with-traced-") + image;
        fs::copy(file("rendered"), file(mixed), fs::copy_options::recursive);
        fs::copy_file(
            file("traced") / image, file(mixed) / image, fs::copy_options::overwrite_existing);
        const CommandResult refused = validate(mixed);
        EXPECT_EQ(refused.status, kBadInput) << refused.out;
        EXPECT_NE(
            refused.err.find(mixed + "/" + image + ": found an image of the reference tracer"),
            std::string::npos)
            << refused.err;
        EXPECT_FALSE(fs::exists(file("validation"))) << "and leaves no folder";
        // As the message says, the frames are still there.
        ASSERT_EQ(run_aphotic(folder_.path(), {"integrate", mixed}).status, 0);
        EXPECT_EQ(validate(mixed).status, 0);
        fs::remove_all(file("validation"));
    }
}

}  // namespace
}  // namespace aphotic::trace_test
