// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <string_view>
#include <thread>

#include "sand/step.hpp"

namespace master {

/// What somebody asks of a running session: "stop" or "settle" in a line on standard input; its end (the launcher is
/// gone) or SIGTERM mean stop.
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
    /// What was asked of the sand since this was called last.
    [[nodiscard]] sand::Edit takeEdit() { return edit_.exchange(sand::Edit::none); }

private:
    void listen();
    /// Obeys a line; false ends the listening.
    bool obey(std::string_view line);

    std::atomic<bool> stop_{false};
    std::atomic<sand::Edit> edit_{sand::Edit::none};
    int wake_[2] = {-1, -1};  // a pipe that ends the listening thread
    std::thread thread_;
};

}  // namespace master
