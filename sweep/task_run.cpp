// SPDX-License-Identifier: BSD-3-Clause
#include "sweep/task_run.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/interruption.h"
#include "base/json_text.h"
#include "base/work_folder.h"
#include "plugin/process.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <limits>
#include <optional>
#include <sstream>
#include <system_error>
#include <thread>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

constexpr const char* kAnswer = "answer.json";
constexpr const char* kLog = "log";
constexpr const char* kResult = "result.json";
constexpr const char* kRunning = "running";

// Gone with whoever runs the task, unless that is killed.
class RunningSign {
  public:
    explicit RunningSign(fs::path file) : file_(std::move(file)) { write_text_file(file_, ""); }
    ~RunningSign() {
        std::error_code ignored;
        fs::remove(file_, ignored);
    }
    RunningSign(const RunningSign&) = delete;
    RunningSign& operator=(const RunningSign&) = delete;

    void renew() {
        const auto now = std::chrono::steady_clock::now();
        if (std::chrono::duration<double>(now - last_).count() < kSign_s) return;
        last_ = now;
        std::error_code ignored;
        fs::last_write_time(file_, fs::file_time_type::clock::now(), ignored);
    }

  private:
    fs::path file_;
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

std::optional<TaskResult> result_in(const fs::path& folder) {
    const fs::path file = folder / kResult;
    if (!fs::exists(file)) return std::nullopt;
    const nlohmann::json json = parse_json(read_text_file(file), file.string());
    try {
        return TaskResult{.digest = json.at("digest").get<std::string>(),
                          .exit_status = json.at("exit_status").get<int>(),
                          .seconds = json.at("seconds").get<double>(),
                          .error = json.at("error").get<std::string>()};
    } catch (const nlohmann::json::exception& error) {
        throw InputError("{}: is not ours: {}", file.string(), error.what());
    }
}

void write_result(const fs::path& folder, const TaskResult& result) {
    write_text_file(folder / kResult,
                    json_text({{"digest", result.digest},
                               {"exit_status", result.exit_status},
                               {"seconds", result.seconds},
                               {"error", result.error}}));
}

// Warnings come before it, which are no reason.
std::string message_in(const std::string& log) {
    constexpr std::string_view kOurs = "aphotic: ";
    std::string first;
    std::istringstream lines(log);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with(kOurs)) return line.substr(kOurs.size());
        if (first.empty()) first = line;
    }
    return first;
}

TaskResult result_of(const ProcessEnd& end, const fs::path& log) {
    constexpr int kBySignal = 128;
    TaskResult result{.exit_status = end.signal != 0 ? kBySignal + end.signal : end.exit_code};
    if (result.is_done()) return result;
    result.error = message_in(read_text_file(log));
    if (result.error.empty()) result.error = end.words();
    return result;
}

ProcessEnd run_command(const Sweep& sweep, std::size_t number, const fs::path& program) {
    const fs::path folder = task_folder(sweep, number);
    RunningSign sign(folder / kRunning);
    const InterruptionHold hold;
    Process process({.executable = program,
                     .arguments = arguments_of(sweep, number),
                     .folder = sweep.home,
                     .log = folder / kLog,
                     .output = folder / kAnswer});
    while (true) {
        if (const auto end = process.poll()) return *end;
        throw_if_interrupted();
        sign.renew();
        std::this_thread::sleep_for(kPollInterval);
    }
}

}  // namespace

TaskStanding standing_of(const Sweep& sweep, std::size_t number) {
    const fs::path folder = task_folder(sweep, number);
    std::error_code is_not_running;
    const auto sign = fs::last_write_time(folder / kRunning, is_not_running);
    if (!is_not_running) {
        const std::chrono::duration<double> age = fs::file_time_type::clock::now() - sign;
        return {.state = age.count() <= kSilence_s ? TaskState::Running : TaskState::Interrupted};
    }
    const auto result = result_in(folder);
    if (!result || result->digest != sweep.digests[number - 1]) return {};
    return {.state = result->is_done() ? TaskState::Done : TaskState::Failed, .result = *result};
}

void join_shares_of(const Sweep& sweep,
                    std::span<const TaskStanding> standings,
                    const fs::path& program) {
    const auto shares = static_cast<std::size_t>(sweep.file.shares);
    for (std::size_t first = 0; shares > 1 && first < standings.size(); first += shares) {
        const fs::path folder = results_folder(sweep, first + 1);
        const bool is_done = std::ranges::all_of(
            standings.subspan(first, shares),
            [](const TaskStanding& standing) { return standing.state == TaskState::Done; });
        if (!is_done || share_folders(folder).empty()) continue;
        const fs::path log = folder.string() + ".log";
        const ProcessEnd end = run_process({.executable = program,
                                            .arguments = joining_arguments(sweep, first + 1),
                                            .folder = sweep.home,
                                            .log = log,
                                            .output = folder.string() + ".json"},
                                           std::numeric_limits<double>::infinity());
        const TaskResult result = result_of(end, log);
        if (!result.is_done())
            throw RunError("{}: its shares cannot be joined: {}", folder.string(), result.error);
    }
}

TaskStanding run_task(const Sweep& sweep, std::size_t number, const fs::path& program) {
    const fs::path folder = task_folder(sweep, number);
    const FolderLock lock(folder, FolderUse::Write);
    remove_abandoned_files(folder);
    // Whatever sign stands there is of a run that was killed, or another machine's, whose results
    // are the same.
    TaskStanding standing = standing_of(sweep, number);
    if (standing.state == TaskState::Done) return standing;
    make_folder(results_folder(sweep, number));
    const auto start = std::chrono::steady_clock::now();
    TaskResult result = result_of(run_command(sweep, number, program), folder / kLog);
    result.digest = sweep.digests[number - 1];
    result.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    write_result(folder, result);
    return standing_of(sweep, number);
}

}  // namespace aphotic
