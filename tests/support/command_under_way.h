// SPDX-License-Identifier: BSD-3-Clause
//
// The aphotic command while it runs: what tests that interrupt it need to watch and to strike.
#pragma once

#include "base/atomic_file.h"
#include "support/arguments.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

namespace aphotic {

inline constexpr auto kPoll = std::chrono::milliseconds(5);
// Far more than a kernel takes to end a killed process, and a machine to start one.
inline constexpr auto kPatience = std::chrono::seconds(60);

inline bool comes_true(const std::function<bool()>& condition) {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (!condition()) {
        if (std::chrono::steady_clock::now() > deadline) return false;
        std::this_thread::sleep_for(kPoll);
    }
    return true;
}

// The processes that work in a folder or below it.
inline std::vector<pid_t> processes_in(const std::filesystem::path& folder) {
    std::vector<pid_t> pids;
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator("/proc", ignored)) {
        const std::string name = entry.path().filename().string();
        if (name.find_first_not_of("0123456789") != std::string::npos) continue;
        const std::string works_in =
            std::filesystem::read_symlink(entry.path() / "cwd", ignored).string();
        if (!ignored && (works_in + "/").starts_with(folder.string() + "/"))
            pids.push_back(std::stoi(name));
    }
    return pids;
}

inline void expect_no_process_in(const std::filesystem::path& folder) {
    EXPECT_TRUE(comes_true([&] { return processes_in(folder).empty(); }))
        << processes_in(folder).size() << " processes outlive the command";
    for (const pid_t pid : processes_in(folder)) ::kill(pid, SIGKILL);
}

// Nothing half written: at all, or by the process of that number.
inline void expect_no_leftovers(const std::filesystem::path& folder, const std::string& by = "") {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        EXPECT_EQ(name.find(by + ".part"), std::string::npos) << entry.path();
    }
}

// A command under way, its streams in files beside its folder.
class Command {
  public:
    Command(const std::filesystem::path& lane,
            const Arguments& arguments,
            const std::map<std::string, std::string>& environment) {
        std::vector<std::string> words{"/usr/bin/env", "--chdir=" + lane.string()};
        for (const auto& [name, value] : environment) words.push_back(name + "=" + value);
        words.emplace_back(APHOTIC_COMMAND);
        words.insert(words.end(), arguments.begin(), arguments.end());
        std::vector<char*> argv;
        for (std::string& word : words) argv.push_back(word.data());
        argv.push_back(nullptr);
        posix_spawn_file_actions_t files;
        posix_spawn_file_actions_init(&files);
        constexpr int kMode = 0600;
        const auto to = [&](int descriptor, const char* name) {
            posix_spawn_file_actions_addopen(
                &files, descriptor, (lane / name).c_str(), O_WRONLY | O_CREAT | O_TRUNC, kMode);
        };
        to(STDOUT_FILENO, "stdout");
        to(STDERR_FILENO, "stderr");
        if (::posix_spawn(&pid_, argv[0], &files, nullptr, argv.data(), environ) != 0)
            throw std::runtime_error("the command does not start");
        posix_spawn_file_actions_destroy(&files);
    }

    [[nodiscard]] pid_t pid() const { return pid_; }
    [[nodiscard]] bool has_ended() {
        if (!status_) {
            int status = 0;
            if (::waitpid(pid_, &status, WNOHANG) == pid_) status_ = status;
        }
        return status_.has_value();
    }
    // As a shell tells it.
    int wait(std::chrono::seconds patience = kPatience) {
        const auto deadline = std::chrono::steady_clock::now() + patience;
        while (!has_ended()) {
            if (std::chrono::steady_clock::now() > deadline)
                throw std::runtime_error("the command does not end");
            std::this_thread::sleep_for(kPoll);
        }
        return WIFSIGNALED(*status_) ? 128 + WTERMSIG(*status_) : WEXITSTATUS(*status_);
    }

  private:
    pid_t pid_ = -1;
    std::optional<int> status_;
};

// Of what is struck, and when.
inline unsigned seed_of_this_run() {
    const char* given = std::getenv("APHOTIC_TEST_SEED");
    return given != nullptr ? static_cast<unsigned>(std::stoul(given)) : 20260101U;
}

}  // namespace aphotic
