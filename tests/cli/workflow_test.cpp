// SPDX-License-Identifier: BSD-3-Clause
//
// The workflow by real Snakemake, on this machine and by Slurm on a node of its own, and
// docs/guides/cluster.md's line by real GNU parallel. Snakemake is stopped midway and started
// again, and one job fails at first. In the end all images are those of the command by itself, bit
// for bit.
#include "base/atomic_file.h"
#include "plugin/process.h"
#include "support/command_under_way.h"
#include "support/has.h"
#include "support/run_command.h"
#include "support/small_rig.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <regex>
#include <sstream>
#include <string>
#include <thread>

namespace aphotic::workflow_test {
namespace {

namespace fs = std::filesystem;

// For what hangs: far more than all takes on a machine with far more work than cores.
constexpr double kEngine_s = 1500.0;

bool has_program(const std::string& name) {
    std::istringstream folders(std::getenv("PATH"));
    for (std::string folder; std::getline(folders, folder, ':');) {
        if (fs::exists(fs::path(folder) / name)) return true;
    }
    return false;
}

class Workflow : public SmallRigTest {
  protected:
    // `aphotic` of the tests, which fails once at an altitude of 2 m in thin water.
    void SetUp() override {
        write_script(path("aphotic-of-tests"),
                     "case \"$*\" in *altitude_m=2*multiple=0.5*)\n"
                     "    [ -e failed ] || { touch failed; echo no light today >&2; exit 3; } ;;\n"
                     "esac\nexec '" +
                         std::string(APHOTIC_COMMAND) + "' \"$@\"\n");
    }

    // By a shell; its process number in `pid`.
    [[nodiscard]] ProcessRequest shell(const std::string& script) const {
        return {
            .executable = "/bin/sh",
            .arguments = {"-c", "echo $$ > pid; " + script},
            .folder = home_,
            .environment = {{"HOME", home_.string()}, {"XDG_CACHE_HOME", path("cache").string()}},
            .log = path("engine.log")};
    }
    [[nodiscard]] int run(const std::string& script) const {
        return run_process(shell(script), kEngine_s).exit_code;
    }
    [[nodiscard]] std::string log() const { return text_of("engine.log"); }

    void expect_image_of(const std::string& altitude,
                         const std::string& multiple,
                         const fs::path& image) const {
        fs::remove_all(path("alone"));
        done(fmt::format("trace rig.toml -o alone --set sled.altitude_m={} --set water.multiple={}",
                         altitude,
                         multiple));
        EXPECT_TRUE(text_of("alone/image.exr") == read_text_file(image)) << image;
    }

    static bool comes_true_in_time(const std::function<bool()>& condition) {
        const auto deadline =
            std::chrono::steady_clock::now() + std::chrono::duration<double>(kEngine_s);
        while (!condition()) {
            if (std::chrono::steady_clock::now() > deadline) return false;
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        }
        return true;
    }
};

TEST_F(Workflow, BySnakemake) {
    if (!has_program("snakemake")) GTEST_SKIP() << "Snakemake is not installed";
    fs::copy(
        fs::path(APHOTIC_SOURCE_DIR) / "workflow", path("workflow"), fs::copy_options::recursive);
    done("survey rig.toml --images 5 -o dive");
    const std::string numbers = "--bayer RGGB --black-level 64 --white-level 4095";
    const std::string navigation = "--nav dive/navigation-measured.txt";
    fs::create_directory(path("config"));
    write_file(path("config/config.yaml"),
               "aphotic: ./aphotic-of-tests\nthreads: 1\ncommand: trace\n"
               "rigs: {small: rig.toml}\narguments: ''\n"
               "set: {sled.altitude_m: [1.5, 2], water.multiple: [0.5, 1, 2]}\n"
               "surveys:\n  dive: {rig: rig.toml, images: dive/raw, shares: 2, arguments: " +
                   navigation + " " + numbers + "}\n");
    const std::string snakemake = "snakemake --cores 2 --keep-going --rerun-incomplete";
    const auto images = [&] {
        std::size_t count = 0;
        if (!fs::exists(path("results/rigs/small"))) return count;
        for (const auto& entry : fs::directory_iterator(path("results/rigs/small")))
            count += fs::exists(entry.path() / "image.exr") ? 1 : 0;
        return count;
    };
    {
        Process process(shell("exec " + snakemake));
        ASSERT_TRUE(comes_true_in_time([&] { return images() > 0 || process.poll(); })) << log();
        if (!process.poll()) ::kill(std::stoi(read_text_file(path("pid"))), SIGTERM);
        ASSERT_TRUE(comes_true_in_time([&] { return process.poll().has_value(); })) << log();
        ASSERT_TRUE(comes_true_in_time([&] { return processes_in(home_).empty(); }));
    }
    ASSERT_EQ(run(snakemake), 0) << log();
    EXPECT_TRUE(fs::exists(path("failed")));
    EXPECT_EQ(images(), 6U);
    for (const char* altitude : {"1.5", "2"})
        for (const char* multiple : {"0.5", "1", "2"})
            expect_image_of(altitude,
                            multiple,
                            path(std::string("results/rigs/small/sled.altitude_m=") + altitude +
                                 "_water.multiple=" + multiple + "/image.exr"));
    std::istringstream table(read_text_file(path("results/rigs.csv")));
    std::string line;
    std::getline(table, line);
    EXPECT_TRUE(line.starts_with("rig,sled.altitude_m,water.multiple,")) << line;
    int lines = 0;
    while (std::getline(table, line)) ++lines;
    EXPECT_EQ(lines, 6);

    // Shares joined are the survey by itself.
    ASSERT_EQ(run("'" + std::string(APHOTIC_COMMAND) + "' correct dive/raw --rig rig.toml " +
                  navigation + " " + numbers + " -o corrected"),
              0)
        << log();
    std::size_t corrected = 0;
    for (const auto& entry : fs::directory_iterator(path("corrected"))) {
        if (entry.path().extension() != ".tif") continue;
        ++corrected;
        EXPECT_TRUE(read_text_file(entry.path()) ==
                    read_text_file(path("results/surveys/dive") / entry.path().filename()))
            << entry.path();
    }
    EXPECT_EQ(corrected, 5U);

    // What is done is not done again; what is new is.
    EXPECT_EQ(run(snakemake + " --dry-run"), 0);
    EXPECT_TRUE(has(log(), "Nothing to be done"));
    const fs::path old = path("results/rigs/small/sled.altitude_m=2_water.multiple=1/image.exr");
    const auto written = fs::last_write_time(old);
    const std::string config = read_text_file(path("config/config.yaml"));
    write_file(path("config/config.yaml"),
               std::regex_replace(config, std::regex("1, 2]}"), "1, 2, 4]}"));
    EXPECT_EQ(run(snakemake), 0) << log();
    EXPECT_EQ(images(), 8U);
    EXPECT_EQ(fs::last_write_time(old), written);
}

// Of one node, gone with its object.
class OneNodeSlurm {
  public:
    OneNodeSlurm() { is_up_ = script("start") == 0; }
    ~OneNodeSlurm() { script("stop"); }
    OneNodeSlurm(const OneNodeSlurm&) = delete;
    OneNodeSlurm& operator=(const OneNodeSlurm&) = delete;

    [[nodiscard]] bool is_up() const { return is_up_; }
    [[nodiscard]] std::string log() const { return read_text_file(folder_.path() / "log"); }
    // What its tools need to find it.
    [[nodiscard]] std::string environment() const {
        return "export SLURM_CONF='" + (folder_.path() / "slurm.conf").string() + "'; ";
    }

  private:
    int script(const std::string& verb) {
        return run_process(
                   {.executable = std::string(APHOTIC_SOURCE_DIR) + "/tests/support/one-node-slurm",
                    .arguments = {verb, folder_.path().string()},
                    .folder = "/",
                    .environment = {},
                    .log = folder_.path() / "log"},
                   kEngine_s)
            .exit_code;
    }

    TempFolder folder_;
    bool is_up_ = false;
};

TEST_F(Workflow, BySlurm) {
    for (const char* program : {"snakemake", "sbatch", "srun"}) {
        if (!has_program(program)) GTEST_SKIP() << program << " is not installed";
    }
    if (run("snakemake --help | grep -q slurm-status-command") != 0)
        GTEST_SKIP() << "snakemake-executor-plugin-slurm is not installed";
    if (::geteuid() != 0) GTEST_SKIP() << "only root may start a node";
    const OneNodeSlurm slurm;
    if (!slurm.is_up()) GTEST_SKIP() << "no node comes up on this machine: " << slurm.log();
    fs::copy(
        fs::path(APHOTIC_SOURCE_DIR) / "workflow", path("workflow"), fs::copy_options::recursive);
    fs::create_directory(path("config"));
    write_file(path("config/config.yaml"),
               "aphotic: ./aphotic-of-tests\ncommand: trace\nrigs: {small: rig.toml}\n"
               "set: {sled.altitude_m: [1.5, 2], water.multiple: [0.5]}\n");
    // A node of its own keeps no accounts.
    EXPECT_EQ(run(slurm.environment() +
                  "snakemake --workflow-profile workflow/profiles/slurm --latency-wait 5 "
                  "--slurm-no-account --slurm-status-command squeue "
                  "--slurm-init-seconds-before-status-checks 2"),
              0)
        << log();
    for (const char* altitude : {"1.5", "2"})
        expect_image_of(altitude,
                        "0.5",
                        path(std::string("results/rigs/small/sled.altitude_m=") + altitude +
                             "_water.multiple=0.5/image.exr"));
}

// The line of docs/guides/cluster.md.
TEST_F(Workflow, ByGnuParallel) {
    if (!has_program("parallel")) GTEST_SKIP() << "GNU parallel is not installed";
    const std::string parallel =
        "parallel --will-cite -j 2 --joblog jobs.log --resume-failed ./aphotic-of-tests trace "
        "rig.toml --set sled.altitude_m={1} --set water.multiple={2} -o out/{1}-{2} ::: 1.5 2 ::: "
        "0.5 1";
    EXPECT_EQ(run(parallel), 1) << "one fails";
    EXPECT_EQ(run(parallel), 0) << log();
    for (const char* altitude : {"1.5", "2"})
        for (const char* multiple : {"0.5", "1"})
            expect_image_of(altitude,
                            multiple,
                            path(std::string("out/") + altitude + "-" + multiple + "/image.exr"));
}

}  // namespace
}  // namespace aphotic::workflow_test
