// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "lockstep/doorbell.hpp"

namespace lockstep {

/// Pauses of one wait for a message. MPI can only be polled for a message. Polling without a pause would take the core
/// from a rank that draws, and would keep a core busy while the wall is still.
///
/// In the first 50 µs a wait only yields the core, so that a short wait ends as soon as possible. After that it sleeps
/// between two looks, each time for an eighth of the time waited so far, at most 0.125 ms. A sleep therefore makes a
/// wait longer by at most an eighth, and delays a swap by at most 0.125 ms.
///
/// With a bell, the wait sleeps until the bell rings. If the bell has rung but the message is not there yet, the wait
/// polls as it does without a bell. Use one object per wait, on any thread.
class Backoff {
public:
    explicit Backoff(const std::optional<Doorbell>& bell = std::nullopt);
    /// Notes how often the bell has rung. Call it before each look for a message.
    void look();
    /// Call it when a look has found a message and more messages are awaited.
    void found();
    /// Yields or sleeps. Call it when a look has found no message.
    void rest();

    /// One pause of rest().
    struct Rest {
        enum class Kind : std::uint8_t { yield, sleep, sleepUntilRung };
        Kind kind = Kind::yield;
        std::int64_t longest = 0;  // [ns], of a sleep
        friend bool operator==(const Rest&, const Rest&) = default;
    };
    /// Returns the next pause of this wait. `now` is the present time [ns]. The first call begins the wait.
    [[nodiscard]] Rest nextRest(std::int64_t now);

    /// Returns how long to sleep after a wait of `waited` [ns]; 0 means to yield only.
    [[nodiscard]] static std::int64_t sleepAfter(std::int64_t waited);

private:
    std::optional<Doorbell> bell_;
    std::uint32_t heard_ = 0;            // count of the bell before the last look
    bool rang_ = false;                  // whether the bell has rung since the last message was found
    std::optional<std::int64_t> since_;  // [ns], time of the first pause
};

/// Makes Linux wake the calling thread exactly when its sleep ends. Otherwise Linux adds 50 µs to each sleep, and newer
/// kernels first let the thread that computes on this core run for some milliseconds.
void wakePunctually();

}  // namespace lockstep
