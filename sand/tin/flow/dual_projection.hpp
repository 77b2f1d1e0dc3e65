// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "sand/model/rules.hpp"
#include "sand/tin/volume/vertex_sand.hpp"

namespace sand::tin {

/// The sand nearest to a layer's in which no triangle is steeper than a slope, found through its fluxes.
///
/// As on a grid (sand/grid/dual_projection.hpp): the dual unknown is a pressure in every triangle, a vector, and its
/// maximum is sought by proximal gradient steps with momentum. A triangle's step is its own, w being its area times √λ
/// and λ the largest eigenvalue of GᵀG, G giving the slope by the heights of its corners:
///     step = min over its corners of (star · w / Σ w around the corner) / λ.
/// With these Σ step |G u|² ≤ Σ star u² for all heights u, which is what such steps need. (With the area alone as w,
/// what is slow about a sliver grows with the square of how narrow it is; with its area times λ, triangles around it
/// are as slow as it is.)
///
/// With an open rim it is the nearest that is also 0 high at most on the rim. The volume that falls from a vertex of
/// the rim is an unknown of its own, at least 0. Its step is half of the star; the triangles around share the other
/// half.
///
/// Only what lies around moving sand is computed, and so far around that the whole mesh would give the same numbers. A
/// function of the layer alone: no sum depends on the slots of triangles. Doubles, for a pressure's last bits are sand.
/// Not thread-safe; the layer must outlive it. Memory: 160 bytes for every triangle that is computed.
class DualProjection {
public:
    /// `slope` [unit per probe unit]. Triangles may be steeper by what tells heights apart (slackOf). On an open rim no
    /// vertex may lie above 0 at first.
    DualProjection(const VertexSand& layer, double slope, Rim rim = Rim::closed);

    /// Iterates until the relative duality gap is small enough, or a cap, and returns the number of iterations: 0 where
    /// no triangle is too steep.
    int run();

    /// Returns the gain of each vertex, ascending by vertex [volume unit]. Their sum is 0, because the fluxes of every
    /// triangle add up to 0; with an open rim it is the outflow, negative. None where a number would leave 62 bits.
    [[nodiscard]] std::vector<std::pair<Vertex, std::int64_t>> gains() const;

private:
    struct Vector {
        double east = 0, north = 0;
        [[nodiscard]] double times(const Vector& other) const { return east * other.east + north * other.north; }
    };
    /// A triangle: its slope is first (u_1 − u_0) + second (u_2 − u_0).
    struct Facet {
        std::array<std::int32_t, 3> corner{};  // local numbers
        Vector first, second;                  // [1/probe unit]
        double step = 0;
        double most = 0;  // how steep it may be [unit per probe unit]
        [[nodiscard]] Vector slope(const std::vector<double>& heights) const;
    };
    struct Pressure {
        Vector now, before;
        [[nodiscard]] bool any() const {
            return now.east != 0 || now.north != 0 || before.east != 0 || before.north != 0;
        }
    };
    /// A vertex on an open rim, and what falls from it [volume unit].
    struct Spill {
        std::int32_t vertex = 0;  // local number
        double step = 0;          // [probe unit²]
        double now = 0, before = 0;
    };
    struct Measures {
        double gap = 0, moved = 0;
    };

    [[nodiscard]] std::vector<Vertex> steepCorners() const;
    [[nodiscard]] std::vector<Vertex> pressedCorners() const;
    /// Computes what lies within some edges of these; pressures stay.
    void surround(const std::vector<Vertex>& corners);
    void countEdges(const std::vector<Vertex>& corners);
    [[nodiscard]] std::vector<std::int32_t> trianglesWithin() const;
    [[nodiscard]] Facet facetOf(std::int32_t slot, const std::vector<std::int32_t>& local) const;
    void makeSteps();
    void findSpills(const std::vector<double>& fallen);
    [[nodiscard]] bool nearEdge() const;
    /// What a pressure takes from the corners, until the heights are set.
    void take(const Facet& facet, const Vector& pressure);
    void setHeights();
    /// One step, from pressures extrapolated by `momentum`, and whether it turned back.
    bool iterate(double momentum);
    /// One step of the volumes that fall over the rim, once the heights are known. Returns how far they turned back.
    double spill();
    [[nodiscard]] Measures measure();

    static constexpr int kCheckEvery = 16;           // [iteration]; one carries pressure at most one edge further
    static constexpr int kMargin = kCheckEvery + 1;  // [edge], free of pressure around whatever has some
    static constexpr int kReach = 2 * kMargin;       // [edge], that are computed around it
    static constexpr std::uint8_t kFar = kReach + 1;

    const VertexSand& layer_;
    double slope_;
    Rim rim_;
    std::vector<std::uint8_t> edges_;  // by vertex of the layer: how many lie between it and what moves
    std::vector<Vertex> vertices_;     // by local number, ascending
    std::vector<std::int32_t> slots_;  // of the facets, which are sorted by their corners
    std::vector<Facet> facets_;
    std::vector<Pressure> pressures_;    // of the facets
    std::vector<Spill> spills_;          // ascending by vertex
    std::vector<double> stars_, start_;  // by local number [probe unit²], [unit]
    std::vector<double> taken_;          // by local number, of the pressures [volume unit]
    std::vector<double> heights_;        // by local number [unit]
};

}  // namespace sand::tin
