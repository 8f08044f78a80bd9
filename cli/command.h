// SPDX-License-Identifier: BSD-3-Clause
//
// The subcommands of `aphotic`, one small file each, which ends with its entry of the table in
// cli/main.cpp. Dispatch and help come from that table.
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

struct Command {
    const char* name;
    // Adds the options to the subcommand's parser and returns the action that reads them.
    Action (*configure)(CLI::App& options);
};

extern const Command kInit;
extern const Command kRender;
extern const Command kPlan;
extern const Command kGenerate;
extern const Command kIntegrate;
extern const Command kTrace;
extern const Command kLightmap;
extern const Command kDesign;
extern const Command kCorrect;
extern const Command kObserve;
extern const Command kFit;
extern const Command kBaseline;
extern const Command kSurvey;
extern const Command kValidate;
extern const Command kStudy;
extern const Command kCompare;
extern const Command kBeam;
extern const Command kData;
extern const Command kHelp;

}  // namespace aphotic::cli
