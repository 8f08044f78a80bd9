// SPDX-License-Identifier: BSD-3-Clause
//
// The `aphotic` command: a table of subcommands, and what each kind of failure exits with.
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/printable.h"
#include "cli/command.h"
#include "cli/option_checks.h"
#include "plugin/interruption.h"

#include <fmt/format.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string_view>

namespace {

using aphotic::cli::Action;
using aphotic::cli::Command;
using aphotic::cli::ExitStatus;

constexpr std::array kCommands{
    Command{"render",
            "plan, write the scenes, run POV-Ray, integrate: rig to image",
            aphotic::cli::configure_render},
    Command{"plan",
            "which wavelengths and frames a render would take, and the error it promises",
            aphotic::cli::configure_plan},
    Command{"generate", "write the POV-Ray scenes alone", aphotic::cli::configure_generate},
    Command{"integrate", "frames and manifest to images", aphotic::cli::configure_integrate},
    Command{"trace",
            "the same images by the reference tracer, without POV-Ray",
            aphotic::cli::configure_trace},
    Command{"lightmap",
            "the camera's signal on a bare flat floor, at the camera's pace",
            aphotic::cli::configure_lightmap},
    Command{"atlas",
            "lightmaps over altitude, attitude and water, and how far it is between them",
            aphotic::cli::configure_atlas},
    Command{"validate",
            "render, trace, and compare them within stated bounds",
            aphotic::cli::configure_validate},
    Command{"study",
            "measure the trade of accuracy for time on this machine",
            aphotic::cli::configure_study},
    Command{"stress",
            "hold both renderers at extremes against a long-double answer",
            aphotic::cli::configure_stress},
    Command{"correct",
            "survey images divided by the light that they were taken in",
            aphotic::cli::configure_correct},
    Command{"observe",
            "average the images of one altitude into their pattern of light",
            aphotic::cli::configure_observe},
    Command{"baseline",
            "correct images as one does without a model of the lamps",
            aphotic::cli::configure_baseline},
    Command{"compare", "how far one image is from another", aphotic::cli::configure_compare},
    Command{"data", "the built-in tables: list, show, plot, source", aphotic::cli::configure_data},
};

// A message quotes what it found: nothing in it may steer the terminal.
void say(std::string_view message) {
    fmt::print(stderr, "aphotic: {}\n", aphotic::printable(message, "\n\t"));
}

ExitStatus run(const Action& action) {
    try {
        const ExitStatus status = action();
        // What was said must have arrived: a full disk behind a redirection is a failure.
        if (std::fflush(stdout) != 0)
            throw aphotic::RunError("standard output: cannot be written to");
        return status;
    } catch (const aphotic::Interrupted& interrupted) {
        fmt::print(stderr,
                   "aphotic: {}; what was done is kept, and the same command goes on from there\n",
                   interrupted.what());
        aphotic::end_by_signal(interrupted.signal());
    } catch (const aphotic::InputError& error) {
        say(error.what());
        return aphotic::cli::kBadInput;
    } catch (const aphotic::RunError& error) {
        say(error.what());
        return aphotic::cli::kRunFailed;
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "aphotic: there is not enough memory for this\n");
        return aphotic::cli::kRunFailed;
    } catch (const std::exception& error) {
        // The file system's own words, mostly.
        say(error.what());
        return aphotic::cli::kRunFailed;
    }
}

}  // namespace

int main(int argc, char** argv) {
    // A file over the limit of its size (ulimit -f) is to be an error with its name, and the end of
    // POV-Ray is to be seen, whoever started us.
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGCHLD, SIG_DFL);
    CLI::App app{"What an underwater camera sled sees by the light of its own strobes."};
    app.set_version_flag("--version", "aphotic " APHOTIC_VERSION);
    app.require_subcommand(1);
    app.footer(
        "Exit status: 0 done; 1 it ran and the answer is no; 2 the command line or an input\n"
        "file is wrong; 3 POV-Ray or the file system failed. Interrupted, it ends by the signal.");

    Action chosen;
    for (const Command& command : kCommands) {
        CLI::App* sub = app.add_subcommand(command.name, command.summary);
        const Action action = command.configure(*sub);
        aphotic::cli::add_common_checks(*sub);
        sub->callback([&chosen, action, sub] {
            chosen = [action, sub] {
                aphotic::cli::require_separate_files(*sub);
                for (const auto& place : aphotic::cli::written_places(*sub)) {
                    aphotic::remove_abandoned_of(place);
                }
                return action();
            };
        });
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? aphotic::cli::kDone : aphotic::cli::kBadInput;
    }
    return run(chosen);
}
