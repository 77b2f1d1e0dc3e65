// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "sand/model/rules.hpp"
#include "sand/model/work_limit.hpp"
#include "sand/tin/volume/vertex_sand.hpp"

namespace sand::tin {

/// The sand nearest to a layer's in which no triangle is steeper than a slope. It is found through its fluxes.
///
/// The method is that of a grid (sand/grid/dual_projection.hpp). The dual unknown is a vector in each triangle, its
/// pressure. Proximal gradient steps with momentum search for the maximum of the dual. Each triangle has its own step:
///     step = min over its corners of (star · w / Σ w around the corner) / λ.
/// Here w is the triangle's area times √λ. λ is the largest eigenvalue of GᵀG, where G maps the corners' heights to
/// the slope. With these steps, Σ step |G u|² ≤ Σ star u² for all heights u, as the method requires.
///
/// With the area alone as w, a sliver would need iterations that grow with the square of its narrowness. With area
/// times λ as w, the triangles around a sliver would be as slow as the sliver.
///
/// With an open rim, the result is the nearest sand that is also at most 0 high on the rim. The volume that falls from
/// a vertex of the rim is a further unknown, at least 0. Its step is half of the star; the triangles around share the
/// other half.
///
/// Computes only an area around moving sand, so wide that the whole mesh would give the same numbers. The result
/// depends only on the layer, because no sum depends on the slots of triangles. Pressures are doubles, because their
/// last bits change the sand. Not thread-safe; the layer must outlive it. Memory: 160 bytes per computed triangle.
class DualProjection {
public:
    /// `slope` is the steepest slope allowed [unit per probe unit]. A triangle may exceed it by slackOf(), because
    /// heights have a limited accuracy. On an open rim, no vertex may lie above 0 at first.
    DualProjection(const VertexSand& layer, double slope, Rim rim = Rim::closed);

    /// Iterates until the relative duality gap is small enough, until `limit` is reached, or up to a largest number of
    /// iterations. Returns the number of iterations, which is 0 if no triangle is too steep. `limit` may be null.
    int run(WorkLimit* limit = nullptr);

    /// Returns the gain of each vertex that changes, in ascending order of vertices [volume unit]. Their sum is 0,
    /// because the fluxes of every triangle add up to 0. With an open rim, their sum is the outflow with a negative
    /// sign. Returns an empty list if a number would need more than 62 bits.
    [[nodiscard]] std::vector<std::pair<Vertex, std::int64_t>> gains() const;

private:
    struct Vector {
        double east = 0, north = 0;
        [[nodiscard]] double times(const Vector& other) const { return east * other.east + north * other.north; }
    };
    /// A triangle. Its slope is first (u_1 − u_0) + second (u_2 − u_0).
    struct Facet {
        std::array<std::int32_t, 3> corner{};  // local numbers
        Vector first, second;                  // [1/probe unit]
        double step = 0;
        double most = 0;  // steepest slope allowed [unit per probe unit]
        [[nodiscard]] Vector slope(const std::vector<double>& heights) const;
    };
    struct Pressure {
        Vector now, before;
        [[nodiscard]] bool any() const {
            return now.east != 0 || now.north != 0 || before.east != 0 || before.north != 0;
        }
    };
    /// A vertex on an open rim, and the volume that falls from it [volume unit].
    struct Spill {
        std::int32_t vertex = 0;  // local number
        double step = 0;          // [probe unit²]
        double now = 0, before = 0;
    };
    /// The duality gap, and the squared change of the sand in the same unit.
    struct Measures {
        double gap = 0, moved = 0;
    };

    [[nodiscard]] std::vector<Vertex> steepCorners() const;
    [[nodiscard]] std::vector<Vertex> pressedCorners() const;
    /// Selects the triangles within kReach edges of these corners. Pressures stay.
    void surround(const std::vector<Vertex>& corners);
    void countEdges(const std::vector<Vertex>& corners);
    [[nodiscard]] std::vector<std::int32_t> trianglesWithin() const;
    [[nodiscard]] Facet facetOf(std::int32_t slot, const std::vector<std::int32_t>& local) const;
    void makeSteps();
    void findSpills(const std::vector<double>& fallen);
    [[nodiscard]] bool nearEdge() const;
    /// Adds the volume that a pressure takes from the corners to `taken_`.
    void take(const Facet& facet, const Vector& pressure);
    /// Sets the heights from `taken_`, and sets `taken_` to 0.
    void setHeights();
    /// Makes one step, from pressures that `momentum` extrapolates. Returns whether the step turned back.
    bool iterate(double momentum);
    /// Makes one step of the volumes that fall over the rim, from the current heights. Returns by how much they turned
    /// back.
    double spill();
    [[nodiscard]] Measures measure();

    static constexpr int kCheckEvery = 16;           // [iteration]; each carries pressure at most one edge further
    static constexpr int kMargin = kCheckEvery + 1;  // [edge], free of pressure around the triangles under pressure
    static constexpr int kReach = 2 * kMargin;       // distance that is computed around them [edge]
    static constexpr std::uint8_t kFar = kReach + 1;

    const VertexSand& layer_;
    double slope_;
    Rim rim_;
    std::vector<std::uint8_t> edges_;  // by vertex of the layer: number of edges to the moving sand, at most kFar
    std::vector<Vertex> vertices_;     // by local number, ascending
    std::vector<std::int32_t> slots_;  // of the facets, which are sorted by their corners
    std::vector<Facet> facets_;
    std::vector<Pressure> pressures_;    // of the facets
    std::vector<Spill> spills_;          // ascending by vertex
    std::vector<double> stars_, start_;  // by local number: stars [probe unit²], heights at the start [unit]
    std::vector<double> taken_;          // by local number: volume taken by the pressures [volume unit]
    std::vector<double> heights_;        // by local number [unit]
};

}  // namespace sand::tin
