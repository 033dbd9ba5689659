// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What Ctrl-C and a termination request do: the work is left at the next report of progress, so that everything is
/// cleaned up; work that does not report within a moment is ended where it stands. Either way no output appears.
#pragma once

#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

namespace vmap {

/// Thrown by Interruption::check; the program ends with 128 + signal.
class Interrupted : public std::exception {
public:
    explicit Interrupted(int signal) : signal_(signal) {}
    [[nodiscard]] const char* what() const noexcept override { return "interrupted"; }
    [[nodiscard]] int signal() const { return signal_; }

private:
    int signal_;
};

/// Takes SIGINT and SIGTERM over for the whole process while it lives. Make it before any thread is started.
class Interruption {
public:
    Interruption();
    ~Interruption();
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;

    /// Throws Interrupted once a signal has come.
    void check() const;

    /// While the lock is held the process is not ended: finished files are put under their names all together.
    [[nodiscard]] std::unique_lock<std::mutex> hold_off();

private:
    void wait_for_signals();

    std::atomic<int> signal_{0};
    std::atomic<bool> done_{false};
    std::mutex holding_;
    std::thread waiter_;
};

}  // namespace vmap
