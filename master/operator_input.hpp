// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <optional>
#include <string_view>
#include <thread>

#include "lockstep/test_pattern.hpp"
#include "sand/step.hpp"

namespace master {

/// What somebody asks of a running session: "stop", "settle" or "pattern NAME|none|next" in a line on standard input;
/// its end (the launcher is gone) or SIGTERM mean stop.
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
    /// What was asked of the sand since this was called last.
    [[nodiscard]] sand::Edit takeEdit() { return edit_.exchange(sand::Edit::none); }
    /// The test pattern that was asked for since this was called last, given the one that is shown.
    [[nodiscard]] std::optional<lockstep::Pattern> takePattern(lockstep::Pattern shown);

private:
    void listen();
    /// Obeys a line; false ends the listening.
    bool obey(std::string_view line);

    std::atomic<bool> stop_{false};
    std::atomic<sand::Edit> edit_{sand::Edit::none};
    static constexpr int kNothing = -1, kNext = -2;
    std::atomic<int> pattern_{kNothing};  // a lockstep::Pattern, or one of the above
    int wake_[2] = {-1, -1};              // a pipe that ends the listening thread
    std::thread thread_;
};

}  // namespace master
