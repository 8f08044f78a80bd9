// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic trace beside renders: its images are never taken for POV-Ray's.
#include "image/exr.h"
#include "support/command_test.h"
#include "support/small_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace aphotic::trace_test {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kImages{"image.exr", "spectral.exr", "preview.png"};

class CommandTrace : public CommandTest {
  protected:
    void SetUp() override { write_file(path("rig.toml"), small_scene("habcam.toml")); }

    static Arguments run(const std::string& command, const std::string& folder) {
        return command + " rig.toml --wavelengths 470,550,620 --json -o " + folder;
    }
    static Arguments validate(const std::string& rendered) {
        return "validate rig.toml -o validation --json --rendered " + rendered;
    }
};

TEST_F(CommandTrace, RefusesTheFolderOfARender) {
    done(run("render", "out"));
    const std::string image = text_of("out/image.exr");
    refused(run("trace", "out"), "out/manifest.json: found the manifest of a render; allowed: ");
    EXPECT_EQ(text_of("out/image.exr"), image);
    EXPECT_FALSE(fs::exists(path("out/trace.json")));
}

TEST_F(CommandTrace, RefusesTheFolderOfScenesThatAreToBeRendered) {
    done(run("generate", "out"));
    EXPECT_EQ(aphotic(run("trace", "out")).status, kBadInput);
    EXPECT_FALSE(fs::exists(path("out/image.exr")));
}

TEST_F(CommandTrace, ItsImagesGiveWayToARender) {
    done(run("trace", "out"));
    ASSERT_TRUE(is_traced(path("out/image.exr")));
    ASSERT_TRUE(is_traced(path("out/spectral.exr")));
    done(run("generate", "out"));
    for (const std::string& image : kImages) EXPECT_FALSE(fs::exists(path("out/" + image)));
    EXPECT_FALSE(fs::exists(path("out/trace.json")));

    done(run("trace", "again"));
    done(run("render", "again"));
    EXPECT_FALSE(is_traced(path("again/image.exr")));
    EXPECT_FALSE(is_traced(path("again/spectral.exr")));
    EXPECT_FALSE(fs::exists(path("again/trace.json")));
}

TEST_F(CommandTrace, IntegrationsKeepOutOfOtherImagesFolders) {
    done(run("trace", "traced"));
    done(run("render", "rendered"));
    fs::copy(path("rendered"), path("other"), fs::copy_options::recursive);
    const auto expect_refused = [&](const Arguments& arguments, const std::string& notes) {
        const fs::path image = path(notes).parent_path() / "image.exr";
        const std::string before = read_text_file(image);
        refused("integrate rendered" + arguments,
                notes + ": found the record of a render or trace; allowed: ");
        EXPECT_EQ(read_text_file(image), before);
    };
    expect_refused("-o traced", "traced/trace.json");
    expect_refused("-o other", "other/manifest.json");
    expect_refused("--rig rig.toml --tolerance 0.5 -o rendered", "rendered/manifest.json");
    done("integrate rendered -o rendered");
    done("integrate rendered -o elsewhere");
    done("integrate rendered -o elsewhere");  // once more
}

TEST_F(CommandTrace, IsNotHeldAgainstItself) {
    done(run("render", "rendered"));
    done(run("trace", "traced"));
    for (const char* image : {"image.exr", "spectral.exr"}) {
        const std::string mixed = std::string("with-traced-") + image;
        fs::copy(path("rendered"), path(mixed), fs::copy_options::recursive);
        fs::copy_file(
            path("traced") / image, path(mixed) / image, fs::copy_options::overwrite_existing);
        refused(validate(mixed), mixed + "/" + image + ": found an image by the reference tracer");
        // As the message says, the frames are still there.
        done(fmt::format("integrate {}", mixed));
        done(validate(mixed));
        fs::remove_all(path("validation"));
    }
}

}  // namespace
}  // namespace aphotic::trace_test
