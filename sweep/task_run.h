// SPDX-License-Identifier: BSD-3-Clause
//
// One task of a sweep: run, and how it stands. In its folder it leaves
//
//   answer.json   what the command printed, as JSON
//   log           what it said beside that
//   result.json   how it ended
//   running       while it runs: its time is set anew every kSign_s
//
// A task that is done is not run again; any other is, and the command goes on by its own resume.
#pragma once

#include "sweep/sweep.h"

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace aphotic {

struct TaskResult {
    std::string digest{};  // of what it depended on (sweep.h)
    int exit_status = 0;   // as a shell tells it: 128 + the signal
    double seconds = 0.0;
    std::string error{};  // the first line of the command's message; empty: it ended with an answer

    // 1: it ran, and its answer is no.
    [[nodiscard]] bool is_done() const { return exit_status == 0 || exit_status == 1; }
};

enum class TaskState {
    Pending,
    Running,      // its last sign is no older than kSilence_s
    Interrupted,  // it is older: killed, or its machine went down
    Failed,
    Done,
};
inline constexpr std::array kTaskStates{"pending", "running", "interrupted", "failed", "done"};
[[nodiscard]] inline const char* name_of(TaskState state) {
    return kTaskStates.at(static_cast<std::size_t>(state));
}

// Clocks of machines differ less.
inline constexpr double kSign_s = 20.0;
inline constexpr double kSilence_s = 120.0;

struct TaskStanding {
    TaskState state = TaskState::Pending;
    TaskResult result{};  // of the last run that ended, when failed or done
};
[[nodiscard]] TaskStanding standing_of(const Sweep& sweep, std::size_t number);

// Runs it, unless it is done. program: the command aphotic. A RunError where this machine runs it
// already.
TaskStanding run_task(const Sweep& sweep, std::size_t number, const std::filesystem::path& program);

// Of a command over shares: joins those of every rig whose tasks are all done, by the command
// itself, which finds its work done. In DIR, point-0001.json and point-0001.log are what it
// printed. Throws RunError where it fails.
void join_shares_of(const Sweep& sweep,
                    std::span<const TaskStanding> standings,
                    const std::filesystem::path& program);

}  // namespace aphotic
