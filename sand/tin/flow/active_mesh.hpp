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

/// The part of a mesh that sweeps change: vertices, facets and edges, each numbered from 0, in contiguous memory.
///
/// Volumes and fluxes are whole numbers. While the largest star times the greatest height is below 2^51, they and all
/// their sums are exact as doubles. Processors compute four doubles at a time. Beyond 2^51, they are 64-bit integers,
/// with the same result. Not thread-safe.
class ActiveMesh {
public:
    static constexpr double kFree = 0x1p40;  // underside without an obstacle, above all sand [unit]

    /// With `wide`, uses integers from the start, for tests.
    explicit ActiveMesh(base::CodePath path = base::fastestCodePath(), bool wide = false)
        : path_(path), alwaysWide_(wide) {}

    /// Adds a vertex and returns its number. `spills`: whether it is on an open rim, where each sweep lets all sand
    /// above height 0 fall. `moving`: whether sand flowed there in the last sweep.
    std::int32_t addVertex(std::int64_t volume, std::int64_t star, double underside = kFree, bool spills = false,
                           bool moving = false);
    /// Adds a facet and returns its number. Its corners are numbers of vertices here.
    std::int32_t addFacet(const Facet& facet);
    /// Adds an edge. Its ends and facets are numbers of vertices and facets here.
    void addEdge(const Edge& edge);

    [[nodiscard]] std::size_t vertexCount() const { return stars_.size(); }
    [[nodiscard]] std::size_t facetCount() const { return first_.size(); }
    [[nodiscard]] std::size_t edgeCount() const { return from_.size(); }
    [[nodiscard]] std::int64_t volume(std::size_t vertex) const {
        return isWide_ ? wide_[vertex] : static_cast<std::int64_t>(volumes_[vertex]);
    }
    [[nodiscard]] Facet facet(std::int32_t number) const;  // corners only
    [[nodiscard]] Edge edge(std::size_t number) const;     // ends and facets only

    /// Forgets how strongly facets slid, so that no momentum continues. Call place() for each vertex before the next
    /// sweep.
    void restart();
    void place(std::size_t vertex, std::int64_t volume, std::int64_t star, double underside, bool moving = false);
    /// Sets whether all facets around a vertex are here. A new vertex is not watched.
    void setWatched(std::size_t vertex, bool watched) { unwatched_[vertex] = watched ? 0 : ~std::uint64_t{0}; }
    [[nodiscard]] bool isWatched(std::size_t vertex) const { return unwatched_[vertex] == 0; }

    /// Sets whether a facet lacks some of its edges here. A new facet does.
    void setBare(std::size_t facet, bool bare) { bare_[facet] = bare ? ~std::uint64_t{0} : 0; }

    /// Does the first half of a sweep: computes how strongly facets slide, from facet `first` on. The facets before it
    /// must be known. `held`: whether undersides limit the sand. `band`: whether a facet at rest needs a steeper slope
    /// to start than a sliding one needs to continue. `momentum`: the share of how strongly a facet slid that
    /// continues, 0 to 1. Call it once with `first` 0 before each move().
    ///
    /// Returns the facets that slide but lack edges, over which sand may flow in move(). The span is valid until the
    /// next call.
    [[nodiscard]] std::span<const std::int32_t> slide(bool held, bool band, double momentum, std::size_t first = 0);
    /// Does the second half of a sweep: computes the fluxes over the edges and moves the sand.
    SweepResult move(bool held);
    /// Returns whether sand flowed at one of the vertex's edges in the last sweep.
    [[nodiscard]] bool flowed(std::size_t vertex) const { return levels_[vertex].flow > 0; }
    /// Returns the number of vertices at which no sand flowed in the last sweep.
    [[nodiscard]] std::int64_t restingCount() const;
    /// One mark per facet and per edge, 0 or 1.
    struct Marks {
        std::vector<std::uint8_t> facets, edges;
    };
    /// Marks the facets at which sand flowed, because they may slide in the next sweep. Marks the edges of the facets
    /// that slid.
    [[nodiscard]] Marks whatMayFlow() const;
    /// Adds the unwatched vertices at which sand flowed to `found`.
    void findUnwatched(std::vector<std::int32_t>& found) const;

    /// New numbers of vertices and facets after keep(); kNoNumber stands for a vertex or facet that is gone.
    struct Renumbering {
        std::vector<std::int32_t> vertices, facets;
    };
    /// Keeps the marked facets and edges, with the facets and vertices that they need, in the same order. Returns
    /// their new numbers.
    Renumbering keep(const Marks& kept);

private:
    void notice(std::int64_t volume, std::int64_t star);
    void widen();
    [[nodiscard]] bool isHeld(std::int32_t vertex) const {
        return undersides_[static_cast<std::size_t>(vertex)] < kFree;
    }
    void findHeld();
    SweepResult moveWide();

    base::CodePath path_;
    bool alwaysWide_;
    bool isWide_ = alwaysWide_;
    double largestStar_ = 0, greatestHeight_ = 0;
    std::vector<double> volumes_, stars_, undersides_;  // by vertex
    std::vector<Level> levels_;                         // by vertex
    std::vector<double> inflow_;                        // two per vertex; scratch memory of a sweep
    std::vector<std::uint64_t> unwatched_;
    std::vector<std::int32_t> rim_;  // vertices that spill
    std::vector<std::int64_t> wide_, wideInflow_;
    std::vector<std::int32_t> first_, second_, third_;  // by facet
    std::vector<double> squared_, mixed_, squaredAcross_, start_, sliding_, slid_, goesOn_;
    std::vector<std::uint64_t> bare_;
    std::vector<std::int32_t> slidBare_;                  // result of slide()
    std::vector<std::int32_t> from_, to_, left_, right_;  // by edge
    std::vector<double> leftWeights_, rightWeights_, fluxes_;
    std::vector<std::uint8_t> heldFacets_, heldEdges_;  // one per kHeldTogether facets or edges
    bool heldKnown_ = true;                             // whether heldFacets_ and heldEdges_ are up to date
};

}  // namespace sand::tin
