// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "lockstep/doorbell.hpp"

namespace lockstep {

/// How one wait for a message is spent: MPI can only be asked whether it is there, and asking without rest would burn
/// the core of whoever draws, or of a wall that stands still.
///
/// At first it yields, so that a short wait ends as soon as it can; then it sleeps, always the same share of what the
/// wait has taken so far, so that no wait is made longer by more than that share, nor by more than an eighth of a
/// millisecond: swaps lie no further apart for it. Where a bell rings behind all that is waited for, it sleeps until
/// then instead; what has rung and is not yet there is asked for as without a bell. One wait per object; any thread.
class Backoff {
public:
    explicit Backoff(const std::optional<Doorbell>& bell = std::nullopt);
    /// Before each look.
    void look();
    /// The look found something, and there is more to come.
    void found();
    /// The look found nothing.
    void rest();

    /// What rest() does at a time.
    struct Rest {
        enum class Kind : std::uint8_t { yield, sleep, sleepUntilRung };
        Kind kind = Kind::yield;
        std::int64_t longest = 0;  // [ns]
        friend bool operator==(const Rest&, const Rest&) = default;
    };
    /// The next rest of this wait, at `now` [ns]. The first call begins the wait.
    [[nodiscard]] Rest nextRest(std::int64_t now);

    /// How long to sleep after having waited so long; 0: only yield. [ns]
    [[nodiscard]] static std::int64_t sleepAfter(std::int64_t waited);

private:
    std::optional<Doorbell> bell_;
    std::uint32_t heard_ = 0;            // of the bell, before the last look
    bool rang_ = false;                  // since something was found
    std::optional<std::int64_t> since_;  // [ns], of the first rest
};

/// Has this thread wake when its sleep ends: Linux adds 50 µs to each sleep otherwise, and newer ones let whoever
/// computes on the core finish some milliseconds before.
void wakePunctually();

}  // namespace lockstep
