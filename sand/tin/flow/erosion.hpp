// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sand/tin/flow/active_edges.hpp"
#include "sand/tin/volume/vertex_sand.hpp"

namespace sand::tin {

/// Function that returns the greatest height of sand at a place below a tool [unit]. Beside the tool, returns the
/// largest number.
using Underside = ActiveEdges::Underside;

/// Returns the slopes for thresholds as in Rules [unit per cell].
[[nodiscard]] Slopes slopesOf(std::int32_t threshold, std::int32_t startThreshold);

/// Sand on a TIN that slides where a triangle is steeper than the talus.
///
/// One sweep moves a volume over every edge, over all edges at once, and rounds it once. docs/tin.md#erosion has the
/// law and the proofs: volume is exact, no vertex leaves the range of the heights before or enters an obstacle, and
/// sliding ends. The proofs need only that a flux keeps below its bound (weights.hpp) and never flows uphill.
///
/// Each call of sweep() begins without momentum. Sand that began to slide beyond the start threshold may need many
/// calls until it stops at the threshold. The layer records which sand moves.
///
/// The result of sweep() depends only on the layer, the rules, the obstacle and the number of sweeps. It does not
/// depend on slots, active sets, threads or earlier calls. Not thread-safe.
class Erosion {
public:
    /// `threshold` and `startThreshold` are those of Rules: the slopes at which sliding sand stops and sand at rest
    /// starts [unit per cell]. The first sweep examines all sand.
    Erosion(const VertexSand& layer, std::int32_t threshold, std::int32_t startThreshold, Rim rim = Rim::closed);

    /// Reserves memory for `vertices` vertices in all.
    void reserve(std::size_t vertices);
    void changeThresholds(std::int32_t threshold, std::int32_t startThreshold);  // examines all sand again
    /// Call this after the layer's mesh or sand has changed. Weights there are computed again, and sand there may move.
    void changed(const VertexSand& layer, const Mesh::Change& change);
    /// Wakes these vertices: their sand may move again, although neither mesh nor sand has changed there.
    void wake(const std::vector<Vertex>& vertices);

    /// Runs at most `sweeps` sweeps, fewer if all sand is at rest before. Returns their number.
    ///
    /// No flux raises a vertex above `held`, the underside of an obstacle, or null. A caller that places or moves the
    /// obstacle must wake the vertices higher than a unit below it. Sand beside them may now lean on it. When the tool
    /// leaves, no such call is needed: a call in which the underside at a vertex has changed examines the sand there
    /// again.
    ///
    /// Adds the vertices that moved, began to move or stopped to `moved`, in ascending order, each once. The cost grows
    /// with the amount of moving sand. It is negligible when all sand is at rest.
    int sweep(VertexSand& layer, int sweeps, const Underside* held, std::vector<Vertex>& moved);
    /// Runs at most `most` sweeps without momentum and without an obstacle, fewer if all sand is at rest before.
    /// Returns their number. Sand needs more sweeps than with sweep(), but the pile is more accurate.
    int settle(VertexSand& layer, int most, std::vector<Vertex>& moved);
    /// Returns the volume that has fallen over an open rim since the last call [volume unit]; the layer has lost it.
    [[nodiscard]] std::int64_t takeOutflow() { return active_.takeOutflow(); }
    /// Returns whether sweeps have found all sand at rest and no vertex was woken since.
    [[nodiscard]] bool settled() const;
    /// Returns the number of edges that the next sweep visits, without those of woken vertices.
    [[nodiscard]] std::size_t activeEdges() const { return active_.size(); }

private:
    [[nodiscard]] int run(VertexSand& layer, int sweeps, const Underside* held, std::vector<Vertex>& moved,
                          bool momentum);
    void watchWoken(const VertexSand& layer);

    Slopes slopes_;
    Weights weights_;
    ActiveEdges active_;
    std::vector<Vertex> woken_;
    bool wakeAll_ = true;
};

}  // namespace sand::tin
