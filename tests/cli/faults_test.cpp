// SPDX-License-Identifier: BSD-3-Clause
//
// What breaks while a command runs, or between two runs (docs/develop/faults.md): disks, folders,
// frames, manifests, POV-Ray, and users who edit their scene too early.
#include "base/sha256.h"
#include "base/work_folder.h"
#include "image/exr.h"
#include "image/output_images.h"
#include "spectral/manifest.h"
#include "support/command_test.h"
#include "support/exr_file.h"
#include "support/has.h"
#include "support/scene_text.h"
#include "support/small_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <functional>
#include <limits>
#include <map>
#include <sstream>

namespace aphotic::faults_test {
namespace {

namespace fs = std::filesystem;

class Faults : public CommandTest {
  protected:
    Faults() { write_file(path("rig.toml"), small_scene("habcam.toml")); }

    // Two frames.
    [[nodiscard]] CommandResult render(const std::map<std::string, std::string>& environment = {},
                                       const Arguments& more = {}) const {
        return aphotic("render rig.toml -o out --quiet --wavelengths 450,500,550,600" + more,
                       environment);
    }
    [[nodiscard]] fs::path frame(std::size_t index) const {
        return image_path(path("out"), read_manifest(path("out")).frames[index]);
    }

    static void expect_message(const CommandResult& run, int status, const std::string& part) {
        refused(run, part, status);
        EXPECT_EQ(run.err.rfind("aphotic: "), 0U) << "one message: " << run.err;
    }
    [[nodiscard]] std::string image() const { return sha256_of_file(path("out/image.exr")); }

    // All files below a folder, by their contents.
    [[nodiscard]] static std::map<std::string, std::string> contents(const fs::path& folder) {
        std::map<std::string, std::string> all;
        for (const auto& entry : fs::recursive_directory_iterator(folder)) {
            if (entry.is_regular_file()) all[entry.path().string()] = sha256_of_file(entry.path());
        }
        return all;
    }

    // A POV-Ray that does this instead of rendering, and introduces itself as one all the same.
    [[nodiscard]] std::map<std::string, std::string> povray_that(const std::string& body) const {
        write_script(path("povray"),
                     "if [ \"$1\" = --version ]; then\n  exec povray --version\nfi\n" + body);
        return {{"APHOTIC_POVRAY", path("povray").string()}};
    }

    // A shell script in which mounts may be made that nobody else sees; its words, by line.
    [[nodiscard]] std::vector<std::string> in_a_namespace(const std::string& script) const {
        write_file(path("script"), "APHOTIC='" + std::string(APHOTIC_COMMAND) + "'\n" + script);
        const ProcessEnd end = by("/usr/bin/unshare", "-rm /bin/sh script");
        EXPECT_TRUE(end.succeeded()) << end.words() << "\n" << text_of("log");
        std::istringstream lines(text_of("log"));
        std::vector<std::string> words;
        for (std::string line; std::getline(lines, line);) words.push_back(line);
        return words;
    }
    [[nodiscard]] bool may_mount() const {
        return by_shell("exec unshare -rm mount -t tmpfs none /mnt").succeeded();
    }
};

// --- Two at once --------------------------------------------------------------------------

TEST_F(Faults, ASecondRunInAFolderIsRefused) {
    done(render());
    fs::create_directory(path("raw"));
    done("lightmap rig.toml -o raw/a.exr");
    write_file(path("nav.csv"), "image,altitude_m\na.exr,2\n");
    const auto before = contents(path("out"));
    {
        const FolderLock held(path("out"), FolderUse::Write);
        for (const Arguments& command :
             std::vector<Arguments>{"render rig.toml -o out",
                                    "generate rig.toml -o out",
                                    "integrate out",
                                    "integrate out -o elsewhere",
                                    "trace rig.toml -o out",
                                    "validate rig.toml -o out",
                                    "validate rig.toml --rendered out -o elsewhere",
                                    "study rig.toml --quick -o out",
                                    "lightmap rig.toml --altitude 2:2.2:0.2 -o out",
                                    "correct raw --rig rig.toml --nav nav.csv -o out",
                                    "baseline homomorphic raw -o out",
                                    "fit rig.toml --maps raw/a.exr -o out"}) {
            expect_message(
                aphotic(command), kRunFailed, "out: this folder is in use by another aphotic");
        }
    }
    EXPECT_EQ(contents(path("out")), before);
    done(render());  // and when the first is gone
}

// --- Disks --------------------------------------------------------------------------------

// So many KiB are left when the command starts: from the first file that does not fit to the last.
TEST_F(Faults, AFullDiskIsSaidAndSpaceIsAllThatIsWanting) {
    if (!may_mount()) GTEST_SKIP() << "this system lets users make no namespaces";
    done(render());
    done("trace rig.toml -o traced");
    const std::string words = "--wavelengths 450,500,550,600";
    done("generate rig.toml -o generated " + words);
    // What a command needs is told beforehand (cli/needs_test): here the disk fills under way.
    int failed = 0;
    for (const std::string& line :
         in_a_namespace("WORDS='" + words + "'\n" +
                        read_text_file(APHOTIC_SOURCE_DIR "/tests/cli/full_disk.sh"))) {
        EXPECT_FALSE(line.starts_with("amiss")) << line;
        std::istringstream fields(line);
        std::string name;
        int kib = 0;
        int status = 0;
        fields >> name >> kib >> status;
        if (status == 0) continue;
        ++failed;
        EXPECT_EQ(status, kRunFailed) << line;
        EXPECT_TRUE(has(line, "No space left on device"));
        EXPECT_TRUE(has(line, "disk/out"));
    }
    // Those with no room at all, and more.
    EXPECT_GE(failed, 10);
}

// POV-Ray's introduction is read from a file there: one that cannot be written is not its fault.
TEST_F(Faults, AFullFolderForTemporaryFilesIsSaid) {
    if (!may_mount()) GTEST_SKIP() << "this system lets users make no namespaces";
    const std::vector<std::string> lines = in_a_namespace(
        "mkdir tmp\n"
        "mount -t tmpfs -o size=64k none tmp\n"
        "dd if=/dev/zero of=tmp/fill bs=1k 2>/dev/null\n"
        "TMPDIR=$PWD/tmp \"$APHOTIC\" render rig.toml -o out >/dev/null 2>err\n"
        "echo \"$? $(tr '\\n' ' ' <err)\"\n");
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_TRUE(lines[0].starts_with("3 aphotic: POV-Ray: ")) << lines[0];
    EXPECT_TRUE(has(lines[0], path("tmp/aphotic-").string()));
    EXPECT_TRUE(has(lines[0], ": No space left on device: 0 KiB left"));
    EXPECT_FALSE(fs::exists(path("out")));
}

TEST_F(Faults, AMissingFolderForTemporaryFilesIsSaid) {
    expect_message(render({{"TMPDIR", "/no/such/folder"}}),
                   kRunFailed,
                   "TMPDIR: found /no/such/folder; allowed: an existing folder");
    EXPECT_FALSE(fs::exists(path("out")));
}

// Where no namespaces are to be had, a limit on the size of files stands for the disk.
TEST_F(Faults, AFileThatCannotGrowIsSaid) {
    done(render());
    const auto before = contents(path("out"));
    const auto limited = [&](const std::string& arguments) {
        const ProcessEnd end =
            by_shell("ulimit -f 4; exec '" + std::string(APHOTIC_COMMAND) + "' " + arguments);
        return CommandResult{.status = end.signal != 0 ? 128 + end.signal : end.exit_code,
                             .out = "",
                             .err = text_of("log")};
    };
    for (const std::string arguments : {"render rig.toml -o out --wavelengths 450,500,550,600",
                                        "generate rig.toml -o out --wavelengths 450,500,550,600",
                                        "integrate out",
                                        "trace rig.toml -o traced"}) {
        expect_message(limited(arguments), kRunFailed, "File too large");
    }
    EXPECT_EQ(contents(path("out")), before);
    EXPECT_TRUE(fs::is_empty(path("traced")));
}

TEST_F(Faults, AReadOnlyFolderIsSaid) {
    if (!may_mount()) GTEST_SKIP() << "this system lets users make no namespaces";
    done(render());
    const auto before = contents(path("out"));
    const std::vector<std::string> lines = in_a_namespace(
        "mount --bind out out && mount -o remount,bind,ro out\n"
        "for c in 'render rig.toml -o out' 'generate rig.toml -o out' 'integrate out' \\\n"
        "         'trace rig.toml -o out' 'validate rig.toml -o out' "
        "'study rig.toml --quick -o out'; do\n"
        "  \"$APHOTIC\" $c >/dev/null 2>err; echo \"$? $(tr '\\n' ' ' <err)\"\n"
        "done\n"
        // Its frames can be read all the same.
        "\"$APHOTIC\" integrate out -o elsewhere >/dev/null; echo \"$?\"\n");
    ASSERT_EQ(lines.size(), 7U);
    EXPECT_EQ(lines.back(), "0");
    for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
        EXPECT_EQ(lines[i], "3 aphotic: out: cannot be written to: Read-only file system ");
    }
    EXPECT_EQ(contents(path("out")), before);
}

// --- Frames and manifests -----------------------------------------------------------------

void write_frame(const fs::path& to, int width_px, int height_px, float sample) {
    const auto size = static_cast<std::size_t>(3 * width_px * height_px);
    write_exr(to, width_px, std::vector<float>(size, sample));
}

struct SpoiltFrame {
    const char* how;
    std::function<void(const fs::path& frame)> spoil;
    const char* found;  // when its checksum is noted as if it were right
};

const std::vector<SpoiltFrame> kSpoiltFrames{
    {"truncated",
     [](const fs::path& f) { fs::resize_file(f, fs::file_size(f) / 2); },
     "cannot be read"},
    {"empty", [](const fs::path& f) { fs::resize_file(f, 0); }, "OpenEXR"},
    {"zeroed",
     [](const fs::path& f) {
         write_file(f, std::string(static_cast<std::size_t>(fs::file_size(f)), '\0'));
     },
     "OpenEXR"},
    {"of another size",
     [](const fs::path& f) { write_frame(f, 8, 8, 1.0F); },
     "found 8 x 8 pixels"},
    {"of nothing but NaN",
     [](const fs::path& f) {
         const ExrReader old(f);
         write_frame(f, old.width_px(), old.height_px(), std::numeric_limits<float>::quiet_NaN());
     },
     "is nan at column 0, row 0"},
    {"of nothing but inf",
     [](const fs::path& f) {
         const ExrReader old(f);
         write_frame(f, old.width_px(), old.height_px(), std::numeric_limits<float>::infinity());
     },
     "is inf at column 0, row 0"}};

TEST_F(Faults, ExactlyTheFramesThatAreNotWholeAreRenderedAgain) {
    done(render());
    const std::string before = image();
    for (const SpoiltFrame& spoilt : kSpoiltFrames) {
        for (const bool is_noted : {false, true}) {
            SCOPED_TRACE(std::string(spoilt.how) + (is_noted ? ", noted" : ""));
            spoilt.spoil(frame(1));
            if (is_noted) {
                Manifest manifest = read_manifest(path("out"));
                manifest.frames[1].image_sha256 = sha256_of_file(frame(1));
                write_manifest(path("out"), manifest);
            }
            const CommandResult run = aphotic("integrate out");
            expect_message(run, kRunFailed, frame(1).filename().string());
            EXPECT_TRUE(has(run.err,
                            is_noted ? spoilt.found : "is not the image recorded in the manifest"));
            EXPECT_EQ(image(), before);
            done(render(), "1 frame rendered, 1 kept");
            EXPECT_EQ(image(), before);
        }
    }
}

// It may be of another plan, rendered by hand or copied: of the same size and without a fault.
TEST_F(Faults, AFrameThatNobodyNotedIsRenderedAgain) {
    done(render());
    const std::string before = image();
    Manifest manifest = read_manifest(path("out"));
    manifest.frames[1].image_sha256.clear();
    write_manifest(path("out"), manifest);
    fs::copy_file(frame(0), frame(1), fs::copy_options::overwrite_existing);
    done(render(), "1 frame rendered, 1 kept");
    EXPECT_EQ(image(), before);
}

// What stands under its name was drawn for a scene that the rig no longer asks for.
TEST_F(Faults, AFrameOfAnEarlierRigIsNeverKept) {
    done(render());
    const std::string before = image();
    write_file(path("rig.toml"), with(text_of("rig.toml"), {{"altitude_m", "2.5"}}));
    // Killed before its first frame ends: the manifest of the new rig, the frames of the old.
    expect_message(render(povray_that("exit 1")), kRunFailed, "POV-Ray");
    done(render(), "2 frames rendered, 0 kept");
    EXPECT_NE(image(), before);
}

TEST_F(Faults, AClockSetBackChangesNothing) {
    done(render());
    const auto before = contents(path("out/povray/frames"));
    for (const int years : {-40, 80}) {
        const auto moment = fs::file_time_type::clock::now() + years * std::chrono::years{1};
        for (const auto& entry : fs::recursive_directory_iterator(folder_.path()))
            fs::last_write_time(entry.path(), moment);
        done(render(), "0 frames rendered, 2 kept");
        EXPECT_EQ(contents(path("out/povray/frames")), before);
        done("integrate out");
    }
}

TEST_F(Faults, AManifestThatCannotBeReadIsNotWrittenOver) {
    done(render());
    const std::string good = text_of("out/manifest.json");
    const std::string name = read_manifest(path("out")).frames[0].name;
    for (const std::string& bad : {good.substr(0, good.size() / 2),
                                   std::string("{\"name\": \"an app\"}"),
                                   replaced(good, name, "../../../x")}) {
        write_file(path("out/manifest.json"), bad);
        const auto before = contents(folder_.path());
        for (const char* command : {"render", "generate"}) {
            const CommandResult run =
                aphotic(fmt::format("{} rig.toml -o out --wavelengths 450,500,550,600", command));
            expect_message(run, kBadInput, "out/manifest.json");
            EXPECT_TRUE(
                has(run.err, "nothing was changed. Remove that file to render everything again"));
        }
        EXPECT_EQ(contents(folder_.path()), before);
    }
    fs::remove(path("out/manifest.json"));
    done(render(), "2 frames rendered, 0 kept");
}

// --- A POV-Ray that misbehaves ------------------------------------------------------------

class BadPovRay : public Faults {
  protected:
    void expect_failure(const std::string& body,
                        const std::string& part,
                        const Arguments& more = {}) {
        const CommandResult run = render(povray_that(body), more);
        expect_message(run, kRunFailed, part);
        EXPECT_TRUE(has(run.err, "band_450_500_550nm"));
        EXPECT_TRUE(has(run.err, "Its log: "));
        EXPECT_TRUE(fs::is_empty(path("out/povray/frames")));
        EXPECT_FALSE(fs::exists(path("out/image.exr")));
    }
};

const Arguments kOneJob("--jobs 1");

TEST_F(BadPovRay, GarbageForAnImage) {
    expect_failure("for a; do case \"$a\" in +O*) echo garbage > \"${a#+O}\" ;; esac; done\n",
                   "not a readable OpenEXR image",
                   kOneJob);
}

TEST_F(BadPovRay, ThatHangsAndHeedsNoSignal) {
    expect_failure("trap '' TERM INT HUP\nsleep 1000\n",
                   "was stopped: for 0.5 s it neither printed anything nor used the processor",
                   "--jobs 1 --stall-timeout 0.5");
}

TEST_F(BadPovRay, ThatPrintsWithoutEnd) {
    expect_failure("exec yes\n", "was stopped: it printed more than 64 MiB", kOneJob);
}

TEST_F(BadPovRay, ThatPrintsErrorsWithoutEndIsQuotedInShort) {
    constexpr std::size_t kPage = 4000;
    const CommandResult run =
        render(povray_that("yes 'Parse Error: x' | head -c 30000000\nexit 1\n"), kOneJob);
    expect_message(run, kRunFailed, "exit status 1");
    EXPECT_LT(run.err.size(), kPage);
}

TEST_F(BadPovRay, ThatFloodsItsIntroduction) {
    write_script(path("povray"), "exec yes\n");
    expect_message(render({{"APHOTIC_POVRAY", path("povray").string()}}),
                   kRunFailed,
                   "was stopped: it printed more than 64 MiB");
    EXPECT_FALSE(fs::exists(path("out")));
}

// The share of the pixels is looked for where progress is shown: on a terminal, which `script`
// gives the command.
TEST_F(BadPovRay, ThatLiesAboutItsProgress) {
    if (!fs::exists("/usr/bin/script")) GTEST_SKIP() << "no program that makes a terminal";
    write_script(path("povray"),
                 "if [ \"$1\" != --version ]; then\n"
                 "  echo 'Rendered 1 of 1 pixels (99999999999%)'; sleep 1\n"
                 "fi\n"
                 "exec povray \"$@\"\n");
    const ProcessEnd end =
        by("/usr/bin/script",
           {"-qec",
            "'" + std::string(APHOTIC_COMMAND) + "' render rig.toml -o out --bands 3",
            "/dev/null"},
           {{"APHOTIC_POVRAY", path("povray").string()}});
    const std::string said = text_of("log");
    EXPECT_TRUE(end.succeeded()) << end.words() << said;
    EXPECT_TRUE(has(said, "rendering")) << "no progress: ";
    EXPECT_TRUE(fs::exists(path("out/image.exr")));
}

// --- A scene of the user's own ------------------------------------------------------------

class OwnScene : public BadPovRay {
  protected:
    OwnScene() {
        write_file(path("reef.pov"),
                   "#version 3.7;\n#include \"aphotic.inc\"\nAphotic_Rig ()\n"
                   "Aphotic_Rig_Seafloor ()\n");
    }
    [[nodiscard]] CommandResult render_reef(
        const std::map<std::string, std::string>& environment = {},
        const Arguments& more = {}) const {
        return render(environment, "--scene reef.pov --jobs 1" + more);
    }
};

TEST_F(OwnScene, IsLookedAtUnderTheSameGuards) {
    fs::create_directory(path("tmp"));
    auto environment = povray_that("sleep 1000\n");
    environment["TMPDIR"] = path("tmp").string();
    const CommandResult hanging = render_reef(environment, "--stall-timeout 0.5");
    expect_message(hanging, kRunFailed, "reef.pov: ");
    expect_message(hanging, kRunFailed, "was stopped: for 0.5 s");
    static_cast<void>(povray_that("exec yes\n"));
    expect_message(render_reef(environment), kRunFailed, "it printed more than 64 MiB");
    EXPECT_TRUE(fs::is_empty(path("tmp")));
    EXPECT_FALSE(fs::exists(path("out")));
}

// POV-Ray's first argument is the scene: band_* are frames, strobe_* the survey's. The edit comes
// in the second frame, when the first has been noted.
TEST_F(OwnScene, EditedWhileItRendersIsNotMixed) {
    const auto editing = povray_that(
        "case \"$1\" in *band_600nm*)\n"
        "  until grep -q '\"image_sha256\": \"[0-9a-f]' out/manifest.json; do sleep 0.1; done\n"
        "  echo '// edited' >> reef.pov ;;\n"
        "esac\n"
        "exec povray \"$@\"\n");
    expect_message(render_reef(editing),
                   kRunFailed,
                   "reef.pov: this scene, or a file that it names, changed during the run");
    const Manifest left = read_manifest(path("out"));
    EXPECT_TRUE(left.frames[0].done()) << "rendered before the edit";
    EXPECT_FALSE(left.frames[1].done());
    EXPECT_FALSE(fs::exists(image_path(path("out"), left.frames[1])));
    EXPECT_FALSE(fs::exists(path("out/image.exr")));

    done(render_reef(), "2 frames rendered, 0 kept");
    done("integrate out");
}

TEST_F(OwnScene, EditedWhileItIsLookedAtIsNotPlanned) {
    const auto editing = povray_that(
        "case \"$1\" in *strobe_1_*) echo '// edited' >> reef.pov ;; esac\n"
        "exec povray \"$@\"\n");
    expect_message(render_reef(editing), kRunFailed, "changed during the run");
    EXPECT_FALSE(fs::exists(path("out")));
}

}  // namespace
}  // namespace aphotic::faults_test
