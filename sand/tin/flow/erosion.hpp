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

/// Sand on a TIN that slides where it is steeper than its talus.
///
/// **Law.** One sweep moves a volume over every edge, over all edges at once:
///
///     Q = trunc((w_l c_l + w_r c_r)₊ (u_i − u_j)) [volume unit]
///
/// - u_i, u_j: heights of the edge's ends i and j.
/// - l, r: the two triangles of the edge.
/// - c = .8 (m² − g²)/(m² + g²) of a triangle if m > g, else 0. Here m is the slope of the triangle, and g that of the
///   talus.
/// - w: half the cotangent of the angle opposite the edge, times a step of the edge.
/// - k_e: upper bound of the flow per height over the edge. The step of the edge is so small that the sum of k_e over
///   all edges of a vertex is at most .9996 of its star (weights.hpp).
///
/// Without momentum, sweeps descend a convex energy, and sand rests where no triangle is steeper than g. Each
/// triangle has its own c, because with one slope per edge, the mean of its triangles', sand crept along kinks for a
/// million sweeps.
///
/// **Proofs.**
/// - Volume is exact: Q is subtracted at one end and added at the other.
/// - No new extremes: star_i u_i' = star_i u_i − Σ Q with |Q| ≤ k_e |u_i − u_j| and Σ k_e < star_i. Therefore u_i'
///   lies between the heights of i and its neighbours.
/// - No sand in an obstacle: an obstacle only makes Q smaller, to at most k_e (underside − u). So no vertex rises above
///   the underside.
/// - It ends: Σ V²/star falls in every sweep that moves sand. It changes by −2 Σ_e Q (u_i − u_j) + Σ_i (Σ Q)²/star_i.
///   Here (Σ Q)² ≤ Σ k_e Σ Q²/k_e ≤ .9996 star_i Σ Q²/k_e. Over both ends of an edge, that is less than 2 Q (u_i −
///   u_j). Weaker bounds do not suffice. With a bound on Σ c k_e instead of Σ k_e, two vertices can swap, or wait,
///   without end. They can do so with one step for all edges, too.
///
/// **Momentum.** In sweep(), a part of the last sweep's flux continues, and triangles flatter than g brake it. Each
/// call begins without momentum. The flux is cut to less than k_e (u_i − u_j) and never flows uphill. The proofs
/// require only these two properties of Q.
///
/// **Open rim.** Beyond an open rim the ground is at height 0, and the step down to it has no talus. At the end of a
/// sweep, all sand above 0 on a vertex of the rim falls over the rim. It never comes back. Sand at rest is then at most
/// 0 high on the rim, and nowhere higher than g times the distance to the rim. The proofs still hold:
/// - Volume is exact: the volume that falls is counted to the unit.
/// - No new extremes: the new height 0 lies between u and the ground beyond the rim.
/// - It ends: V²/star of such a vertex falls to 0, and no other sand moves.
///
/// **Start threshold.** Sand at rest starts to slide beyond the start threshold. This sand and all sand that it touches
/// then slide down to the threshold. That may take many calls of sweep(), because the layer records which sand moves.
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
