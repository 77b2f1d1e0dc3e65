// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sand/tin/flow/active_edges.hpp"
#include "sand/tin/volume/vertex_sand.hpp"

namespace sand::tin {

/// The highest that sand may lie over a place, for as long as a tool stands there [unit]; the largest number beside it.
using Underside = ActiveEdges::Underside;

/// Of thresholds as Rules has them [unit per cell].
[[nodiscard]] Slopes slopesOf(std::int32_t threshold, std::int32_t startThreshold);

/// Sand that slides where it is steeper than its talus, on a TIN.
///
/// One sweep moves, over every edge at once, Q = trunc((w_l c_l + w_r c_r)₊ (u_i − u_j)) volume units. Of the edge's
/// two triangles c = .8 (m² − g²)/(m² + g²), m being the triangle's slope, where that is steeper than g, else nothing;
/// w is half the cotangent of the angle opposite the edge, times a step of the edge's own, such that what flows is at
/// most k_e per height and the sum of k_e over a vertex's edges at most .9996 of its star, at both ends (weights.hpp).
/// Without momentum it is the descent of a convex energy, and it rests where no triangle is steeper than g; with one
/// slope per edge, the mean of its triangles', sand crept along kinks for a million sweeps.
///
/// - Volume is exact: Q is taken here and given there.
/// - No new extremes: star_i u_i' = star_i u_i − Σ Q with |Q| ≤ k_e |u_i − u_j| and Σ k_e < star_i, so u_i' lies
///   between the heights of i and its neighbours. An obstacle only makes Q smaller, to k_e (underside − u) at the most:
///   for the same reason no vertex rises above it.
/// - It ends: Σ V²/star falls in every sweep that moves anything. It changes by
///   −2 Σ_e Q (u_i − u_j) + Σ_i (Σ Q)²/star_i, and (Σ Q)² ≤ Σ k_e Σ Q²/k_e ≤ .9996 star_i Σ Q²/k_e, which over both
///   ends of an edge is less than 2 Q (u_i − u_j). With Σ c k_e bounded instead of Σ k_e, or one step for all, two
///   vertices can swap for ever, or wait as long.
///
/// In sweep() a part of the last sweep's flux goes on, which triangles flatter than g brake; each call begins without.
/// It is cut to less than k_e (u_i − u_j) and never flows uphill, which is all that the proofs ask of Q.
///
/// Beyond an open rim the ground lies at height 0, and a step that high has no talus: at the end of a sweep all that
/// lies above 0 on a vertex of the rim falls over it, and none comes back. Sand at rest is then 0 on the rim, and
/// nowhere higher than g times the distance to it.
///
/// - Volume is exact: what falls is counted, to the unit.
/// - No new extremes: max(u, 0) → 0 is a height between u and that of the ground beyond.
/// - It ends: V²/star of such a vertex falls to 0, and no other sand moves.
///
/// Sand at rest begins to slide beyond the start threshold; in the same call of sweep() it then slides, with all that
/// it touches, until the threshold. The result of sweep() is a function of layer, rules and the number of sweeps: not
/// of slots, active sets or threads, nor of what came before. Not thread-safe.
class Erosion {
public:
    /// `threshold` and `startThreshold` as Rules': height units per cell size, sliding and starting to. All may move.
    Erosion(const VertexSand& layer, std::int32_t threshold, std::int32_t startThreshold, Rim rim = Rim::closed);

    /// As Mesh's.
    void reserve(std::size_t vertices);
    void changeThresholds(std::int32_t threshold, std::int32_t startThreshold);  // wakes everything
    /// The layer's mesh or sand is another there now: its weights are made anew, and it may move.
    void changed(const VertexSand& layer, const Mesh::Change& change);
    /// These may move again, mesh and sand being as they were.
    void wake(const std::vector<Vertex>& vertices);

    /// While `held` is given no flux raises a vertex above it. Who puts it down, or moves it, wakes the vertices that
    /// are higher than a unit below it: sand beside them may lean on it now. Vertices that moved are added to `moved`,
    /// ascending, each once. Costs what moves: next to nothing once the sand lies still. Sand under an obstacle is
    /// looked at again by the next call for which it is another one there, so that nobody need wake it when the tool
    /// leaves.
    int sweep(VertexSand& layer, int sweeps, const Underside* held, std::vector<Vertex>& moved);
    /// The same without momentum nor obstacle, until nothing moves or there were so many: it takes longer to come to
    /// rest than many calls of sweep() do, and the pile is righter.
    int settle(VertexSand& layer, int most, std::vector<Vertex>& moved);
    /// Returns the volume that has fallen over an open rim since the last call [volume unit]; the layer has lost it.
    [[nodiscard]] std::int64_t takeOutflow() { return active_.takeOutflow(); }
    /// Whether nothing moves any more as things are.
    [[nodiscard]] bool settled() const;
    /// How many edges the next sweep looks at, woken ones apart.
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
