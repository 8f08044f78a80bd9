// SPDX-License-Identifier: BSD-3-Clause
//
// What the tasks of a sweep have made, together:
//
//   DIR/results.csv          a line for each task: its number, the rig's keys, how it stands, its
//                            time, every number and short text of what the command answered, and
//                            the first line of the message of one that failed
//   DIR/contact_sheet.html   the previews of those that made one, small
#pragma once

#include "sweep/task_run.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace aphotic {

// By task.
[[nodiscard]] std::vector<TaskStanding> standings_of(const Sweep& sweep);
[[nodiscard]] std::size_t count_of(std::span<const TaskStanding> standings, TaskState state);

// As arrays of Slurm's have them: "1-3,7"; empty where all are done.
[[nodiscard]] std::string numbers_not_done(std::span<const TaskStanding> standings);

// An answer's members as columns: those of an object behind a dot, as in promise.R.error, and up to
// three numbers of an array by their place from 0. Longer arrays and texts are left out.
[[nodiscard]] std::string results_csv(const Sweep& sweep, std::span<const TaskStanding> standings);

inline constexpr std::size_t kMostOnSweepSheet = 240;  // spread evenly over more

struct SweepSheet {
    std::string html{};
    std::size_t pictures = 0;
};
[[nodiscard]] SweepSheet sweep_sheet(const Sweep& sweep, std::span<const TaskStanding> standings);

}  // namespace aphotic
