// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace master {

/// Standard input of a running session. Each line is a command (verbs.hpp). The end of the input means that
/// the launcher has ended; like SIGTERM it stops the session.
///
/// mpirun passes its standard input to rank 0. The launcher can therefore ask for an orderly end without a signal.
/// After a signal, mpirun would kill all ranks with SIGKILL.
class OperatorInput {
public:
    /// Starts to listen. `readInput` is false for sessions that are started by hand, because their input may be closed.
    explicit OperatorInput(bool readInput);
    ~OperatorInput();
    OperatorInput(const OperatorInput&) = delete;
    OperatorInput& operator=(const OperatorInput&) = delete;

    [[nodiscard]] bool stopAsked() const;
    void stop() { stop_ = true; }
    /// Returns the lines since the last call, without "stop".
    [[nodiscard]] std::vector<std::string> takeLines();

private:
    void listen();
    /// Adds a line to the list. Returns false if the line is "stop", which ends the thread.
    bool keep(std::string line);

    std::atomic<bool> stop_{false};
    std::mutex mutex_;
    std::vector<std::string> lines_;
    int wake_[2] = {-1, -1};  // a pipe that ends the listening thread
    std::thread thread_;
};

}  // namespace master
