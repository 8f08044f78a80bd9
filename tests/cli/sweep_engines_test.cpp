// SPDX-License-Identifier: BSD-3-Clause
//
// A sweep of 24 rigs by real engines: GNU parallel, Snakemake, and Slurm on a node of its own. Each
// is stopped midway and started again, and one task fails twice. In the end all tasks are done, and
// their images are those of a run without an engine, bit for bit.
#include "base/atomic_file.h"
#include "plugin/process.h"
#include "support/command_under_way.h"
#include "support/run_command.h"
#include "support/small_sweep.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace aphotic::sweep_engines_test {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kTasks = 24;
constexpr std::size_t kFailures = 2;
// For what hangs: far more than all 24 take on a machine with far more work than cores.
constexpr double kEngine_s = 1500.0;

bool has_program(const std::string& name) {
    std::istringstream folders(std::getenv("PATH"));
    for (std::string folder; std::getline(folders, folder, ':');) {
        if (fs::exists(fs::path(folder) / name)) return true;
    }
    return fs::exists(fs::path("/usr/sbin") / name);
}

std::string task_name(std::size_t number) {
    return (number < 10 ? "task-000" : "task-00") + std::to_string(number);
}

class SweepEngines : public testing::Test {
  protected:
    void SetUp() override {
        write_script(small_.folder() / "povray-of-tests",
                     R"sh(case $PWD in
*/task-0005/*)
    failures=${PWD%/task-0005/*}/failures
    touch "$failures"
    if [ "$(wc -c < "$failures")" -lt 2 ]; then
        printf x >> "$failures"
        echo "no light today" >&2
        exit 1
    fi
    ;;
esac
exec povray "$@"
)sh");
        small_.write("render", R"(arguments = ["--fitted", "3", "--povray", "./povray-of-tests"]
samples = 6
[[vary]]
key = "sled.altitude_m"
values = [1.5, 2]
[[vary]]
key = "strobe.fore.power"
range = [0.5, 1, 0.5]
[[vary]]
key = "strobe.aft.aim.tilt_deg"
between = [20, 30]
[[vary]]
key = "water.multiple"
between = [0.5, 2]
)");
        const CommandResult made =
            run_aphotic(small_.folder(), {"sweep", "sweep.toml", "-o", "out"});
        ASSERT_EQ(made.status, 0) << made.err;
    }

    [[nodiscard]] fs::path out(const std::string& file) const {
        return small_.folder() / "out" / file;
    }

    // By a shell, in the sweep's folder; its process number in `pid`.
    [[nodiscard]] ProcessRequest shell(const std::string& script) const {
        return {.executable = "/bin/sh",
                .arguments = {"-c", "echo $$ > pid; " + script},
                .folder = small_.folder() / "out",
                .environment = {{"HOME", small_.folder().string()},
                                {"XDG_CACHE_HOME", (small_.folder() / "cache").string()}},
                .log = small_.folder() / "engine.log"};
    }

    int run(const std::string& script) const {
        return run_process(shell(script), kEngine_s).exit_code;
    }

    [[nodiscard]] std::string log() const { return read_text_file(small_.folder() / "engine.log"); }

    [[nodiscard]] std::size_t ended() const {
        std::size_t count = 0;
        for (std::size_t number = 1; number <= kTasks; ++number)
            count += fs::exists(out(task_name(number) + "/result.json")) ? 1 : 0;
        return count;
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

    // Begins, and has it end by SIGTERM once some tasks have ended.
    void run_and_stop_midway(const std::string& script) const {
        Process process(shell("exec " + script));
        ASSERT_TRUE(comes_true_in_time([&] { return ended() >= 3 || process.poll(); })) << log();
        if (!process.poll()) ::kill(std::stoi(read_text_file(out("pid"))), SIGTERM);
        ASSERT_TRUE(comes_true_in_time([&] { return process.poll().has_value(); })) << log();
        ASSERT_TRUE(comes_true_in_time([&] { return processes_in(small_.folder()).empty(); }));
    }

    void expect_whole() const {
        const CommandResult status = run_aphotic(small_.folder(), {"sweep", "out", "--collect"});
        EXPECT_EQ(status.status, 0) << status.out << log();
        EXPECT_EQ(read_text_file(out("failures")).size(), kFailures);
        expect_no_leftovers(out(""));
        // Without an engine, a task after the other.
        ASSERT_EQ(run_aphotic(small_.folder(), {"sweep", "sweep.toml", "-o", "alone"}).status, 0);
        const fs::path alone = small_.folder() / "alone";
        write_file(alone / "failures", "xx");  // it fails no more
        for (std::size_t number = 1; number <= kTasks; ++number) {
            ASSERT_EQ(
                run_aphotic(small_.folder(), {"sweep", "alone", "--task", std::to_string(number)})
                    .status,
                0);
            for (const char* file : {"image.exr", "spectral.exr", "preview.png"}) {
                const fs::path image = fs::path(task_name(number)) / "out" / file;
                EXPECT_TRUE(read_text_file(alone / image) == read_text_file(out(image.string())))
                    << image;
            }
        }
    }

    SmallSweep small_;
};

TEST_F(SweepEngines, GnuParallel) {
    if (!has_program("parallel")) GTEST_SKIP() << "GNU parallel is not installed";
    const std::string parallel = "parallel --will-cite --retries 3 -j 4 --arg-file tasks.txt";
    // By SIGTERM it ends once the tasks under way have ended.
    run_and_stop_midway(parallel);
    EXPECT_EQ(run(parallel), 0) << log();
    expect_whole();
}

TEST_F(SweepEngines, Snakemake) {
    if (!has_program("snakemake")) GTEST_SKIP() << "Snakemake is not installed";
    const std::string snakemake = "snakemake --cores 4 --keep-going --rerun-incomplete";
    run_and_stop_midway(snakemake);
    EXPECT_EQ(run(snakemake), 0) << log();
    expect_whole();
    // Its own marks are no reason to leave out what has lost its result.
    fs::remove(out("task-0001/result.json"));
    EXPECT_EQ(run(snakemake), 0) << log();
    EXPECT_TRUE(fs::exists(out("task-0001/result.json")));
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
                    .log = folder_.path() / "log"},
                   kEngine_s)
            .exit_code;
    }

    TempFolder folder_;
    bool is_up_ = false;
};

TEST_F(SweepEngines, Slurm) {
    for (const char* program : {"sbatch", "slurmd", "slurmctld", "munged"}) {
        if (!has_program(program)) GTEST_SKIP() << program << " is not installed";
    }
    if (::geteuid() != 0) GTEST_SKIP() << "only root may start a node";
    const OneNodeSlurm slurm;
    if (!slurm.is_up()) GTEST_SKIP() << "no node comes up on this machine: " << slurm.log();
    const auto tell = [&](const std::string& command) {
        return run(slurm.environment() + command);
    };
    const auto is_idle = [&] { return tell("test -z \"$(squeue -h)\"") == 0; };

    // Cancelled midway.
    ASSERT_EQ(tell("sbatch array.sbatch"), 0) << log();
    ASSERT_TRUE(comes_true_in_time([&] { return ended() >= 3; })) << log();
    ASSERT_EQ(tell("scancel --user=root"), 0) << log();
    ASSERT_TRUE(comes_true_in_time(is_idle));
    const std::size_t before = ended();

    // Its node drained midway: what runs there ends, and nothing else begins until it is back.
    const std::string node = "scontrol update nodename=$(hostname -s) state=";
    ASSERT_EQ(tell("sbatch array.sbatch"), 0) << log();
    ASSERT_TRUE(comes_true_in_time([&] { return ended() > before || is_idle(); }));
    ASSERT_EQ(tell(node + "drain reason=test"), 0) << log();
    ASSERT_TRUE(comes_true_in_time([&] { return tell("test -z \"$(squeue -h -t R,CG)\"") == 0; }));
    ASSERT_EQ(tell(node + "resume"), 0) << log();
    ASSERT_TRUE(comes_true_in_time(is_idle));

    // Whatever has failed is repeated by hand.
    const auto is_whole = [&] {
        return run_aphotic(small_.folder(), {"sweep", "out", "--status"}).status == 0;
    };
    for (std::size_t more = 0; more < kFailures && !is_whole(); ++more) {
        ASSERT_EQ(tell("sbatch array.sbatch"), 0) << log();
        ASSERT_TRUE(comes_true_in_time(is_idle));
    }
    expect_whole();
}

}  // namespace
}  // namespace aphotic::sweep_engines_test
