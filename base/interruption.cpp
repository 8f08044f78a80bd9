// SPDX-License-Identifier: BSD-3-Clause
#include "base/interruption.h"

#include <fmt/format.h>
#include <signal.h>
#include <string.h>  // strlen, strsignal
#include <time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <mutex>
#include <utility>

namespace aphotic {
namespace {

constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};

// The handler's data. The handler may touch nothing else.
std::atomic<int> noted_signal = 0;
std::atomic<int> holds = 0;
std::atomic<bool> is_ending = false;
constexpr std::size_t kMostTemporaries = 4096;
std::array<std::atomic<const char*>, kMostTemporaries> temporaries{};
std::array<std::atomic<bool>, kSignals.size()> has_host_handler{};
std::atomic<const char*> last_words = nullptr;
static_assert(std::atomic<int>::is_always_lock_free &&
              std::atomic<const char*>::is_always_lock_free);

std::atomic<bool> is_told = false;  // true while Interrupted propagates

std::mutex uses_mutex;
int uses = 0;  // holds and temporaries
std::array<struct sigaction, kSignals.size()> previous_actions{};

// A thread that registered a file's name may not have created the file yet, and would do so after
// we removed it, so such a file is waited for. An open file without a name vanishes with the
// process.
void remove_temporaries() {
    constexpr int kMostWaits = 50;
    constexpr timespec kWait{.tv_sec = 0, .tv_nsec = 2'000'000};
    for (int wait = 0; wait < kMostWaits; ++wait) {
        bool is_one_to_come = false;
        for (auto& place : temporaries) {
            const char* const file = place;
            if (file == nullptr) continue;
            if (::unlink(file) == 0 || errno != ENOENT) {
                place = nullptr;
            } else {
                is_one_to_come = true;
            }
        }
        if (!is_one_to_come) return;
        ::nanosleep(&kWait, nullptr);
    }
}

// A thread that arrives here while the process ends must neither free the handler's data nor start
// another file.
void wait_if_ending() {
    while (is_ending) ::pause();
}

void say_last_words() {
    const char* const words = last_words;
    if (words == nullptr) return;
    // The process ends whether or not they are written.
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, words, ::strlen(words));
}

extern "C" void on_signal(int signal) {
    const int error = errno;
    bool is_noted = holds > 0;
    for (std::size_t i = 0; i < kSignals.size(); ++i)
        is_noted |= kSignals[i] == signal && has_host_handler[i];
    if (is_noted) {
        noted_signal = signal;
        errno = error;
        return;
    }
    if (is_ending.exchange(true)) return;  // another thread is handling the first of two signals
    remove_temporaries();
    say_last_words();
    end_by_signal(signal);
}

void begin_use() {
    const std::scoped_lock lock(uses_mutex);
    if (uses++ > 0) return;
    struct sigaction ours {};
    ours.sa_handler = on_signal;
    ours.sa_flags = SA_RESTART | SA_NODEFER;  // so that the handler can end us by the signal
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
        ::sigaction(kSignals[i], nullptr, &previous_actions[i]);
        const auto handler = previous_actions[i].sa_handler;
        if (handler == SIG_IGN) continue;
        has_host_handler[i] = handler != SIG_DFL;
        ::sigaction(kSignals[i], &ours, nullptr);
    }
}

// A signal noted for a hold does not wait for other threads' files.
void end_use(bool is_hold) {
    const std::scoped_lock lock(uses_mutex);
    const bool is_last_hold = is_hold && --holds == 0;
    if (--uses == 0) {
        for (std::size_t i = 0; i < kSignals.size(); ++i)
            ::sigaction(kSignals[i], &previous_actions[i], nullptr);
    } else if (!is_last_hold) {
        return;
    }
    const int signal = noted_signal.exchange(0);
    if (signal != 0 && !is_told.exchange(false)) ::raise(signal);
}

}  // namespace

Interrupted::Interrupted(int signal)
    : std::runtime_error(fmt::format("interrupted ({})", ::strsignal(signal))), signal_(signal) {}

InterruptionHold::InterruptionHold() {
    ++holds;
    begin_use();
}

InterruptionHold::~InterruptionHold() {
    end_use(true);
}

RemovedBySignal::RemovedBySignal(const std::filesystem::path& file) : file_(file.string()) {
    begin_use();
    wait_if_ending();
    for (auto& place : temporaries) {
        const char* nothing = nullptr;
        if (!place.compare_exchange_strong(nothing, file_.c_str())) continue;
        place_ = &place;
        return;
    }
}

RemovedBySignal::~RemovedBySignal() {
    if (place_ != nullptr) *place_ = nullptr;
    wait_if_ending();
    end_use(false);
}

LastWords::LastWords(std::string words) : words_(std::move(words)) {
    begin_use();
    wait_if_ending();
    last_words = words_.c_str();
}

LastWords::~LastWords() {
    last_words = nullptr;
    wait_if_ending();
    end_use(false);
}

void throw_if_interrupted() {
    const int signal = noted_signal;
    if (signal == 0) return;
    is_told = true;
    throw Interrupted(signal);
}

void end_by_signal(int signal) {
    // Again, in case another thread starts a use meanwhile and has reinstalled the handler.
    constexpr int kMostTries = 100;
    for (int i = 0; i < kMostTries; ++i) {
        ::signal(signal, SIG_DFL);
        ::raise(signal);
    }
    // Only if the signal is blocked.
    constexpr int kShellsOffset = 128;
    ::_exit(kShellsOffset + signal);
}

}  // namespace aphotic
