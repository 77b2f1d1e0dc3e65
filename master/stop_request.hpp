// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <thread>

namespace master {

/// Whether somebody wants the session to end: "stop" on standard input, its end (the launcher is gone), or SIGTERM.
///
/// mpirun hands its standard input to rank 0, so that the launcher can ask for an orderly end and need not send
/// signals, which mpirun follows up with SIGKILL.
class StopRequest {
public:
    /// Starts listening. `readInput` is off for sessions started by hand, where input may be closed.
    explicit StopRequest(bool readInput);
    ~StopRequest();
    StopRequest(const StopRequest&) = delete;
    StopRequest& operator=(const StopRequest&) = delete;

    [[nodiscard]] bool made() const;

private:
    void listen();

    std::atomic<bool> made_{false};
    int wake_[2] = {-1, -1};  // a pipe that ends the listening thread
    std::thread thread_;
};

}  // namespace master
