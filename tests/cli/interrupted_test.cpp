// SPDX-License-Identifier: BSD-3-Clause
//
// Renders that are interrupted at random moments, two hundred times: by SIGINT, SIGTERM and
// SIGKILL, of the command and of POV-Ray, with POV-Ray itself and with a script around it. Whatever
// happens, saying the same command again ends in the same image, bit for bit.
//
// Several lanes run side by side, each in a folder of its own, for POV-Ray mostly sleeps.
#include "base/sha256.h"
#include "image/exr.h"
#include "spectral/manifest.h"
#include "support/command_under_way.h"
#include "support/effort.h"
#include "support/run_command.h"
#include "support/small_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>

#include <chrono>
#include <map>
#include <optional>
#include <random>
#include <regex>
#include <thread>

namespace aphotic::interrupted_test {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// Of fewer than 64, often no render goes on to its end.
const int kInterruptions = is_night() ? 200 : 64;
constexpr int kLanes = 4;

enum class Target { Command, PovRay };
struct Blow {
    Target target;
    int signal;
};

std::string rig_text() {
    std::string text = small_scene(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml");
    return text;
}

const Arguments kWavelengths("--wavelengths 430,470,520,560,600,640,700");

// By frame, the inode of those that are there, noted or not: a frame that is rendered again is
// another file.
std::map<std::string, ino_t> done_frames(const fs::path& out) {
    std::map<std::string, ino_t> done;
    if (!fs::exists(manifest_path(out))) return done;
    for (const ManifestFrame& frame : read_manifest(out).frames) {
        struct stat file {};
        if (::stat(image_path(out, frame).c_str(), &file) == 0) done[frame.name] = file.st_ino;
    }
    return done;
}

std::vector<float> samples_of(const fs::path& file) {
    ExrReader frame(file);
    const std::vector<std::string> channels{"R", "G", "B"};
    std::vector<float> samples(3 * static_cast<std::size_t>(frame.width_px()) *
                               static_cast<std::size_t>(frame.height_px()));
    frame.read_rows(0, frame.height_px(), channels, samples);
    return samples;
}

// POV-Ray writes the time into its images, so a frame is compared by its samples.
void expect_same_render(const fs::path& found, const fs::path& expected) {
    for (const char* image : {"image.exr", "spectral.exr"}) {
        EXPECT_EQ(sha256_of_file(found / image), sha256_of_file(expected / image)) << image;
    }
    const Manifest here = read_manifest(found);
    const Manifest there = read_manifest(expected);
    ASSERT_EQ(here.frames.size(), there.frames.size());
    for (std::size_t f = 0; f < here.frames.size(); ++f) {
        EXPECT_EQ(here.frames[f].name, there.frames[f].name);
        EXPECT_EQ(here.frames[f].scene_sha256, there.frames[f].scene_sha256);
        EXPECT_EQ(here.frames[f].image_sha256, sha256_of_file(image_path(found, here.frames[f])));
        EXPECT_EQ(samples_of(image_path(found, here.frames[f])),
                  samples_of(image_path(expected, there.frames[f])));
    }
}

struct Counts {
    int interruptions = 0;
    int finished = 0;  // renders that came to their end after at least one interruption
    int kept = 0;      // frames that were done before, and stayed
    int lines = 0;     // said by commands that were interrupted
};

class Lane {
  public:
    Lane(const fs::path& folder,
         unsigned seed,
         std::string povray,
         const fs::path& expected,
         double longest_s,
         std::vector<Blow> blows)
        : folder_(fs::canonical(folder)),
          random_(seed),
          povray_(std::move(povray)),
          expected_(expected),
          longest_s_(longest_s),
          blows_(std::move(blows)) {
        write_file(folder_ / "rig.toml", rig_text());
        fs::create_directory(folder_ / "tmp");
    }

    Counts interrupt(int times) {
        Counts counts;
        while (counts.interruptions < times) {
            const bool has_started = fs::exists(manifest_path(out()));
            if (once(counts)) {
                counts.finished += has_started ? 1 : 0;
                fs::remove_all(out());
            }
            if (testing::Test::HasFailure()) break;
        }
        while (!once(counts, false)) {
            if (testing::Test::HasFailure()) break;
        }
        return counts;
    }

  private:
    [[nodiscard]] fs::path out() const { return folder_ / "out"; }

    // One run, interrupted or not. Whether it came to its end.
    bool once(Counts& counts, bool is_to_be_interrupted = true) {
        const auto before = done_frames(out());
        Command command(folder_,
                        "render rig.toml -o out --jobs 2" + kWavelengths,
                        {{"APHOTIC_POVRAY", povray_}, {"TMPDIR", (folder_ / "tmp").string()}});
        const std::optional<Blow> blow = is_to_be_interrupted ? strike(command) : std::nullopt;
        const int status = command.wait();
        const std::string said = read_text_file(folder_ / "stderr");
        if (blow) {
            ++counts.interruptions;
            expect_end(*blow, status, said, counts);
        } else {
            EXPECT_EQ(status, 0) << said;
        }
        expect_no_process_in(folder_);
        expect_tidy(status, command.pid());
        const auto after = done_frames(out());
        for (const auto& [name, inode] : before) {
            const auto found = after.find(name);
            EXPECT_TRUE(found != after.end() && found->second == inode)
                << name << " was whole, and was rendered again";
            ++counts.kept;
        }
        if (status == 0) expect_same_render(out(), expected_);
        return status == 0;
    }

    // Nothing when the command has ended before.
    std::optional<Blow> strike(Command& command) {
        const double delay_s = std::uniform_real_distribution(0.0, longest_s_)(random_);
        const Blow blow =
            blows_[std::uniform_int_distribution<std::size_t>(0, blows_.size() - 1)(random_)];
        const auto moment = Clock::now() + std::chrono::duration<double>(delay_s);
        while (Clock::now() < moment && !command.has_ended()) std::this_thread::sleep_for(kPoll);
        if (blow.target == Target::Command) {
            if (command.has_ended()) return std::nullopt;
            ::kill(command.pid(), blow.signal);
            return blow;
        }
        // The first POV-Ray that there is.
        while (!command.has_ended()) {
            for (const pid_t pid : processes_in(folder_)) {
                if (pid != command.pid() && ::kill(pid, blow.signal) == 0) return blow;
            }
            std::this_thread::sleep_for(kPoll);
        }
        return std::nullopt;
    }

    static void expect_end(const Blow& blow, int status, const std::string& said, Counts& counts) {
        if (status == 0) return;  // it came too late
        if (blow.target == Target::PovRay) {
            EXPECT_EQ(status, 3) << said;
            EXPECT_TRUE(said.starts_with("aphotic: POV-Ray")) << said;
            return;
        }
        EXPECT_EQ(status, 128 + blow.signal) << said;
        if (said.empty()) return;  // before there was anything to put in order
        ++counts.lines;
        EXPECT_EQ(said,
                  "aphotic: interrupted; finished frames are kept: run the same command again to "
                  "continue\n");
    }

    // SIGKILL leaves what was half written: a stated limit. The next run that gets as far as its
    // folder takes it away.
    void expect_tidy(int status, pid_t pid) const {
        if (status != 128 + SIGKILL) {
            EXPECT_TRUE(fs::is_empty(folder_ / "tmp")) << "left in TMPDIR";
            if (fs::exists(out())) expect_no_leftovers(out(), fmt::format(".{}", pid));
        }
        if (status == 0) expect_no_leftovers(out());
        fs::remove_all(folder_ / "tmp");
        fs::create_directory(folder_ / "tmp");
    }

    fs::path folder_;
    std::mt19937 random_;
    std::string povray_;
    fs::path expected_;
    double longest_s_;
    std::vector<Blow> blows_;
};

TEST(Interrupted, RendersEndInTheSameImageHoweverOftenTheyAreStruck) {
    const unsigned seed = seed_of_this_run();
    fmt::print("seed {} (APHOTIC_TEST_SEED)\n", seed);
    const TempFolder folder;
    write_file(folder.path() / "rig.toml", rig_text());
    const auto start = Clock::now();
    ASSERT_EQ(
        run_aphotic(folder.path(), "render rig.toml -o undisturbed --jobs 2" + kWavelengths).status,
        0);
    const double longest_s = std::chrono::duration<double>(Clock::now() - start).count();

    // The script around POV-Ray waits for it, and heeds no signal itself.
    const std::string wrapper =
        write_script(folder.path() / "wrapper", "trap '' TERM INT\npovray \"$@\"\nexit $?\n");
    const std::vector<Blow> all{{Target::Command, SIGINT},
                                {Target::Command, SIGTERM},
                                {Target::Command, SIGKILL},
                                {Target::PovRay, SIGINT},
                                {Target::PovRay, SIGTERM},
                                {Target::PovRay, SIGKILL}};
    // What the script starts outlives SIGKILL of the command: a stated limit.
    const std::vector<Blow> with_a_script{{Target::Command, SIGINT}, {Target::Command, SIGTERM}};

    std::vector<Counts> counts(kLanes);
    std::vector<std::thread> threads;
    for (int i = 0; i < kLanes; ++i) {
        const fs::path lane = folder.path() / fmt::format("lane{}", i);
        fs::create_directory(lane);
        const bool has_script = i + 1 == kLanes;
        threads.emplace_back([&, i, lane, has_script] {
            counts[static_cast<std::size_t>(i)] = Lane(lane,
                                                       seed + static_cast<unsigned>(i),
                                                       has_script ? wrapper : "povray",
                                                       folder.path() / "undisturbed",
                                                       longest_s,
                                                       has_script ? with_a_script : all)
                                                      .interrupt(kInterruptions / kLanes);
        });
    }
    Counts sum;
    for (int i = 0; i < kLanes; ++i) {
        threads[static_cast<std::size_t>(i)].join();
        const Counts& lane = counts[static_cast<std::size_t>(i)];
        sum.interruptions += lane.interruptions;
        sum.finished += lane.finished;
        sum.kept += lane.kept;
        sum.lines += lane.lines;
    }
    fmt::print(
        "{} interruptions, {} said in a line; {} renders went on to their end; {} frames kept\n",
        sum.interruptions,
        sum.lines,
        sum.finished,
        sum.kept);
    EXPECT_EQ(sum.interruptions, kInterruptions);
    // So that none of what is checked above was checked of nothing.
    EXPECT_GT(sum.finished, 0);
    EXPECT_GT(sum.kept, 0);
    EXPECT_GT(sum.lines, 0);
}

// A scene of the user's own is looked at in a scratch folder, by a POV-Ray that heeds no signal.
TEST(Interrupted, ASurveyLeavesNothing) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const TempFolder folder;
        const fs::path home = fs::canonical(folder.path());
        write_file(home / "rig.toml", rig_text());
        write_file(home / "reef.pov", "#include \"aphotic.inc\"\nAphotic_Rig ()\n");
        fs::create_directory(home / "tmp");
        const std::string povray =
            write_script(home / "povray",
                         "if [ \"$1\" = --version ]; then\n  exec povray --version\nfi\n"
                         "trap '' TERM INT HUP\nsleep 1000 &\ntouch tmp/started\nwait\nwait\n");
        Command command(home,
                        "render rig.toml --scene reef.pov -o out",
                        {{"APHOTIC_POVRAY", povray}, {"TMPDIR", (home / "tmp").string()}});
        ASSERT_TRUE(comes_true([&] { return fs::exists(home / "tmp" / "started"); }));
        ::kill(command.pid(), signal);
        EXPECT_EQ(command.wait(), 128 + signal);
        fs::remove(home / "tmp" / "started");
        EXPECT_TRUE(fs::is_empty(home / "tmp")) << "left in TMPDIR";
        EXPECT_FALSE(fs::exists(home / "out"));
        EXPECT_TRUE(comes_true([&] { return processes_in(home).empty(); }));
        EXPECT_TRUE(read_text_file(home / "stderr").starts_with("aphotic: interrupted; "));
    }
}

// Nothing to put in order: the image of a quarter of an hour is not waited for.
TEST(Interrupted, ATraceEndsAtOnce) {
    const TempFolder folder;
    std::string text =
        read_text_file(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam-emitters.toml");
    const std::regex size(R"(\nresolution[^\n]*)");
    write_file(folder.path() / "rig.toml",
               std::regex_replace(text, size, "\nresolution = [8000, 8000]"));
    Command command(folder.path(), "trace rig.toml -o out --threads 1", {});
    ASSERT_TRUE(comes_true([&] { return fs::exists(folder.path() / "out"); }));
    ::kill(command.pid(), SIGINT);
    EXPECT_EQ(command.wait(), 128 + SIGINT);
    EXPECT_FALSE(fs::exists(folder.path() / "out" / "image.exr"));
    // What it leaves half written, the next run takes away.
    EXPECT_EQ(run_aphotic(folder.path(), "generate rig.toml -o out --bands 3").status, 0);
    expect_no_leftovers(folder.path() / "out");
}

}  // namespace
}  // namespace aphotic::interrupted_test
