// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "haptic_bridge/hand/hand_ticks.hpp"
#include "haptic_bridge/hand/held.hpp"
#include "haptic_bridge/loop/guards/guards.hpp"

namespace haptic_bridge {

/// Returns the force that the law asks for within what the arm can bear [N]: the law with the constant gain of
/// `guards`, at most as great as the device's greatest force. Without that gain a stiff scene would always ask a soft
/// arm for more than it can give. With `--guards literal`, the law as it is. NaN if a number is not finite.
[[nodiscard]] double askedForce(const Guards& guards, const Guards::Reading& reading, sand::force::Vec3 lawful);

/// Age of the sand that is felt, at one tick.
struct SandAge {
    double felt = 0;                          // [s], as the guard `frozen` sees it: it covers movement that waits, too
    double made = 0;                          // [s], since the newest step was made
    std::optional<Held> held = std::nullopt;  // of the wall's last frame; nullopt before its first frame
};
/// Returns the cause for which the sand counts as stopped for the guard `frozen` now; nullopt if steps come.
[[nodiscard]] std::optional<ForceOutcome> stoppedBy(const SandAge& age, double stepSeconds);

/// Decides the outcome of each tick in which the law asks for force.
///
/// A tick may have several causes. The first of these that applies counts:
/// 1. a choice of a person: a share of at most a half, or one without which the hand would have had half; a pause;
/// 2. a fault in this tick;
/// 3. sand that has stopped, until the force is back; then the ramp after a start or a fault; then that after a choice;
/// 4. a guard that limits how fast a force grows;
/// 5. `damped`.
///
/// In a tick without a reading, the law asks for what it asked for at the last reading. Used by one thread; allocates
/// no memory.
class ForceAccount {
public:
    struct Tick {
        double time = 0;                                     // [s]
        std::optional<double> asked = std::nullopt;          // [N], askedForce(); nullopt: the device gave no place
        double sent = 0;                                     // [N], norm of the pushed force
        std::uint32_t acted = 0;                             // bits of the guards
        double share = 1;                                    // TickInput::share
        bool clutch = false;                                 // the clutch is held
        std::optional<ForceOutcome> stopped = std::nullopt;  // stoppedBy()
    };
    /// Returns the outcome; nullopt if the law asks for no force.
    [[nodiscard]] std::optional<ForceOutcome> tick(const Tick& now);
    /// Forgets all ticks, because a link begins.
    void forget() { *this = ForceAccount(); }

private:
    [[nodiscard]] ForceOutcome outcomeOf(const Tick& now) const;
    [[nodiscard]] std::optional<ForceOutcome> chosen(const Tick& now) const;

    double asked_ = 0;                              // [N], at the last reading
    ForceOutcome rampBy_ = ForceOutcome::start;     // cause of the gate's ramp
    ForceOutcome stoppedBy_ = ForceOutcome::start;  // cause for which sand has stopped
    ForceOutcome chosenBy_ = ForceOutcome::off;     // last choice of a share of at most a half
    double chosenUntil_ = 0;                        // [s], end of the ramp after that choice
    double heldUntil_ = 0;                          // [s], until when sand counts as stopped because the wall was held
};

}  // namespace haptic_bridge
