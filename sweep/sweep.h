// SPDX-License-Identifier: BSD-3-Clause
//
// A sweep's folder: one command for each point of a sweep (sweep_file.h), to be run in any order,
// on any machine that sees the folder, by whatever engine starts the lines of tasks.txt.
//
//   DIR/sweep.toml               the sweep's file
//   DIR/sweep.json               what each task depends on, as digests
//   DIR/tasks.txt                a line for each task: aphotic sweep DIR --task N
//   DIR/run-task, array.sbatch, Snakefile, submit.sub
//                                what starts them (wrappers/)
//   DIR/task-0001/rig.toml       the task's rig, with its tables
//   DIR/task-0001/out/           what the command made
//   DIR/task-0001/answer.json, log, result.json
//                                what it printed, and how it ended (task_run.h)
//   DIR/point-0001/              of a command over shares: what all shares of one rig make, each in
//                                a folder of its own until they are joined
//
// A task writes to its own folder and to no other, whatever the others do: nothing is locked
// between machines.
#pragma once

#include "sweep/sweep_file.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace aphotic {

struct Sweep {
    SweepFile file;
    std::filesystem::path home;     // where its file was, and relative paths start; absolute
    std::filesystem::path folder;   // absolute
    std::filesystem::path scene{};  // of the user's own, which the rig names; none: none
    std::vector<SweepPoint> points;
    std::vector<std::string> digests;  // by task: of all that its results depend on

    [[nodiscard]] std::size_t tasks() const { return digests.size(); }
};

// Counted from 0, as the shares of its point.
struct SweepTask {
    std::size_t point = 0;
    int share = 0;
};
// number: from 1.
[[nodiscard]] SweepTask task_of(const Sweep& sweep, std::size_t number);

[[nodiscard]] std::filesystem::path task_folder(const Sweep& sweep, std::size_t number);
// Where its command writes to.
[[nodiscard]] std::filesystem::path results_folder(const Sweep& sweep, std::size_t number);
// Of the command aphotic.
[[nodiscard]] std::vector<std::string> arguments_of(const Sweep& sweep, std::size_t number);

// Of the command that joins the shares of the task's point.
[[nodiscard]] std::vector<std::string> joining_arguments(const Sweep& sweep, std::size_t number);

// Every rig is read, and require_taken called with a task's arguments, which those of the others
// are like, before anything is written. Tasks of an earlier sweep in the folder keep their results
// where these depend on nothing else. program: what the lines of tasks.txt start.
Sweep write_sweep(
    const std::filesystem::path& file,
    const std::filesystem::path& folder,
    const std::filesystem::path& program,
    const std::function<void(const std::vector<std::string>& arguments)>& require_taken =
        [](const auto&) {});

// Throws InputError where the folder holds no sweep, or one that was edited by hand.
[[nodiscard]] Sweep read_sweep(const std::filesystem::path& folder);

}  // namespace aphotic
