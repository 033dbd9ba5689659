// SPDX-License-Identifier: GPL-3.0-or-later
#include "interruption.h"

#include <pthread.h>
#include <unistd.h>

#include <chrono>
#include <csignal>

namespace vmap {
namespace {

/// Work that has not noticed by then is ended; the promise is a quarter of a second in all.
constexpr std::chrono::milliseconds patience{100};

constexpr int wake_up = SIGUSR2;  ///< tells the waiting thread that the program is done

sigset_t awaited_signals() {
    sigset_t set;
    sigemptyset(&set);
    for (const int signal : {SIGINT, SIGTERM, wake_up}) sigaddset(&set, signal);
    return set;
}

}  // namespace

Interruption::Interruption() {
    const sigset_t set = awaited_signals();
    pthread_sigmask(SIG_BLOCK, &set, nullptr);  // threads inherit it: only the waiting thread sees the signals
    waiter_ = std::thread([this] { wait_for_signals(); });
}

Interruption::~Interruption() {
    done_ = true;
    pthread_kill(waiter_.native_handle(), wake_up);
    waiter_.join();
}

void Interruption::check() const {
    if (const int signal = signal_; signal != 0) throw Interrupted(signal);
}

std::unique_lock<std::mutex> Interruption::hold_off() {
    return std::unique_lock(holding_);
}

void Interruption::wait_for_signals() {
    const sigset_t set = awaited_signals();
    int signal = 0;
    while (!done_) {
        if (sigwait(&set, &signal) != 0 || signal == wake_up) continue;
        signal_ = signal;
        for (auto waited = std::chrono::milliseconds{0}; waited < patience && !done_;
             waited += std::chrono::milliseconds{5})
            std::this_thread::sleep_for(std::chrono::milliseconds{5});
        if (done_) return;
        const std::lock_guard lock(holding_);
        if (!done_) ::_exit(128 + signal);
    }
}

}  // namespace vmap
