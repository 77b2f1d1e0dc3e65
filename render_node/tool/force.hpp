// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "render_node/tool/force_arrow.hpp"
#include "sand/force/contact_force.hpp"
#include "sand/replica.hpp"

namespace render_node {

inline constexpr double kArrowPerNewton = 1.5;                     // [tool radius]
inline constexpr double kMostNewtons = sand::force::kDeviceLimit;  // a larger force has the arrow of this force
inline constexpr double kFewestNewtons = 0.02;                     // a smaller force has no arrow

/// Force on the tool by the scene's law, computed from a rank's own replica.
///
/// It equals the force that the hand feels, with two differences: the velocity is known only once per frame, and there
/// are no guards. It reads the sand and never changes it. All ranks that call arrow() in the same frames get equal
/// arrows.
class ToolForce {
public:
    explicit ToolForce(const sand::ForceConstants& constants) : constants_(constants) {}

    /// Returns the arrow of this frame. Must be called once per frame. Returns nullopt if the tool hovers or feels no
    /// force.
    [[nodiscard]] std::optional<ForceArrow> arrow(const sand::Replica& replica);

private:
    sand::ForceConstants constants_;
    std::optional<sand::force::Vec3> last_;
    std::uint64_t lastStep_ = 0;
    sand::force::Vec3 velocity_;  // [scene unit per 1/60 s]
};

}  // namespace render_node
