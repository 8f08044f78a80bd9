// SPDX-License-Identifier: BSD-3-Clause
#include "base/interruption.h"

#include <fmt/format.h>
#include <signal.h>
#include <string.h>  // strsignal
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <mutex>

namespace aphotic {
namespace {

constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};

std::atomic<int> noted_signal = 0;
static_assert(std::atomic<int>::is_always_lock_free, "a signal's handler may touch nothing else");
std::atomic<bool> is_told = false;  // Interrupted is on its way up

std::mutex holds_mutex;
int holds = 0;
std::array<struct sigaction, kSignals.size()> previous_actions{};

extern "C" void note_signal(int signal) {
    noted_signal = signal;
}

void start_noting() {
    struct sigaction noting {};
    noting.sa_handler = note_signal;
    noting.sa_flags = SA_RESTART;
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
        ::sigaction(kSignals[i], nullptr, &previous_actions[i]);
        if (previous_actions[i].sa_handler != SIG_IGN) ::sigaction(kSignals[i], &noting, nullptr);
    }
}

void stop_noting() {
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
        ::sigaction(kSignals[i], &previous_actions[i], nullptr);
    }
    const int signal = noted_signal.exchange(0);
    if (signal != 0 && !is_told.exchange(false)) ::raise(signal);
}

}  // namespace

Interrupted::Interrupted(int signal)
    : std::runtime_error(fmt::format("interrupted ({})", ::strsignal(signal))), signal_(signal) {}

InterruptionHold::InterruptionHold() {
    const std::scoped_lock lock(holds_mutex);
    if (holds++ == 0) start_noting();
}

InterruptionHold::~InterruptionHold() {
    const std::scoped_lock lock(holds_mutex);
    if (--holds == 0) stop_noting();
}

void throw_if_interrupted() {
    const int signal = noted_signal;
    if (signal == 0) return;
    is_told = true;
    throw Interrupted(signal);
}

void end_by_signal(int signal) {
    ::signal(signal, SIG_DFL);
    ::raise(signal);
    // Only where the signal is blocked.
    constexpr int kShellsOffset = 128;
    ::_exit(kShellsOffset + signal);
}

}  // namespace aphotic
