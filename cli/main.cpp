// SPDX-License-Identifier: BSD-3-Clause
//
// The `aphotic` command: a table of subcommands, and the exit status for each kind of failure.
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/interruption.h"
#include "base/number.h"
#include "base/printable.h"
#include "base/progress.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/help.h"
#include "cli/option_words.h"
#include "cli/rig_file.h"
#include "cli/terminal.h"
#include "cli/unknown_word.h"
#include "report/page.h"

#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <exception>
#include <limits>
#include <memory>
#include <new>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace aphotic::cli;

struct Command {
    const char* name;
    Action (*configure)(CLI::App& app);
};

// In the order of --help.
constexpr std::array kCommands{Command{"init", configure_init},
                               Command{"render", configure_render},
                               Command{"plan", configure_plan},
                               Command{"generate", configure_generate},
                               Command{"integrate", configure_integrate},
                               Command{"trace", configure_trace},
                               Command{"lightmap", configure_lightmap},
                               Command{"design", configure_design},
                               Command{"correct", configure_correct},
                               Command{"observe", configure_observe},
                               Command{"fit", configure_fit},
                               Command{"baseline", configure_baseline},
                               Command{"survey", configure_survey},
                               Command{"validate", configure_validate},
                               Command{"study", configure_study},
                               Command{"compare", configure_compare},
                               Command{"beam", configure_beam},
                               Command{"data", configure_data},
                               Command{"help", configure_help}};

// keeps: the work that remains after a signal.
ExitStatus run(const Action& action, const std::string& keeps) {
    // On a terminal there may be a line of progress.
    const char* const wipe = ::isatty(STDERR_FILENO) == 1 ? "\r\033[K" : "";
    const aphotic::LastWords words(fmt::format("{}aphotic: interrupted; {}\n", wipe, keeps));
    try {
        const ExitStatus status = action();
        flush_said();
        return status;
    } catch (const aphotic::Interrupted& interrupted) {
        warn("interrupted; {}", keeps);
        aphotic::end_by_signal(interrupted.signal());
    } catch (const aphotic::InputError& error) {
        warn_text(error.what());
        return kBadInput;
    } catch (const aphotic::RunError& error) {
        warn_text(error.what());
        return kRunFailed;
    } catch (const std::bad_alloc&) {
        warn("out of memory");
        return kRunFailed;
    } catch (const std::exception& error) {
        // The standard library's own message, with a name of arbitrary characters.
        warn_text(aphotic::shown_text(error.what()));
        return kRunFailed;
    }
}

// The parser's messages about itself, whatever else is on the line.
void add_manual(CLI::App& app, Action& chosen) {
    app.add_flag_callback(
           "--man-page",
           [&app, &chosen] {
               chosen = [&app] {
                   say_text(manual_page(app));
                   return kDone;
               };
               throw CLI::Success();
           },
           "Print the manual page of all commands, as man -l takes it")
        ->trigger_on_parse();
}

void add_completion(CLI::App& app, Action& chosen) {
    app.add_option_function<std::string>(
           "--completion",
           [&app, &chosen](const std::string& shell) {
               chosen = [&app, shell] {
                   say_text(completion_script(app, shell));
                   return kDone;
               };
               throw CLI::Success();
           },
           "Print a script by which bash, zsh or fish completes this command")
        ->check(CLI::IsMember(std::vector<std::string>(kShells.begin(), kShells.end())))
        ->trigger_on_parse();
}

// Options keep their hyphens; their values, and all other words, are quoted for a shell.
std::string typed(std::string_view argument) {
    const std::size_t hyphens = std::min(argument.find_first_not_of('-'), argument.size());
    const std::string_view rest = argument.substr(hyphens);
    return std::string(argument.substr(0, hyphens)) +
           (rest.empty() && hyphens > 0 ? "" : aphotic::shell_word(rest));
}

aphotic::PageOrigin page_origin(int argc, char** argv) {
    constexpr std::size_t kMostCharacters = 2000;  // cuts a list of a thousand images
    std::string command = "aphotic";
    for (int i = 1; i < argc && command.size() < kMostCharacters; ++i)
        command += " " + typed(argv[i]);
    if (command.size() >= kMostCharacters) command += " ...";
    const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
    const std::chrono::year_month_day day(std::chrono::floor<std::chrono::days>(now));
    return {.command = std::move(command),
            .version = APHOTIC_VERSION,
            .date = fmt::format("{:04}-{:02}-{:02}",
                                static_cast<int>(day.year()),
                                static_cast<unsigned>(day.month()),
                                static_cast<unsigned>(day.day()))};
}

// CLI11 counts values; which ones are missing is in the option's own pattern, such as LEAST,MOST.
std::string words_of(const CLI::App& app, const CLI::Error& error) {
    static const std::regex kMismatch("(-[^:]*): At (least|most) [0-9]+ .* received ([0-9]+)");
    std::string words = error.what();
    std::smatch parts;
    if (!std::regex_match(words, parts, kMismatch)) return words;
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    const CLI::App& command = chosen.empty() ? app : *chosen.back();
    const CLI::Option* option = command.get_option_no_throw(parts[1].str());
    if (option == nullptr || option->get_option_text().empty()) return words;
    return fmt::format(
        "{}: found {}; allowed: {}",
        parts[1].str(),
        aphotic::counted(*aphotic::read_number<std::size_t>(parts[3].str()), "value"),
        option->get_option_text());
}

std::string words_of_failure(const CLI::App* app, const CLI::Error& error) {
    std::string unknown = unknown_words(*app);
    if (!unknown.empty()) return unknown;
    return fmt::format("{}\nRun with {} for more information.\n",
                       aphotic::shown_text(words_of(*app, error)),
                       app->get_help_ptr()->get_name());
}

}  // namespace

int main(int argc, char** argv) {
    // A file over the size limit (ulimit -f) should be an error with its name, and the end of
    // POV-Ray must be detected, whatever signal settings we inherited.
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGCHLD, SIG_DFL);
#ifdef __GLIBC__
    // Large buffers are kept for the next piece of work, since allocating them again page by page
    // takes a third of a fit's time.
    mallopt(M_MMAP_THRESHOLD, std::numeric_limits<int>::max());
    mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
    CLI::App app{
        "Simulate what an underwater camera sled sees by its own strobes, and correct its\nimages "
        "for their light.",
        "aphotic"};
    app.set_help_flag("-h,--help", "Print this help and exit");
    app.formatter(std::make_shared<HelpFormatter>());
    app.set_version_flag("--version", "aphotic " APHOTIC_VERSION, "Print the version and exit");
    app.require_subcommand(1);
    app.failure_message(words_of_failure);
    app.footer(
        "Exit status: 0 success; 1 a check failed; 2 wrong command line or input file; 3 "
        "POV-Ray or the file system failed. If interrupted, it exits by the signal.");

    aphotic::set_page_origin(page_origin(argc, argv));
    Action chosen;
    std::string keeps;
    add_completion(app, chosen);
    add_manual(app, chosen);
    for (const auto& [name, configure] : kCommands) {
        CLI::App* sub = app.add_subcommand(name);
        describe(*sub);
        const Action action = configure(*sub);
        add_set_option(*sub);
        add_flag(*sub, "--quiet", aphotic::hush_progress);
        add_common_checks(*sub);
        sub->callback([&chosen, &keeps, action, sub] {
            keeps = what_is_kept(*sub);
            chosen = [action, sub] {
                require_separate_files(*sub);
                for (const auto& place : written_places(*sub)) {
                    aphotic::remove_abandoned_of(place);
                }
                return action();
            };
        });
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (chosen && error.get_exit_code() == 0) return run(chosen, keeps);
        return app.exit(error) == 0 ? kDone : kBadInput;
    }
    return run(chosen, keeps);
}
