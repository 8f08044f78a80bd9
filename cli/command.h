// SPDX-License-Identifier: BSD-3-Clause
//
// The subcommands of `aphotic`, one small file each, which ends with its function of this list.
// Dispatch and help come from the table in cli/main.cpp, which names them.
#pragma once

#include <CLI/CLI.hpp>

#include <functional>

namespace aphotic::cli {

enum ExitStatus : int {
    kDone = 0,        // the command succeeded
    kAnswerIsNo = 1,  // it ran, with a negative result: validation out of bounds
    kBadInput = 2,    // the command line or an input file is wrong
    kRunFailed = 3,   // POV-Ray or the file system failed
};

// The action of a subcommand after its options are parsed. Throws InputError or RunError.
using Action = std::function<ExitStatus()>;

// Each adds its options to the subcommand's parser and returns the action that reads them.
Action configure_init(CLI::App& app);
Action configure_render(CLI::App& app);
Action configure_plan(CLI::App& app);
Action configure_generate(CLI::App& app);
Action configure_integrate(CLI::App& app);
Action configure_trace(CLI::App& app);
Action configure_lightmap(CLI::App& app);
Action configure_design(CLI::App& app);
Action configure_correct(CLI::App& app);
Action configure_observe(CLI::App& app);
Action configure_fit(CLI::App& app);
Action configure_baseline(CLI::App& app);
Action configure_survey(CLI::App& app);
Action configure_validate(CLI::App& app);
Action configure_study(CLI::App& app);
Action configure_compare(CLI::App& app);
Action configure_beam(CLI::App& app);
Action configure_data(CLI::App& app);
Action configure_help(CLI::App& app);

}  // namespace aphotic::cli
