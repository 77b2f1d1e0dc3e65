// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <optional>

#include "base/names.hpp"
#include "haptic_bridge/hand/guard_counts.hpp"

namespace haptic_bridge {

/// Outcome of a tick in which the law asks for force: `half`, or the cause for which the hand had less than that.
/// ForceAccount decides it.
enum class ForceOutcome : std::uint8_t {
    half,  // the hand had at least half of the force
    // Causes that a person chose.
    off,     // force is switched off
    share,   // the hand feels a share of the force
    clutch,  // the clutch is held
    pause,   // the sand is paused
    // Causes that make a note at most.
    start,       // a link begins: its ramp, and the time until the wall shows its first frame
    slowMotion,  // steps come, but the movement of the hand waits for the sweeps of a large tool
    disk,        // the journal's disk has no room, so that no steps come
    growth,      // a contact or an edit asks for much force at once, or the force grows as fast as the arm bears
    damped,      // the observer damps, or a force that is held between late steps must be softer
    // Causes in the arm, in the link or in this machine.
    steps,       // no steps come: the wall or the link is slow, or a program hangs
    notANumber,  // a fault, or the ramp after it, under the name of its guard
    stale,
    missed,
    lost,
    jumped,
    tripped  // three faults within ten seconds: no force until an operator switches it on
};
constexpr auto valuesOf(ForceOutcome) {
    using enum ForceOutcome;
    return std::array{base::Named{half, "half"},
                      base::Named{off, "off"},
                      base::Named{share, "share"},
                      base::Named{clutch, "clutch"},
                      base::Named{pause, "pause"},
                      base::Named{start, "start"},
                      base::Named{slowMotion, "slow_motion"},
                      base::Named{disk, "disk"},
                      base::Named{growth, "growth"},
                      base::Named{damped, "damped"},
                      base::Named{steps, "steps"},
                      base::Named{notANumber, "not_a_number"},
                      base::Named{stale, "stale"},
                      base::Named{missed, "missed"},
                      base::Named{lost, "lost"},
                      base::Named{jumped, "jumped"},
                      base::Named{tripped, "tripped"}};
}
/// Number of ticks with each outcome, in the order of valuesOf(ForceOutcome).
using OutcomeCounts = std::array<std::uint64_t, valuesOf(ForceOutcome{}).size()>;

/// Number of ticks while a master is linked, and of the seconds that they are in. One thread writes, any thread may
/// read; no thread waits.
class HandTicks {
public:
    /// Adds a tick.
    ///
    /// @param time     Time of the hand [s]. It counts only while a master is linked.
    /// @param acted    Bits of the guards that acted.
    /// @param felt     A force above 0 was pushed.
    /// @param outcome  nullopt if the law asks for no force.
    void add(double time, std::uint32_t acted, bool felt, std::optional<ForceOutcome> outcome) {
        const bool fault = (acted & (kFaults | bit(Guard::unread))) != 0;  // a missing reading counts for its second
        count(all_, true);
        count(felt_, felt);
        count(faulted_, (acted & kFaults) != 0);
        if (outcome) {
            count(asked_[static_cast<std::size_t>(*outcome)], true);
        }
        const double second = std::floor(time);
        count(seconds_, second != second_);
        faultInSecond_ = faultInSecond_ && second == second_;
        second_ = second;
        count(faultedSeconds_, fault && !faultInSecond_);
        faultInSecond_ = faultInSecond_ || fault;
    }
    [[nodiscard]] std::uint64_t all() const { return read(all_); }
    /// Return the number of ticks that pushed a force above 0, and of those in which a fault acted.
    [[nodiscard]] std::uint64_t felt() const { return read(felt_); }
    [[nodiscard]] std::uint64_t faulted() const { return read(faulted_); }
    /// Return the number of seconds with a tick, and of those with a fault.
    [[nodiscard]] std::uint64_t seconds() const { return read(seconds_); }
    [[nodiscard]] std::uint64_t faultedSeconds() const { return read(faultedSeconds_); }
    /// Returns the number of ticks in which the law asks for force, by outcome.
    [[nodiscard]] OutcomeCounts asked() const {
        OutcomeCounts counts{};
        for (std::size_t i = 0; i < counts.size(); ++i) {
            counts[i] = read(asked_[i]);
        }
        return counts;
    }

private:
    using Counter = std::atomic<std::uint64_t>;
    static void count(Counter& counter, bool counts) { counter.store(read(counter) + (counts ? 1 : 0), kRelaxed); }
    static std::uint64_t read(const Counter& counter) { return counter.load(kRelaxed); }
    static constexpr std::memory_order kRelaxed = std::memory_order_relaxed;

    Counter all_{0}, felt_{0}, faulted_{0}, seconds_{0}, faultedSeconds_{0};
    std::array<Counter, OutcomeCounts{}.size()> asked_{};
    // For the thread that writes.
    double second_ = -1;          // of the last tick
    bool faultInSecond_ = false;  // a tick of that second had a fault
};

}  // namespace haptic_bridge
