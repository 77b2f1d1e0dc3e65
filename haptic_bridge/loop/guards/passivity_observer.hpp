// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "haptic_bridge/loop/guards/force_limits.hpp"
#include "sand/force/vec3.hpp"

namespace haptic_bridge {

/// Observer of the energy that the sent forces have given the hand. It damps the energy that they should not have given
/// (after Hannaford and Ryu 2002).
///
/// Sand gives back at most the energy of a spring of its stiffness at the present force. The observer therefore keeps
/// no more credit than that, however much work the hand has put into the sand. It counts three quarters of the arm's
/// own damping as taken by the arm; a loop within its limits leaks half of that damping. A surplus decays with a time
/// constant of half a second, because by then the arm and the hand have taken it.
class PassivityObserver {
public:
    explicit PassivityObserver(const ForceLimits& limits);

    /// Takes the tip's current `place` [m]. The tip has moved for `span` [s] under the force that acted.
    void observe(sand::force::Vec3 place, double span);
    /// Takes a tick of `span` [s] without a place. The next place counts for it: the tip has then moved at one speed.
    void wait(double span);
    /// Returns the damping force that takes the surplus back within one tick; zero without a surplus.
    [[nodiscard]] sand::force::Vec3 control(sand::force::Vec3 velocity, std::uint32_t& acted) const;
    /// Takes the force that is sent to the device at this tick.
    void sent(sand::force::Vec3 force);
    void restart();

    [[nodiscard]] double returned() const { return returned_; }  // [J], Σ F · Δx since the start; negative if taken
    [[nodiscard]] double surplus() const { return surplus_; }    // [J], energy given beyond credit and damping

private:
    static constexpr std::size_t kMostDelay = 16;

    /// Returns the force that has acted until now, after the device's delay.
    [[nodiscard]] sand::force::Vec3 acting() const { return sent_[(newest_ + kMostDelay - delay_) % kMostDelay]; }

    double stiffness_, damping_, most_, tolerance_;
    std::size_t delay_;
    std::array<sand::force::Vec3, kMostDelay> sent_{};  // ring buffer of the latest forces
    std::size_t newest_ = 0;
    sand::force::Vec3 place_;
    double waited_ = 0;          // [s], since place_ was taken
    sand::force::Vec3 impulse_;  // [N s], of the forces that have acted in this time
    bool begun_ = false;
    double returned_ = 0, surplus_ = 0;
};

}  // namespace haptic_bridge
