// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "host/clock.hpp"

namespace tracking {

/// Takes a line for the person who runs the wall.
using Say = std::function<void(const std::string&)>;
/// A monotonic clock [ns].
using Clock = std::function<std::int64_t()>;

/// Whether a tracker is there: says once when it is gone, and once when it is back.
class Presence {
public:
    static constexpr std::int64_t kLostAfterNs = 500'000'000;

    /// `what` names the tracker in the lines.
    Presence(std::string what, Say say) : what_(std::move(what)), say_(std::move(say)) {}

    /// Once per look at the tracker: did a pose come since the last one?
    void look(bool pose, std::int64_t nowNs);
    /// No pose for so long that whatever comes next may be a tracker started anew.
    [[nodiscard]] bool gone() const { return state_ != State::there; }
    [[nodiscard]] std::uint64_t timesLost() const { return timesLost_; }

private:
    enum class State : std::uint8_t { unseen, awaited, there, lost };

    std::string what_;
    Say say_;
    State state_ = State::unseen;  // awaited: it never was there, and this has been said
    std::int64_t last_ = 0;        // [ns], of the last pose; of the first look before it
    bool looked_ = false;
    std::uint64_t timesLost_ = 0;
};

}  // namespace tracking
