// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/loop/guards/limited_law.hpp"

#include <algorithm>

#include "haptic_bridge/hand/guard_counts.hpp"

namespace haptic_bridge {
namespace {

using sand::force::Vec3;

constexpr double kFramesPerSecond = 60;
constexpr double kMatters = 0.97;  // a guard has acted if a smaller share is left

}  // namespace

Vec3 lawfulForce(const sand::force::Response& felt, Vec3 velocity, double scale) {
    return sand::force::lawfulForce(felt, (scale / kFramesPerSecond) * velocity);
}

Vec3 limitedForce(const sand::force::Response& felt, Vec3 velocity, const LimitsNow& now, std::uint32_t& acted) {
    const ForceLimits& limits = now.limits;
    // The gain is the same everywhere. Otherwise the force would rise within a fraction of a cell where little of the
    // tool is over the sand. The gain is smaller only where the law is stiffer than at a depth of one radius.
    const double stiffness = limits.gain * felt.stiffness * limits.scale;
    const double gain = now.softness * limits.gain * (stiffness > limits.stiffness ? limits.stiffness / stiffness : 1);
    const Vec3 push = gain * felt.push;
    const double pressed = norm(push);
    acted |= gain < kMatters && pressed > 0 ? bit(Guard::stiffness) : 0;

    const Vec3 slip = sand::force::rubbing(felt, velocity);
    const double speed = norm(slip);
    const double asked = gain * felt.drag * limits.scale / kFramesPerSecond;  // [N · s/m]
    const double soft = asked / (1 + 2 * asked * ForceLimits::kTick / limits.arm.mass);
    const double viscous = std::min(soft, limits.damping);
    acted |= viscous < kMatters * asked && speed > 0 ? bit(Guard::damping) : 0;
    const double held = now.talus * pressed;
    acted |= held < kMatters * viscous * speed ? bit(Guard::friction) : 0;
    const double drag = viscous * speed > held ? held / speed : viscous;
    return push - drag * slip;
}

}  // namespace haptic_bridge
