// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "render_node/tool/force_arrow.hpp"
#include "sand/force/contact_force.hpp"
#include "sand/replica.hpp"

namespace render_node {

inline constexpr double kArrowPerNewton = 1.5;                     // [tool radius]
inline constexpr double kMostNewtons = sand::force::kDeviceLimit;  // no arrow is longer than that of this force
inline constexpr double kFewestNewtons = 0.02;                     // no arrow for less

/// The force on the tool by the scene's law, from a rank's own replica: the hand's, but for a velocity that is known
/// once a frame only, and for what guards a device. It reads the sand and never changes it. All ranks that are asked in
/// the same frames answer alike.
class ToolForce {
public:
    explicit ToolForce(const sand::ForceConstants& constants) : constants_(constants) {}

    /// Once a frame. Nothing while the tool hovers or feels no force.
    [[nodiscard]] std::optional<ForceArrow> arrow(const sand::Replica& terrain);

private:
    sand::ForceConstants constants_;
    std::optional<sand::force::Vec3> last_;
    std::uint64_t lastStep_ = 0;
    sand::force::Vec3 velocity_;  // [scene unit per 1/60 s]
};

}  // namespace render_node
