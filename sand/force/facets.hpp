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

/// Copy of the triangles of a TIN around the tool. The force thread reads heights from the copy while the mesh itself
/// changes.
///
/// A place is found by walking from a triangle near it. The place is first rounded to 2^-16 of a cell, so that all
/// signs are exact. A place on an edge or a vertex belongs to exactly one triangle. The result therefore depends only
/// on the mesh and the place. Within a triangle, the error of the height is at most the slope, summed over both axes,
/// times 2^-17 of a cell.
///
/// Only take() allocates memory. Many threads may read.
class Facets {
public:
    static constexpr std::size_t kMost = 4096;  // most triangles; with more, a query and a copy would take too long
    static_assert(kMost < 32768);               // a facet's number has 16 bits

    /// Copies all triangles that reach into the square that extends `reach` > 0 to each side of `probe`.
    /// `unit` is the size of a probe unit [scene unit]. A hole becomes flat, as wall cells of a grid do. Its height is
    /// that of the lowest corner, among these triangles, that is on ground. Returns false, and holds no triangle, if
    /// there are more than kMost.
    bool take(const tin::SurfaceView& tin, const ProbePoint& probe, std::int32_t reach, double unit);
    void clear() {
        facets_.clear();
        planes_.clear();
    }
    [[nodiscard]] bool empty() const { return facets_.empty(); }
    [[nodiscard]] std::size_t size() const { return facets_.size(); }

    /// Returns the height at (x, y) [scene unit] and its gradient. Outside the square, returns the height of the
    /// nearest place in it; the gradient across its side is then 0. Requires that empty() is false.
    [[nodiscard]] Dual tangent(double x, double y /* [scene unit] */) const;

private:
    /// Place relative to the middle of the square [part]. A part is 2^-8 of a probe unit.
    struct Spot {
        std::int64_t x, y;
    };
    /// Triangle in the form that walks need: how far a place lies inside the edge opposite each corner.
    struct alignas(64) Facet {
        std::array<std::int64_t, 3> atMiddle;            // less one if another triangle owns the edge
        std::array<std::int32_t, 3> towardsX, towardsY;  // change per part
        std::array<std::int16_t, 3>
            beyond;  // facets beyond the edges; -1 if that triangle does not reach into the square

        /// Returns three numbers. None of them is negative if the place belongs to this triangle.
        [[nodiscard]] std::array<std::int64_t, 3> within(const Spot& spot) const;
    };
    /// Plane of a triangle: height at the middle of the square [scene unit], and slope per part.
    struct Plane {
        double height, east, north;
    };
    /// Hash table with open addressing, from a triangle's slot to the number of its facet.
    class Index {
    public:
        void clear();
        /// Returns the number of `slot`. If `slot` has none yet, stores `number` for it and returns that.
        std::int32_t put(std::int32_t slot, std::int32_t number);
        [[nodiscard]] std::int32_t find(std::int32_t slot) const;  // -1 if `slot` has no number

    private:
        [[nodiscard]] std::size_t placeOf(std::int32_t slot) const;
        std::vector<std::pair<std::int32_t, std::int32_t>> places_;  // slot and number; slot -1: free
        std::size_t count_ = 0;
    };

    bool findSlots(const tin::Triangles& mesh, const tin::LatticePoint& middle);
    void add(const tin::SurfaceView& tin, std::int32_t slot, const tin::LatticePoint& middle);
    void levelHoles(const tin::SurfaceView& tin);
    void findStarts();
    [[nodiscard]] std::size_t startOf(double x, double y) const;
    [[nodiscard]] std::int32_t find(const Spot& spot, std::int32_t start) const;

    std::vector<Facet> facets_;
    std::vector<Plane> planes_;        // one per facet
    std::vector<std::int32_t> slots_;  // slot of each facet's triangle
    Index index_;
    std::array<std::int32_t, 4> square_{};  // sides of the square in the mesh: west, south, east, north [probe unit]
    double middleX_ = 0, middleY_ = 0;      // middle of the square [part]
    double west_ = 0, south_ = 0, east_ = 0, north_ = 0;  // sides of the square, from the middle [part]
    double unit_ = 1;                                     // size of a probe unit [scene unit]
    double partsPerSceneUnit_ = 1;
    // Starts of walks: the facet in the middle of each field of a lattice over the square. From there a place is hardly
    // a step away. Walks to many places do not depend on each other.
    static constexpr std::size_t kMostStarts = 46;  // on a side; about half of kMost in total
    std::array<std::int16_t, kMostStarts * kMostStarts> starts_{};
    std::size_t startsPerSide_ = 0;
    double columnsPer_ = 0, rowsPer_ = 0;  // fields of the lattice per part
};

}  // namespace sand::force
