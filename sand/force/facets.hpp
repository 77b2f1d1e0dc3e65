// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "sand/force/dual.hpp"
#include "sand/model/step.hpp"
#include "sand/tin/geometry/surface_view.hpp"

namespace sand::force {

/// The triangles of a TIN around the tool: a copy, which whoever feels asks for heights while the mesh itself changes.
///
/// A place is found by walking from a triangle near it. It is rounded to 2^-16 of a cell first, so that all signs
/// are exact, and a place on an edge or a vertex belongs to one triangle: what is found is a function of the mesh and
/// the place alone. Within a triangle the height is off by at most the slope, summed over both axes, times 2^-17 of a
/// cell.
///
/// Asks for no memory but in take(); many threads may read.
class Facets {
public:
    static constexpr std::size_t kMost = 4096;  // of more, a query and a copy would take too long
    static_assert(kMost < 32768);               // 16 bits tell one

    /// All triangles that reach into the square of `reach` > 0 [probe unit] around a place; false, and none, when these
    /// are more than kMost. `unit` [scene unit] is a probe unit's. Holes are felt as a grid's walls are: as flats, as
    /// low as the lowest of these triangles' corners on ground.
    bool take(const tin::SurfaceView& tin, const ProbePoint& centre, std::int32_t reach, double unit);
    void clear() {
        facets_.clear();
        planes_.clear();
    }
    [[nodiscard]] bool empty() const { return facets_.empty(); }
    [[nodiscard]] std::size_t size() const { return facets_.size(); }

    /// Height there [scene unit] and its gradient; beyond the square the nearest place's, flat across its side. Not of
    /// none.
    [[nodiscard]] Dual tangent(double x, double y /* [scene unit] */) const;

private:
    /// A place [part] from the middle; a part is 2^-8 of a probe unit.
    struct Spot {
        std::int64_t x, y;
    };
    /// A triangle as walks see it: by how far a place lies within the edge opposite each corner.
    struct alignas(64) Facet {
        std::array<std::int64_t, 3> atMiddle;            // less one where the edge is not this triangle's
        std::array<std::int32_t, 3> towardsX, towardsY;  // per part
        std::array<std::int16_t, 3> beyond;              // facets; -1: none that reaches into the square

        /// Nowhere negative: the place is this triangle's.
        [[nodiscard]] std::array<std::int64_t, 3> within(const Spot& spot) const;
    };
    /// Its height in the middle [scene unit], and per part.
    struct Plane {
        double height, east, north;
    };
    /// Which facet a triangle has become, by open addressing.
    class Index {
    public:
        void clear();
        /// The number put in with the slot before; `number`, and it is put in, when there is none.
        std::int32_t put(std::int32_t slot, std::int32_t number);
        [[nodiscard]] std::int32_t find(std::int32_t slot) const;  // -1: none

    private:
        [[nodiscard]] std::size_t placeOf(std::int32_t slot) const;
        std::vector<std::pair<std::int32_t, std::int32_t>> places_;  // slot and number; -1: free
        std::size_t count_ = 0;
    };

    bool findSlots(const tin::Triangles& mesh, const tin::Place& middle);
    void add(const tin::SurfaceView& tin, std::int32_t slot, const tin::Place& middle);
    void levelHoles(const tin::SurfaceView& tin);
    void findStarts();
    [[nodiscard]] std::size_t startOf(double x, double y) const;
    [[nodiscard]] std::int32_t find(const Spot& spot, std::int32_t start) const;

    std::vector<Facet> facets_;
    std::vector<Plane> planes_;        // by facet
    std::vector<std::int32_t> slots_;  // by facet
    Index index_;
    std::array<std::int32_t, 4> square_{};                // of the mesh: west, south, east, north [probe unit]
    double middleX_ = 0, middleY_ = 0;                    // [part]
    double west_ = 0, south_ = 0, east_ = 0, north_ = 0;  // [part] of the square, from the middle
    double unit_ = 1;                                     // [scene unit], of a probe unit
    double partsPerSceneUnit_ = 1;                        // of a scene unit
    // Where walks begin: the facet in the middle of each field of a lattice over the square. From there a place is
    // hardly a step away, and walks to many places do not wait for one another.
    static constexpr std::size_t kMostStarts = 46;  // on a side: half of kMost in all
    std::array<std::int16_t, kMostStarts * kMostStarts> starts_{};
    std::size_t startsPerSide_ = 0;
    double columnsPer_ = 0, rowsPer_ = 0;  // of the lattice, per part
};

}  // namespace sand::force
