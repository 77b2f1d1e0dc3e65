// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "host/clock.hpp"

namespace tracking {

/// Function that takes a line for the person who runs the wall.
using Print = std::function<void(const std::string&)>;
/// Monotonic clock [ns].
using Clock = std::function<std::int64_t()>;

/// Watch on a tracker. It reports once when the tracker is lost, and once when it is back.
class Presence {
public:
    static constexpr std::int64_t kLostAfterNs = 500'000'000;

    /// Reports to `print`, in lines that name the tracker `what`.
    Presence(std::string what, Print print) : what_(std::move(what)), print_(std::move(print)) {}

    /// Must be called each time the tracker is read. `pose` tells whether a pose has come since the last call.
    void look(bool pose, std::int64_t nowNs);
    /// Returns whether no pose has come for so long that the tracker may have been restarted.
    [[nodiscard]] bool gone() const { return state_ != State::there; }
    [[nodiscard]] std::uint64_t timesLost() const { return timesLost_; }

private:
    enum class State : std::uint8_t { unseen, awaited, there, lost };

    std::string what_;
    Print print_;
    State state_ = State::unseen;  // awaited: no pose has ever come, and this has been reported
    std::int64_t last_ = 0;        // [ns], time of the last pose; before it, time of the first look
    bool looked_ = false;
    std::uint64_t timesLost_ = 0;
};

}  // namespace tracking
