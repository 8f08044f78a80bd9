// SPDX-License-Identifier: BSD-3-Clause
//
// What the commands take of disk, against what is foretold, and that they refuse before they begin
// where there is too little; what they take of memory, as the kernel counts it.
#include "scene_gen/disk_estimate.h"

#include "image/exr.h"
#include "rig/file/rig_reader.h"
#include "spectral/manifest.h"
#include "support/run_command.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <random>
#include <regex>
#include <string>
#include <thread>
#include <vector>

namespace aphotic::needs_test {
namespace {

namespace fs = std::filesystem;

constexpr int kThreads = 2;

fs::path rig_of(const fs::path& folder, int width_px, int height_px) {
    const std::string text =
        read_text_file(std::string(APHOTIC_SOURCE_DIR) + "/scenes/one-lamp.toml");
    write_file(folder / "rig.toml",
               std::regex_replace(text,
                                  std::regex(R"(resolution\s*=\s*\[[^\]]*\])"),
                                  fmt::format("resolution = [{}, {}]", width_px, height_px)));
    return folder / "rig.toml";
}

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
TEST(MemoryOfIntegrate, GrowsWithTheHeightByTheSignalsAlone) {
    if (kIsSanitized) GTEST_SKIP() << "sanitizers take memory of their own";
    constexpr int kWidth_px = 512;
    constexpr int kLow_px = 128;
    constexpr int kHigh_px = 640;
    constexpr std::uint64_t kPixel_bytes = 25;
    constexpr std::uint64_t kNoise_bytes = 8ULL << 20U;  // from run to run
    const auto peak_bytes = [](int height_px) {
        const TempFolder folder;
        rig_of(folder.path(), kWidth_px, height_px);
        const CommandResult made =
            run_aphotic(folder.path(), "generate rig.toml -o out --bands 30");
        EXPECT_EQ(made.status, 0) << made.err;
        write_frames_of_noise(folder.path() / "out", read_manifest(folder.path() / "out"));
        const Measured found = measured(folder.path(), "integrate out --json");
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
TEST(MemoryOfTrace, DoesNotGrowWithTheWavelengths) {
    if (kIsSanitized) GTEST_SKIP() << "sanitizers take memory of their own";
    constexpr int kWidth_px = 1024;
    constexpr int kHeight_px = 64;
    constexpr std::uint64_t kMostMore_bytes = 40ULL << 20U;
    const TempFolder folder;
    rig_of(folder.path(), kWidth_px, kHeight_px);
    const Measured few = traced(folder.path(), "--bands 3");
    const Measured many = traced(folder.path(), "--bands 300");
    EXPECT_EQ(few.status, 0);
    EXPECT_EQ(many.status, 0);
    EXPECT_LE(many.peak_bytes, few.peak_bytes + kMostMore_bytes);
}

TEST(NeedsOfMapsByAltitude, AreForetold) {
    constexpr int kSide_px = 64;
    const TempFolder folder;
    rig_of(folder.path(), kSide_px, kSide_px);
    const auto written_by = [&](const Arguments& options) {
        fs::remove_all(folder.path() / "out");
        const CommandResult made =
            run_aphotic(folder.path(), "lightmap rig.toml -o out --altitude 1:4:1" + options);
        EXPECT_EQ(made.status, 0) << made.err;
        std::uint64_t bytes = 0;
        for (const auto& entry : fs::directory_iterator(folder.path() / "out"))
            bytes += entry.file_size();
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

// A folder with a disk of its own that holds so much, for one command: its status and what it said.
struct OnSmallDisk {
    bool is_possible = false;
    int status = 0;
    std::string said;
};

OnSmallDisk on_small_disk(const fs::path& folder,
                          const std::string& size,
                          const std::string& command) {
    const fs::path script =
        write_script(folder / "small.sh",
                     fmt::format("mkdir -p disk && mount -t tmpfs -o size={} none disk || exit 99\n"
                                 "'{}' {}\nstatus=$?\nls -A disk\nexit $status\n",
                                 size,
                                 APHOTIC_COMMAND,
                                 command));
    const ProcessEnd end = run_process({.executable = "/usr/bin/env",
                                        .arguments = {"unshare", "-rm", script.string()},
                                        .folder = folder,
                                        .environment = {},
                                        .log = folder / "said"},
                                       280.0);
    const std::string said = read_text_file(folder / "said");
    const bool is_possible = end.exit_code != 99 && end.exit_code != 126 && end.exit_code != 127 &&
                             said.find("unshare: ") == std::string::npos;
    return {.is_possible = is_possible, .status = end.exit_code, .said = said};
}

TEST(Needs, ATinyDiskIsRefusedBeforeAnythingIsWritten) {
    const TempFolder folder;
    rig_of(folder.path(), 640, 480);
    for (const char* command : {"trace rig.toml -o disk/out",
                                "generate rig.toml --bands 600 -o disk/out",
                                "render rig.toml -o disk/out",
                                "lightmap rig.toml --altitude 1:4:0.1 -o disk/out",
                                "validate rig.toml -o disk/out",
                                "study rig.toml -o disk/out"}) {
        const OnSmallDisk run = on_small_disk(folder.path(), "64k", command);
        if (!run.is_possible) GTEST_SKIP() << "no tmpfs of our own here: " << run.said;
        EXPECT_EQ(run.status, 3) << command;
        EXPECT_TRUE(std::regex_search(
            run.said,
            std::regex(
                R"(needs up to [0-9.]+ [kMG]B in disk/out, [0-9.]+ kB are free\. Nothing was begun)")))
            << command << ": " << run.said;
        // The listing of the disk that follows is empty.
        EXPECT_TRUE(run.said.ends_with("compress\n")) << command << ": " << run.said;
    }
}

// Scenes that fit, whose frames do not.
TEST(Needs, AShareOfFramesIsRefusedBeforeItBegins) {
    const TempFolder folder;
    rig_of(folder.path(), 640, 480);
    const OnSmallDisk run = on_small_disk(
        folder.path(),
        "1m",
        fmt::format("generate rig.toml --bands 12 -o disk/out && '{}' render disk/out --frames 1/2",
                    APHOTIC_COMMAND));
    if (!run.is_possible) GTEST_SKIP() << "no tmpfs of our own here: " << run.said;
    EXPECT_EQ(run.status, 3) << run.said;
    EXPECT_NE(run.said.find("Nothing was begun"), std::string::npos) << run.said;
}

TEST(Needs, ADiskOfTheirSizeIsEnoughAndTheyMayBeIgnored) {
    const TempFolder folder;
    rig_of(folder.path(), 64, 48);
    const DiskNeeds needs = images_needs({.width_px = 64, .height_px = 48, .wavelengths = 3});
    // In whole pages: of tmpfs, every file and folder takes one more than it fills.
    const std::uint64_t size_kib = needs.folder_bytes / 1024 + 64;
    const std::string command = "trace rig.toml --fitted 3 -o disk/out";
    const OnSmallDisk enough = on_small_disk(folder.path(), fmt::format("{}k", size_kib), command);
    if (!enough.is_possible) GTEST_SKIP() << "no tmpfs of our own here: " << enough.said;
    EXPECT_EQ(enough.status, 0) << enough.said;
    const OnSmallDisk less =
        on_small_disk(folder.path(), fmt::format("{}k", size_kib / 2), command);
    EXPECT_EQ(less.status, 3) << less.said;
    // A traced image compresses: half the room is enough.
    const OnSmallDisk ignored =
        on_small_disk(folder.path(), fmt::format("{}k", size_kib / 2), command + " --ignore-needs");
    EXPECT_EQ(ignored.status, 0) << ignored.said;
}

// The limit of a shell or a scheduler.
TEST(Memory, ThatDoesNotDoIsSaid) {
    if (kIsSanitized) GTEST_SKIP() << "sanitizers take more addresses than any limit";
    const TempFolder folder;
    const fs::path rig = rig_of(folder.path(), 8192, 8192);
    // Of a view that nothing is said about.
    write_file(rig,
               std::regex_replace(read_text_file(rig),
                                  std::regex(R"(pixel_pitch_um\s*=\s*\S+)"),
                                  "pixel_pitch_um = 1.0"));
    const ProcessEnd end = run_process(
        {.executable = "/bin/sh",
         .arguments = {"-c",
                       fmt::format("ulimit -v 300000; exec '{}' lightmap rig.toml -o images.exr",
                                   APHOTIC_COMMAND)},
         .folder = folder.path(),
         .environment = {},
         .log = folder.path() / "said"},
        280.0);
    EXPECT_EQ(end.exit_code, 3);
    EXPECT_EQ(read_text_file(folder.path() / "said"), "aphotic: out of memory\n");
    EXPECT_FALSE(fs::exists(folder.path() / "images.exr"));
}

// 12 bands take 7.8 MB at most, of which the images are 5.9 MB; 13 bands take 8.5 MB; 7.2 MB are
// left. The same render finds its frames there and needs no room for them, another must make its
// own.
TEST(Needs, FramesThatAreKeptNeedNone) {
    const TempFolder folder;
    rig_of(folder.path(), 320, 240);
    const std::string fill = " && dd if=/dev/zero of=disk/fill bs=1k count=300";
    const auto again = [&](const char* bands) {
        return on_small_disk(folder.path(),
                             "9m",
                             fmt::format("render rig.toml --bands 12 -o disk/out{} && '{}' render "
                                         "rig.toml --bands {} -o disk/out",
                                         fill,
                                         APHOTIC_COMMAND,
                                         bands));
    };
    const OnSmallDisk same = again("12");
    if (!same.is_possible) GTEST_SKIP() << "no tmpfs of our own here: " << same.said;
    EXPECT_EQ(same.status, 0) << same.said;
    EXPECT_NE(same.said.find("0 frames rendered, 4 kept"), std::string::npos) << same.said;
    const OnSmallDisk other = again("13");
    EXPECT_EQ(other.status, 3) << other.said;
    EXPECT_NE(other.said.find("needs up to "), std::string::npos) << other.said;
}

// Sixteen thousand pixels each way, which no test could render.
TEST(Needs, OfTheLargestImageArePlannedWithoutMakingIt) {
    const TempFolder folder;
    rig_of(folder.path(), 16384, 16384);
    const CommandResult plan = run_aphotic(folder.path(), "plan rig.toml --fitted 9 --json");
    ASSERT_EQ(plan.status, 0) << plan.err;
    const auto needs = nlohmann::json::parse(plan.out).at("needs");
    constexpr double kPixels = 16384.0 * 16384.0;
    EXPECT_NEAR(needs.at("files").at("spectral.exr").get<double>(),
                (12.0 + 4.0 * 9.0) * kPixels,
                1e-3 * kPixels);
    EXPECT_NEAR(needs.at("files").at("image.exr").get<double>(), 12.0 * kPixels, 1e-3 * kPixels);
}

}  // namespace
}  // namespace aphotic::needs_test
