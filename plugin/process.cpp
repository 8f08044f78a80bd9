// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/process.h"

#include "spectral/error.h"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <boost/process.hpp>
#include <boost/process/extend.hpp>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <thread>
#include <utility>

namespace aphotic {

namespace bp = boost::process;

namespace {

constexpr auto kPollInterval = std::chrono::milliseconds(10);

// POV-Ray must not outlive us, however we end: the kernel sends it SIGKILL.
struct DieWithParent : bp::extend::handler {
    template <typename Executor>
    void on_exec_setup(Executor&) const {
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    }
};

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
    bp::child child;
};

Process::Process(const ProcessRequest& request) : child_(std::make_unique<Child>()) {
    // Boost goes on in our own folder if it cannot change into this one, starts the program though
    // its log cannot be opened, and writes over the beginning of an older one.
    if (!std::filesystem::is_directory(request.folder)) {
        throw RunError(fmt::format("{}: cannot be started: {} is no folder",
                                   request.executable.string(),
                                   request.folder.string()));
    }
    if (!std::ofstream(request.log)) {
        throw RunError(
            fmt::format("{}: cannot be written: {}", request.log.string(), std::strerror(errno)));
    }
    std::error_code error;
    child_->child =
        bp::child(bp::exe = request.executable.string(),
                  bp::args = request.arguments,
                  bp::start_dir = request.folder.string(),
                  environment_of(request),
                  bp::std_in<bp::null, (bp::std_out & bp::std_err)> request.log.string(),
                  DieWithParent{},
                  error);
    if (error) {
        throw RunError(
            fmt::format("{}: cannot be started: {}", request.executable.string(), error.message()));
    }
}

Process::Process(Process&&) noexcept = default;
Process& Process::operator=(Process&&) noexcept = default;

Process::~Process() {
    if (child_ == nullptr) return;
    std::error_code ignored;
    if (!child_->child.running(ignored)) return;
    const pid_t pid = child_->child.id();
    child_->child.terminate(ignored);
    ::waitpid(pid, nullptr, 0);  // terminate() does not wait: it could still write, or be a zombie
}

std::optional<ProcessEnd> Process::poll() {
    std::error_code error;
    if (child_->child.running(error)) return std::nullopt;
    const int status = child_->child.native_exit_code();
    if (WIFSIGNALED(status)) return ProcessEnd{.exit_code = 0, .signal = WTERMSIG(status)};
    return ProcessEnd{.exit_code = WEXITSTATUS(status), .signal = 0};
}

ProcessEnd run_process(const ProcessRequest& request, double timeout_s) {
    const auto deadline =
        std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s);
    Process process(request);
    while (true) {
        if (const auto end = process.poll()) return *end;
        if (std::chrono::steady_clock::now() > deadline) {
            throw RunError(fmt::format(
                "{}: gave no answer within {} s", request.executable.string(), timeout_s));
        }
        std::this_thread::sleep_for(kPollInterval);
    }
}

}  // namespace aphotic
