// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/code_path.hpp"
#include "sand/tin/flow/sweep_kernel.hpp"
#include "sand/tin/flow/weights.hpp"

namespace sand::tin {

/// The part of a mesh that sweeps move: vertices, facets and edges with their own numbers, 0, 1, 2 …, side by side in
/// memory.
///
/// Volumes are whole numbers, and so are fluxes. As long as the largest star times the greatest height is below 2^51
/// they and all their sums are exact as doubles, which processors move four at a time; beyond, they are 64-bit
/// integers, for the same result. Not thread-safe.
class ActiveMesh {
public:
    static constexpr double kFree = 0x1p40;  // [unit], an underside where there is no obstacle: above all sand

    /// `wide` has integers from the start: for tests.
    explicit ActiveMesh(bool v3 = base::machineHasV3(), bool wide = false) : v3_(v3), alwaysWide_(wide) {}

    /// `spills`: it is on an open rim, and what lies above height 0 there falls over it in each sweep.
    std::int32_t addVertex(std::int64_t volume, std::int64_t star, double underside = kFree, bool spills = false);
    /// Corners, ends and facets by their numbers here.
    std::int32_t addFacet(const Facet& facet);
    void addEdge(const Edge& edge);

    [[nodiscard]] std::size_t vertexCount() const { return stars_.size(); }
    [[nodiscard]] std::size_t facetCount() const { return first_.size(); }
    [[nodiscard]] std::size_t edgeCount() const { return from_.size(); }
    [[nodiscard]] std::int64_t volume(std::size_t vertex) const {
        return isWide_ ? wide_[vertex] : static_cast<std::int64_t>(volumes_[vertex]);
    }
    [[nodiscard]] Facet facet(std::int32_t number) const;  // its corners
    [[nodiscard]] Edge edge(std::size_t number) const;     // its ends and facets

    /// Forgets what the last sweep moved: nothing goes on. Each vertex is to be placed before the next.
    void restart();
    void place(std::size_t vertex, std::int64_t volume, std::int64_t star, double underside);
    /// Told of a vertex whose edges are all here, and of one that misses some (as all do at first).
    void setWatched(std::size_t vertex, bool watched) { unwatched_[vertex] = watched ? 0 : ~std::uint64_t{0}; }
    [[nodiscard]] bool isWatched(std::size_t vertex) const { return unwatched_[vertex] == 0; }

    /// Told of a facet whose edges are all here, and of one that misses some (as all do at first).
    void setBare(std::size_t facet, bool bare) { bare_[facet] = bare ? ~std::uint64_t{0} : 0; }

    /// The first half of a sweep: how strongly facets slide, from `first` on (those before it are known then). `held`:
    /// undersides hold; `band`: facets at rest start to slide later than sliding ones stop. Those that slide though
    /// they miss edges, over which sand may flow in move(); until the next call.
    [[nodiscard]] std::span<const std::int32_t> slide(bool held, bool band, std::size_t first = 0);
    /// The second half: what flows over the edges, where `momentum` of the last sweep's fluxes goes on, 0 to 1.
    SweepResult move(bool held, double momentum);
    /// Whether sand flowed at one of a vertex's edges in the last sweep.
    [[nodiscard]] bool flowed(std::size_t vertex) const { return levels_[vertex].flow > 0; }
    [[nodiscard]] std::int64_t restingCount() const;
    /// A byte for each.
    struct Marks {
        std::vector<std::uint8_t> facets, edges;
    };
    /// Facets at which sand flowed, so that they may slide or brake in the next sweep, and the edges of those
    /// that slid or over which sand flowed.
    [[nodiscard]] Marks whatMayFlow() const;
    /// Adds the vertices whose edges are not all here though sand flowed at one.
    void findUnwatched(std::vector<std::int32_t>& found) const;

    /// Where facets and vertices are after some went; kNobody: nobody needs it any more.
    struct Renumbering {
        std::vector<std::int32_t> vertices, facets;
    };
    /// Keeps these facets and edges and what they need, in the order in which they are.
    Renumbering keep(const Marks& kept);

private:
    void notice(std::int64_t volume, std::int64_t star);
    void widen();
    [[nodiscard]] bool isHeld(std::int32_t vertex) const {
        return undersides_[static_cast<std::size_t>(vertex)] < kFree;
    }
    void findHeld();
    SweepResult moveWide();

    bool v3_, alwaysWide_;
    bool isWide_ = alwaysWide_;
    double largestStar_ = 0, greatestHeight_ = 0;
    std::vector<double> volumes_, stars_, undersides_;  // by vertex
    std::vector<Level> levels_;                         // by vertex
    std::vector<double> inflow_;                        // two by vertex: scratch of a sweep
    std::vector<std::uint64_t> unwatched_;
    std::vector<std::int32_t> rim_;  // vertices that spill
    std::vector<std::int64_t> wide_, wideInflow_;
    std::vector<std::int32_t> first_, second_, third_;  // by facet
    std::vector<double> squared_, mixed_, squaredAcross_, start_, sliding_;
    std::vector<std::uint64_t> bare_;
    std::vector<std::int32_t> slidBare_;                  // of the last slide()
    std::vector<std::int32_t> from_, to_, left_, right_;  // by edge
    std::vector<double> leftWeights_, rightWeights_, fluxes_;
    std::vector<std::uint8_t> heldFacets_, heldEdges_;  // by kHeldTogether of them
    bool heldKnown_ = true;                             // those are up to date
};

}  // namespace sand::tin
