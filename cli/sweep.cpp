// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic sweep SWEEP.toml -o DIR: one command over many rigs, as tasks for a cluster or a
// workstation; aphotic sweep DIR --task N | --status | --collect.
#include "sweep/sweep.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/words.h"
#include "base/work_folder.h"
#include "cli/command.h"
#include "cli/options.h"
#include "cli/outcome.h"
#include "cli/terminal.h"
#include "cli/unknown_word.h"
#include "sweep/collection.h"
#include "sweep/task_run.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace aphotic::cli {
namespace {

namespace fs = std::filesystem;

struct SweepCommandOptions {
    fs::path source;  // SWEEP.toml, or DIR
    fs::path folder;
    std::size_t task = 0;
    bool status = false;
    bool collect = false;
    bool json = false;
};

fs::path this_program() {
    return fs::read_symlink("/proc/self/exe");
}

struct WrittenSweep {
    Sweep sweep;
};

nlohmann::ordered_json to_json(const WrittenSweep& written) {
    return {{"folder", written.sweep.folder.string()},
            {"command", written.sweep.file.command},
            {"tasks", written.sweep.tasks()}};
}

void print(const WrittenSweep& written) {
    const auto& [sweep] = written;
    const std::string folder = shell_word(sweep.folder.string());
    say("{} of aphotic {} in {}: run them by one of\n"
        "  parallel -j 4 < {}/tasks.txt\n"
        "  sbatch {}/array.sbatch\n"
        "  snakemake --cores 4 --keep-going -s {}/Snakefile\n"
        "  condor_submit {}/submit.sub\n"
        "then run\n"
        "  aphotic sweep {} --collect\n",
        counted(sweep.tasks(), "task"),
        sweep.file.command,
        sweep.folder.string(),
        folder,
        folder,
        folder,
        folder,
        folder);
}

struct SweepStatus {
    std::vector<TaskStanding> standings;
    std::vector<std::string> files{};  // that were collected

    [[nodiscard]] bool is_whole() const {
        return count_of(standings, TaskState::Done) == standings.size();
    }
};

nlohmann::ordered_json to_json(const SweepStatus& status) {
    nlohmann::ordered_json json{{"tasks", status.standings.size()}};
    for (std::size_t s = 0; s < kTaskStates.size(); ++s)
        json[kTaskStates[s]] = count_of(status.standings, static_cast<TaskState>(s));
    json["not_done"] = numbers_not_done(status.standings);
    json["failures"] = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < status.standings.size(); ++i) {
        const auto& [state, result] = status.standings[i];
        if (state != TaskState::Failed) continue;
        json["failures"].push_back(
            {{"task", i + 1}, {"exit_status", result.exit_status}, {"error", result.error}});
    }
    if (!status.files.empty()) json["files"] = status.files;
    return json;
}

void print(const SweepStatus& status) {
    say("{}:", counted(status.standings.size(), "task"));
    for (std::size_t s = kTaskStates.size(); s-- > 0;)
        say(" {} {}{}",
            count_of(status.standings, static_cast<TaskState>(s)),
            kTaskStates[s],
            s > 0 ? "," : "\n");
    for (std::size_t i = 0; i < status.standings.size(); ++i) {
        const auto& [state, result] = status.standings[i];
        if (state == TaskState::Failed) say("  task {} failed: {}\n", i + 1, result.error);
    }
    if (!status.is_whole()) say("  not done: {}\n", numbers_not_done(status.standings));
    for (const std::string& file : status.files) say("  {}\n", file);
}

// As the command that it ran, but for an answer of no: what was asked of the task is done.
ExitStatus run_one(const SweepCommandOptions& options) {
    const Sweep sweep = read_sweep(options.source);
    if (options.task > sweep.tasks())
        throw InputError("--task: found {}; allowed: 1 to {}", options.task, sweep.tasks());
    const TaskStanding standing = run_task(sweep, options.task, this_program());
    if (standing.result.is_done()) return kDone;
    warn("task {}: {}", options.task, standing.result.error);
    return standing.result.exit_status == kBadInput ? kBadInput : kRunFailed;
}

ExitStatus tell_status(const SweepCommandOptions& options) {
    const Sweep sweep = read_sweep(options.source);
    SweepStatus status{.standings = standings_of(sweep)};
    if (options.collect) {
        const FolderLock lock(sweep.folder, FolderUse::Write);
        remove_abandoned_files(sweep.folder);
        join_shares_of(sweep, status.standings, this_program());
        const auto write = [&](const char* name, const std::string& text) {
            write_text_file(sweep.folder / name, text);
            status.files.push_back((options.source / name).string());
        };
        write("results.csv", results_csv(sweep, status.standings));
        const SweepSheet sheet = sweep_sheet(sweep, status.standings);
        if (sheet.pictures > 0) write("contact_sheet.html", sheet.html);
    }
    show(status, options.json);
    return status.is_whole() ? kDone : kAnswerIsNo;
}

// By the parser of the task's own command, which else would refuse them task by task.
void require_taken(CLI::App& aphotic, const fs::path& sweep, std::vector<std::string> arguments) {
    std::ranges::reverse(arguments);  // as it takes them
    try {
        aphotic.parse(std::move(arguments));
    } catch (const CLI::Success&) {
        throw InputError(
            "{}: arguments: found --help or --version; allowed: options by which tasks "
            "have results",
            sweep.string());
    } catch (const CLI::ParseError& error) {
        std::string unknown = unknown_words(aphotic);
        if (unknown.ends_with('\n')) unknown.pop_back();
        throw InputError(
            "{}: arguments: {}", sweep.string(), unknown.empty() ? error.what() : unknown);
    }
}

ExitStatus sweep_rigs(CLI::App& aphotic, const SweepCommandOptions& options) {
    if (options.task > 0) return run_one(options);
    if (options.status || options.collect) return tell_status(options);
    if (options.folder.empty())
        throw InputError("found none of -o, --task, --status and --collect; allowed: one of them");
    const auto require = [&](const std::vector<std::string>& arguments) {
        require_taken(aphotic, options.source, arguments);
    };
    show(WrittenSweep{write_sweep(options.source, options.folder, this_program(), require)},
         options.json);
    return kDone;
}

Action configure_sweep(CLI::App& app) {
    const auto options = std::make_shared<SweepCommandOptions>();
    app.add_option(
           "SWEEP", options->source, "The sweep's file (TOML), or the folder that was made of it")
        ->required();
    auto* folder = add_output_folder(app, options->folder);
    auto* task = app.add_option("--task", options->task, "Run task N of the folder, unless done")
                     ->check(in_range(1, static_cast<double>(kMostTasks)))
                     ->option_text("N")
                     ->excludes(folder);
    auto* status = app.add_flag("--status", options->status, "Tell how the folder's tasks stand")
                       ->excludes(folder)
                       ->excludes(task);
    app.add_flag("--collect",
                 options->collect,
                 "The same, and write results.csv, and contact_sheet.html of what has previews")
        ->excludes(folder)
        ->excludes(task)
        ->excludes(status);
    add_json(app, options->json);
    app.footer(
        "With -o, writes a task for each rig: tasks.txt, a command a line, and what hands them to "
        "GNU parallel, Slurm, Snakemake and HTCondor. Exit status 1 when --status or --collect "
        "finds a task that is not done.");
    return [options, &app] { return sweep_rigs(*app.get_parent(), *options); };
}

}  // namespace

const Command kSweep{
    "sweep", kSweepCommands, "Make one command many tasks, over rigs or shares", configure_sweep};

}  // namespace aphotic::cli
