// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "haptic_bridge/hand/pointer.hpp"
#include "haptic_bridge/hand/sand_ray.hpp"
#include "sand/replica.hpp"

namespace haptic_bridge {

/// The sand under a pointer.
///
/// While the pointer is pressed, the sand from before the stroke counts, because otherwise the tool would sink into its
/// own furrow. Used by one thread.
class TouchedSand {
public:
    /// Call it when a touch begins or has ended.
    void forget() { touched_.reset(); }
    /// Returns where the sight through a pointer meets the sand [cell]; nullopt if it passes beside it.
    ///
    /// @param heights  No height of the sand is outside of these [cell].
    [[nodiscard]] std::optional<FieldPlace> meet(const Ray& ray /* [cell] */, bool pressed,
                                                 const sand::Replica& replica, const sand::HeightSpan& heights) const;
    /// Returns a height [unit] of the current sand, or of the sand from before the stroke if `pressed`.
    [[nodiscard]] double height(const sand::Replica& replica, bool pressed, double x,
                                double y /* [probe unit] */) const;
    /// Returns the reading of a pointer, without its time. Copies the sand when a stroke begins, if the replica itself
    /// cannot return the heights from before it.
    [[nodiscard]] PointerSample sample(const Ray& ray /* [cell] */, bool pressed, const sand::Replica& replica,
                                       const sand::HeightSpan& heights /* [cell] */);

private:
    std::unique_ptr<sand::Surface> touched_;  // sand at the touch, if the replica itself cannot return its heights
};

}  // namespace haptic_bridge
