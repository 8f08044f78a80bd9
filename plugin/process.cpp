// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/process.h"

#include "base/error.h"
#include "base/interruption.h"
#include "plugin/life_signs.h"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <boost/process.hpp>
#include <boost/process/extend.hpp>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <thread>
#include <utility>

namespace aphotic {

namespace bp = boost::process;

namespace {

// POV-Ray must not outlive us, however we end, so the kernel sends it SIGKILL. It has its own
// process group, so that its children can be stopped with it.
struct DieWithParent : bp::extend::handler {
    template <typename Executor>
    void on_exec_setup(Executor&) const {
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        ::setpgid(0, 0);
    }
};

void require_writable(const std::filesystem::path& file) {
    if (std::ofstream(file)) return;
    throw RunError("{}: cannot be written: {}", file.string(), std::strerror(errno));
}

bp::environment environment_of(const ProcessRequest& request) {
    bp::environment environment = boost::this_process::environment();
    for (const auto& [name, value] : request.environment) {
        if (value.empty()) {
            environment.reset(name);
        } else {
            environment.set(name, value);  // environment[name] reads past shorter variables
        }
    }
    return environment;
}

}  // namespace

std::string ProcessEnd::words() const {
    return signal != 0 ? fmt::format("killed by signal {}", signal)
                       : fmt::format("exit status {}", exit_code);
}

struct Process::Child {
    Child(pid_t leader, ProcessRequest what)
        : pid(leader), request(std::move(what)), life_signs(pid, request.stall_s) {}

    InterruptionHold hold;
    pid_t pid;  // also its group's number
    ProcessRequest request;
    LifeSigns life_signs;
    std::optional<ProcessEnd> end;

    // Once it has ended, its number is reused only after we wait for it: so processes that it left
    // running are stopped first, while the group's number is certainly its own.
    void take_end() {
        ::kill(-pid, SIGKILL);
        int status = 0;
        ::waitpid(pid, &status, 0);
        end = WIFSIGNALED(status) ? ProcessEnd{.exit_code = 0, .signal = WTERMSIG(status)}
                                  : ProcessEnd{.exit_code = WEXITSTATUS(status), .signal = 0};
    }

    void require_limits() {
        std::error_code ignored;
        const std::uintmax_t written = std::filesystem::file_size(request.log, ignored);
        if (!ignored && written > kMostLogBytes) {
            stop("was stopped: it printed more than {} MiB", kMostLogBytes >> 20U);
        }
        if (life_signs.are_gone(written)) {
            stop("was stopped: for {} s it neither printed anything nor used the processor",
                 request.stall_s);
        }
    }

    template <typename Number>
    [[noreturn]] void stop(fmt::format_string<Number> words, Number number) {
        take_end();
        throw RunError("{} {}\nIts log: {}",
                       request.executable.string(),
                       fmt::format(words, std::move(number)),
                       request.log.string());
    }
};

Process::Process(const ProcessRequest& request) {
    const InterruptionHold hold;
    // Boost continues in our own folder if it cannot change into this one, starts the program even
    // if its log cannot be opened, and overwrites the beginning of an older log.
    if (!std::filesystem::is_directory(request.folder)) {
        throw RunError("{}: cannot be started: {} is not a folder",
                       request.executable.string(),
                       request.folder.string());
    }
    require_writable(request.log);
    std::error_code error;
    bp::child child(bp::exe = request.executable.string(),
                    bp::args = request.arguments,
                    bp::start_dir = request.folder.string(),
                    environment_of(request),
                    bp::std_in<bp::null, (bp::std_out & bp::std_err)> request.log.string(),
                    DieWithParent{},
                    error);
    if (error) {
        throw RunError("{}: cannot be started: {}", request.executable.string(), error.message());
    }
    const pid_t pid = child.id();
    child.detach();  // to be waited for by us, not by Boost
    child_ = std::make_unique<Child>(pid, request);
}

Process::Process(Process&&) noexcept = default;
Process& Process::operator=(Process&&) noexcept = default;

Process::~Process() {
    if (child_ != nullptr && !child_->end) child_->take_end();
}

std::optional<ProcessEnd> Process::poll() {
    if (child_->end) return child_->end;
    siginfo_t info{};
    const auto id = static_cast<id_t>(child_->pid);
    if (::waitid(P_PID, id, &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == 0) {
        child_->require_limits();
        return std::nullopt;
    }
    child_->take_end();
    return child_->end;
}

ProcessEnd run_process(const ProcessRequest& request, double timeout_s) {
    const auto deadline =
        std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s);
    Process process(request);
    while (true) {
        throw_if_interrupted();
        if (const auto end = process.poll()) return *end;
        if (std::chrono::steady_clock::now() > deadline) {
            throw RunError(
                "{}: did not answer within {} s", request.executable.string(), timeout_s);
        }
        std::this_thread::sleep_for(kPollInterval);
    }
}

}  // namespace aphotic
