// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace master {

/// What somebody types into a running session: commands (operator_command.hpp), a line each on standard input; its end
/// (the launcher is gone) or SIGTERM mean stop.
///
/// mpirun hands its standard input to rank 0, so that the launcher can ask for an orderly end and need not send
/// signals, which mpirun follows up with SIGKILL.
class OperatorInput {
public:
    /// Starts listening. `readInput` is off for sessions started by hand, where input may be closed.
    explicit OperatorInput(bool readInput);
    ~OperatorInput();
    OperatorInput(const OperatorInput&) = delete;
    OperatorInput& operator=(const OperatorInput&) = delete;

    [[nodiscard]] bool stopAsked() const;
    void stop() { stop_ = true; }
    /// The lines typed since this was called last; "stop" is not among them.
    [[nodiscard]] std::vector<std::string> takeLines();

private:
    void listen();
    /// Keeps a line; false ends the listening.
    bool keep(std::string line);

    std::atomic<bool> stop_{false};
    std::mutex mutex_;
    std::vector<std::string> lines_;
    int wake_[2] = {-1, -1};  // a pipe that ends the listening thread
    std::thread thread_;
};

}  // namespace master
