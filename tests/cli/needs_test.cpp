// SPDX-License-Identifier: BSD-3-Clause
//
// What the commands take of disk, against what is foretold, and that they refuse before they begin
// where there is too little; what they take of memory, as the kernel counts it.
#include "scene_gen/resource_needs.h"

#include "base/number.h"
#include "image/exr.h"
#include "rig/file/rig_reader.h"
#include "spectral/manifest.h"
#include "support/command_test.h"
#include "support/has.h"
#include "support/scene_text.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <random>
#include <regex>
#include <string>
#include <thread>
#include <vector>

namespace aphotic::needs_test {
namespace {

namespace fs = std::filesystem;

constexpr int kThreads = 2;

// Tests with one lamp over images of any size.
class Needs : public CommandTest {
  protected:
    void put_rig(int width_px, int height_px) const {
        write_file(path("rig.toml"),
                   with(scene_text("one-lamp.toml"),
                        {{"resolution", fmt::format("[{}, {}]", width_px, height_px)}}));
    }
    // Commands in a folder with a disk of its own that holds so much: their status and what they
    // say; nothing where there can be no such disk.
    [[nodiscard]] std::optional<CommandResult> on_small_disk(const std::string& size,
                                                             const std::string& command) const {
        const ProcessEnd end =
            by("/usr/bin/env",
               Arguments("unshare -rm /bin/sh -c") +
                   Arguments{fmt::format(
                       "mkdir -p disk && mount -t tmpfs -o size={} none disk || exit 99\n"
                       "'{}' {}\nstatus=$?\nls -A disk\nexit $status\n",
                       size,
                       APHOTIC_COMMAND,
                       command)});
        const std::string said = text_of("log");
        const bool is_possible = end.exit_code != 99 && end.exit_code != 126 &&
                                 end.exit_code != 127 && !has(said, "unshare: ");
        if (!is_possible) return std::nullopt;
        return CommandResult{.status = end.exit_code, .out = "", .err = said, .line = command};
    }
};
using MemoryOfIntegrate = Needs;
using MemoryOfRender = Needs;
using MemoryOfTrace = Needs;
using NeedsOfMapsByAltitude = Needs;
using Memory = Needs;
constexpr const char* kNoDisk = "no tmpfs of our own here";

// A command with a sanitizer takes several times the memory of the one that is shipped.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kIsSanitized = true;
#elif defined(__has_feature)
constexpr bool kIsSanitized = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
constexpr bool kIsSanitized = false;
#endif

// The largest memory that the command had at a time.
struct Measured {
    int status = -1;
    std::uint64_t peak_bytes = 0;
};

Measured measured(const fs::path& folder, Arguments arguments) {
    arguments.insert(arguments.begin(), APHOTIC_COMMAND);
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    // The child of a fork would begin with the memory of this process, vfork's with none of it.
    const pid_t child = ::vfork();
    if (child == 0) {
        if (::chdir(folder.c_str()) == 0) ::execv(argv[0], argv.data());
        ::_exit(127);
    }
    int status = 0;
    rusage used{};
    if (child < 0 || ::wait4(child, &status, 0, &used) != child) return {};
    constexpr std::uint64_t kKibibyte = 1024;
    return {.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1,
            .peak_bytes = kKibibyte * static_cast<std::uint64_t>(used.ru_maxrss)};
}

// Frames that no compression makes smaller, in place of POV-Ray's.
void write_frames_of_noise(const fs::path& folder, const Manifest& manifest) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> between(0.0F, 1.0F);
    fs::create_directories(folder / "povray" / "frames");
    for (const ManifestFrame& frame : manifest.frames) {
        ExrWriter exr(
            image_path(folder, frame), manifest.width_px, manifest.height_px, {"R", "G", "B"}, {});
        std::vector<float> row(3 * static_cast<std::size_t>(manifest.width_px));
        for (int r = 0; r < manifest.height_px; ++r) {
            for (float& sample : row) sample = between(random);
            exr.write_rows(1, row);
        }
        exr.finish();
    }
}

// Rows come and go in blocks: what a higher image takes more are its signals and its preview, 25
// bytes a pixel (image/row_blocks.h). All of its radiance would be 120 bytes a pixel.
TEST_F(MemoryOfIntegrate, GrowsWithTheHeightByTheSignalsAlone) {
    if (kIsSanitized) GTEST_SKIP() << "sanitizers take memory of their own";
    constexpr int kWidth_px = 512;
    constexpr int kLow_px = 128;
    constexpr int kHigh_px = 640;
    constexpr std::uint64_t kPixel_bytes = 25;
    constexpr std::uint64_t kNoise_bytes = 8ULL << 20U;  // from run to run
    const auto peak_bytes = [&](int height_px) {
        put_rig(kWidth_px, height_px);
        fs::remove_all(path("out"));
        done("generate rig.toml -o out --bands 30");
        write_frames_of_noise(path("out"), read_manifest(path("out")));
        const Measured found = measured(home_, "integrate out --json");
        EXPECT_EQ(found.status, 0);
        return found.peak_bytes;
    };
    constexpr std::uint64_t kMore_px = std::uint64_t{kWidth_px} * (kHigh_px - kLow_px);
    EXPECT_LE(peak_bytes(kHigh_px), peak_bytes(kLow_px) + kPixel_bytes * kMore_px + kNoise_bytes);
}

Measured traced(const fs::path& folder, const Arguments& wavelengths) {
    return measured(
        folder,
        Arguments{
            "trace", "rig.toml", "-o", "out", "--threads", std::to_string(kThreads), "--json"} +
            wavelengths);
}

// A hundred times as many may take a block of rows, of kTracedSamples, and rows under compression
// that are not yet as long as a block of rows for few: measured, 22 MB. All rows of a block of 64
// would take 250 MB more.
TEST_F(MemoryOfTrace, DoesNotGrowWithTheWavelengths) {
    if (kIsSanitized) GTEST_SKIP() << "sanitizers take memory of their own";
    constexpr int kWidth_px = 1024;
    constexpr int kHeight_px = 64;
    constexpr std::uint64_t kMostMore_bytes = 40ULL << 20U;
    put_rig(kWidth_px, kHeight_px);
    const Measured few = traced(home_, "--bands 3");
    const Measured many = traced(home_, "--bands 300");
    EXPECT_EQ(few.status, 0);
    EXPECT_EQ(many.status, 0);
    EXPECT_LE(many.peak_bytes, few.peak_bytes + kMostMore_bytes);
}

TEST_F(NeedsOfMapsByAltitude, AreForetold) {
    constexpr int kSide_px = 64;
    put_rig(kSide_px, kSide_px);
    const auto written_by = [&](const Arguments& options) {
        fs::remove_all(path("out"));
        done("lightmap rig.toml -o out --altitude 1:4:1" + options);
        std::uint64_t bytes = 0;
        for (const auto& entry : fs::directory_iterator(path("out"))) bytes += entry.file_size();
        return bytes;
    };
    const std::uint64_t maps_bytes =
        lightmap_needs({.maps = 4, .width_px = kSide_px, .height_px = kSide_px}).folder_bytes;
    const std::uint64_t maps = written_by({});
    EXPECT_LE(maps, maps_bytes);
    EXPECT_GE(maps, maps_bytes / 4);  // smooth, and floats all the same
    const std::uint64_t oplab_bytes = oplab_needs(kSide_px, kSide_px).folder_bytes;
    const std::uint64_t oplab = written_by("--export oplab");
    EXPECT_LE(oplab, oplab_bytes);
    EXPECT_GE(oplab, oplab_bytes / 2);
}

TEST_F(Needs, ATinyDiskIsRefusedBeforeAnythingIsWritten) {
    put_rig(640, 480);
    for (const char* command : {"trace rig.toml -o disk/out",
                                "generate rig.toml --bands 600 -o disk/out",
                                "render rig.toml -o disk/out",
                                "lightmap rig.toml --altitude 1:4:0.1 -o disk/out",
                                "validate rig.toml -o disk/out",
                                "study rig.toml -o disk/out"}) {
        const auto run = on_small_disk("64k", command);
        if (!run) GTEST_SKIP() << kNoDisk;
        EXPECT_EQ(run->status, kRunFailed) << command;
        EXPECT_TRUE(std::regex_search(
            run->err,
            std::regex(
                R"(needs up to [0-9.]+ [kMG]B in disk/out, [0-9.]+ kB free\. Nothing was started)")))
            << command << ": " << run->err;
        // The listing of the disk that follows is empty.
        EXPECT_TRUE(run->err.ends_with("compress\n")) << command << ": " << run->err;
    }
}

// Scenes that fit, whose frames do not.
TEST_F(Needs, AShareOfFramesIsRefusedBeforeItBegins) {
    put_rig(640, 480);
    const auto run = on_small_disk(
        "1m",
        fmt::format("generate rig.toml --bands 12 -o disk/out && '{}' render disk/out --frames 1/2",
                    APHOTIC_COMMAND));
    if (!run) GTEST_SKIP() << kNoDisk;
    EXPECT_EQ(run->status, kRunFailed);
    EXPECT_TRUE(has(run->err, "Nothing was started"));
}

TEST_F(Needs, ADiskOfTheirSizeIsEnoughAndTheyMayBeIgnored) {
    put_rig(64, 48);
    const ResourceNeeds needs = images_needs({.width_px = 64, .height_px = 48, .wavelengths = 3});
    // In whole pages: of tmpfs, every file and folder takes one more than it fills.
    const std::uint64_t size_kib = needs.folder_bytes / 1024 + 64;
    const std::string command = "trace rig.toml --fitted 3 -o disk/out";
    const auto enough = on_small_disk(fmt::format("{}k", size_kib), command);
    if (!enough) GTEST_SKIP() << kNoDisk;
    done(*enough);
    // A traced image compresses: half the room is enough.
    const std::string half = fmt::format("{}k", size_kib / 2);
    EXPECT_EQ(on_small_disk(half, command)->status, kRunFailed);
    done(*on_small_disk(half, command + " --ignore-needs"));
}

// A POV-Ray takes no more than is said, and half of that is near. It is the largest of what the
// command starts, and larger than the command itself.
TEST_F(MemoryOfRender, IsAsPlanned) {
    if (kIsSanitized) GTEST_SKIP() << "sanitizers take memory of their own";
    constexpr int kWidth_px = 2000;
    constexpr int kHeight_px = 1500;
    put_rig(kWidth_px, kHeight_px);
    const auto plan = nlohmann::json::parse(done("plan rig.toml --bands 1 --json").out);
    const std::uint64_t said_bytes = plan.at("needs").at("job_memory_bytes");
    done("generate rig.toml -o out --bands 1");
    const Measured found = measured(home_, Arguments("render out --frames 1/1 --jobs 1 --json"));
    EXPECT_EQ(found.status, 0);
    EXPECT_LE(found.peak_bytes, said_bytes);
    EXPECT_GE(found.peak_bytes, said_bytes / 2);
}

// Told before a POV-Ray, here one that gives up at once, is begun. Words have three digits.
TEST_F(Memory, LowersTheJobsToWhatItAllows) {
    constexpr double kDigits = 0.01;
    put_rig(16384, 16384);
    write_file(path("rig.toml"), with(text_of("rig.toml"), {{"pixel_pitch_um", "0.5"}}));
    write_script(path("povray"), "[ \"$1\" = --version ] && exec povray --version\nexit 1\n");
    const CommandResult run = aphotic(
        Arguments("render rig.toml -o out --bands 1 --jobs 1024 --ignore-needs --povray ./povray"));
    EXPECT_EQ(run.status, kRunFailed);
    std::smatch found;
    ASSERT_TRUE(
        std::regex_search(run.err,
                          found,
                          std::regex("renders (\\d+) frames? at a time, since POV-Ray takes up to "
                                     "(.*) GB of memory for each, and (.*) GB is free")))
        << run.err;
    const double jobs = read_number<double>(found[1].str()).value();
    const double each_gb = read_number<double>(found[2].str()).value();
    const double free_gb = read_number<double>(found[3].str()).value();
    EXPECT_TRUE(jobs == 1.0 || jobs * each_gb <= free_gb * (1.0 + kDigits)) << run.err;
    EXPECT_GE((jobs + 1.0) * each_gb, free_gb * (1.0 - kDigits));
}

// The limit of a shell or a scheduler.
TEST_F(Memory, ThatDoesNotDoIsSaid) {
    if (kIsSanitized) GTEST_SKIP() << "sanitizers take more addresses than any limit";
    put_rig(8192, 8192);
    // Of a view that nothing is said about.
    write_file(path("rig.toml"), with(text_of("rig.toml"), {{"pixel_pitch_um", "1.0"}}));
    const ProcessEnd end = by_shell(fmt::format(
        "ulimit -v 300000; exec '{}' lightmap rig.toml -o images.exr", APHOTIC_COMMAND));
    EXPECT_EQ(end.exit_code, kRunFailed);
    EXPECT_EQ(text_of("log"), "aphotic: out of memory\n");
    EXPECT_FALSE(fs::exists(path("images.exr")));
}

// 12 bands take 7.8 MB at most, of which the images are 5.9 MB; 13 bands take 8.5 MB; 7.2 MB are
// left. The same render finds its frames there and needs no room for them, another must make its
// own.
TEST_F(Needs, FramesThatAreKeptNeedNone) {
    put_rig(320, 240);
    const std::string fill = " && dd if=/dev/zero of=disk/fill bs=1k count=300";
    const auto again = [&](const char* bands) {
        return on_small_disk("9m",
                             fmt::format("render rig.toml --bands 12 -o disk/out{} && '{}' render "
                                         "rig.toml --bands {} -o disk/out",
                                         fill,
                                         APHOTIC_COMMAND,
                                         bands));
    };
    const auto same = again("12");
    if (!same) GTEST_SKIP() << kNoDisk;
    done(*same);
    EXPECT_TRUE(has(same->err, "0 frames rendered, 4 kept"));
    const auto other = again("13");
    EXPECT_EQ(other->status, kRunFailed);
    EXPECT_TRUE(has(other->err, "needs up to "));
}

// Sixteen thousand pixels each way, which no test could render.
TEST_F(Needs, OfTheLargestImageArePlannedWithoutMakingIt) {
    put_rig(16384, 16384);
    const auto files = json_by("plan rig.toml --fitted 9 --json").at("needs").at("files");
    constexpr double kPixels = 16384.0 * 16384.0;
    constexpr double kHeaders = 1e-3 * kPixels;
    EXPECT_NEAR(files.at("spectral.exr").get<double>(), (12.0 + 4.0 * 9.0) * kPixels, kHeaders);
    EXPECT_NEAR(files.at("image.exr").get<double>(), 12.0 * kPixels, kHeaders);
}

}  // namespace
}  // namespace aphotic::needs_test
