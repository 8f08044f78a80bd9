// SPDX-License-Identifier: BSD-3-Clause
//
// The subcommands of `aphotic`, one small file each, listed in one table (cli/main.cpp) from
// which both the dispatch and the help come.
#pragma once

#include <CLI/CLI.hpp>

#include <functional>

namespace aphotic::cli {

enum ExitStatus : int {
    kDone = 0,        // it did what was asked
    kAnswerIsNo = 1,  // it ran, and the answer is no: validation out of bounds
    kBadInput = 2,    // the command line or an input file is wrong
    kRunFailed = 3,   // POV-Ray or the file system failed
};

// What a subcommand does once its options are parsed. Throws InputError or RunError.
using Action = std::function<ExitStatus()>;

struct Command {
    const char* name;
    const char* summary;
    // Adds the options to the subcommand's parser and returns the action that reads them.
    Action (*configure)(CLI::App& options);
};

Action configure_baseline(CLI::App& options);
Action configure_compare(CLI::App& options);
Action configure_correct(CLI::App& options);
Action configure_data(CLI::App& options);
Action configure_generate(CLI::App& options);
Action configure_integrate(CLI::App& options);
Action configure_observe(CLI::App& options);
Action configure_plan(CLI::App& options);
Action configure_render(CLI::App& options);
Action configure_stress(CLI::App& options);
Action configure_study(CLI::App& options);
Action configure_trace(CLI::App& options);
Action configure_validate(CLI::App& options);

}  // namespace aphotic::cli
