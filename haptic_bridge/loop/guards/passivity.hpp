// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "haptic_bridge/loop/guards/force_limits.hpp"
#include "sand/force/vec3.hpp"

namespace haptic_bridge {

/// Observes the energy that the forces sent have given the hand, and damps what they should not have (after Hannaford
/// and Ryu 2002).
///
/// Sand gives back at most what a spring of its stiffness holds at the present force, so no credit is kept beyond
/// that, however much work a hand has left in the sand; and the arm itself takes three quarters of what its damping
/// does: a loop within its limits leaks half of that. A surplus is forgotten with a time constant of half a second,
/// because the arm and the hand have taken by then what was not taken back.
class PassivityObserver {
public:
    explicit PassivityObserver(const ForceLimits& limits);

    /// Where the tip is now [m], after it moved for `span` [s] under the force that acted.
    void observe(sand::force::Vec3 place, double span);
    /// The damping force that takes the surplus back within a tick; 0 when there is none.
    [[nodiscard]] sand::force::Vec3 control(sand::force::Vec3 velocity, std::uint32_t& acted) const;
    /// What goes to the device now.
    void sent(sand::force::Vec3 force);
    void restart();

    [[nodiscard]] double returned() const { return returned_; }  // [J], Σ F · Δx since the start, negative if taken
    [[nodiscard]] double surplus() const { return surplus_; }    // [J], given beyond what is accounted for

private:
    static constexpr std::size_t kMostDelay = 16;

    double stiffness_, damping_, most_, tolerance_;
    std::size_t delay_;
    std::array<sand::force::Vec3, kMostDelay> sent_{};  // a ring
    std::size_t newest_ = 0;
    sand::force::Vec3 place_;
    bool begun_ = false;
    double returned_ = 0, surplus_ = 0;
};

}  // namespace haptic_bridge
