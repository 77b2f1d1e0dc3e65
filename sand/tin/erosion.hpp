// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sand/tin/layer.hpp"

namespace sand::tin {

/// The highest that sand may lie over a place, for as long as a tool stands there [unit]; kFree beside the tool.
using Underside = std::function<std::int32_t(Place)>;

/// Sand that slides where it is steeper than its talus, on a TIN.
///
/// One sweep moves, over every edge at once, Q = trunc(c_e (u_i − u_j)) volume units, c_e = k_e (1 − g/m_e) where the
/// surface at the edge is steeper than g, else nothing. k_e follows from clamped cotangent weights such that the sum of
/// k_e over a vertex's edges is at most .9996 of its share of the ground, at both ends. Hence volume is exact, nothing
/// rises above the highest or sinks below the lowest of its neighbours, and it comes to rest. The result is a function
/// of layer and rules: not of slots, active sets or threads. Not thread-safe.
class Erosion {
public:
    /// `threshold` and `startThreshold` as Rules': height units per cell size, sliding and starting to.
    Erosion(const Layer& layer, std::int32_t threshold, std::int32_t startThreshold);

    void changeThresholds(std::int32_t threshold, std::int32_t startThreshold);  // wakes everything
    /// The layer's mesh or sand is another there now: its weights are made anew, and it may move.
    void changed(const Layer& layer, const Mesh::Change& change);
    /// These may move again, mesh and sand being as they were.
    void wake(const std::vector<Vertex>& vertices);

    /// While `held` is given no flux raises a vertex above it. Vertices that moved are added to `moved`, ascending,
    /// each once. Costs what moves: nothing once the sand lies still.
    void sweep(Layer& layer, int sweeps, const Underside* held, std::vector<Vertex>& moved);
    [[nodiscard]] bool settled() const;
};

}  // namespace sand::tin
