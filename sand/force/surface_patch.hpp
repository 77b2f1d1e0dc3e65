// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "sand/force/dual.hpp"
#include "sand/force/facets.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/probe_point.hpp"
#include "sand/model/rules.hpp"
#include "sand/model/surface.hpp"

namespace sand::force {

/// Copy of the sand around the tool, small enough to hand to a force thread after every step.
///
/// It reaches four tool radii and at least eight cells from its centre, but not beyond the field. The hand can
/// therefore move on for a step. On a height field, the patch holds every cell if a side has at most kMostCells.
/// Otherwise it holds every second, third … cell, counted from the field's corner, so that a moving hand feels the same
/// cells. On a TIN, it holds the triangles (Facets). If there are more than Facets::kMost, it holds the heights at the
/// middles of nominal cells, at most kMostHeights on a side.
///
/// Heights are in [scene unit]. Positions are in [scene unit] from the field's south-west corner. Many threads may
/// read.
class SurfacePatch {
public:
    static constexpr int kMostCells = 1024;  // most samples on a side for a height field
    static constexpr int kMostHeights =
        96;  // most on a side for a TIN, where a height costs a walk through its triangles

    SurfacePatch() = default;
    SurfacePatch(const HeightField& field, ProbePoint probe, double toolRadius /* [scene unit] */);
    /// Takes the triangles of a TIN with nominal cells of `cellSize`. The patch is empty if there are too many.
    SurfacePatch(const tin::SurfaceView& tin, double cellSize, ProbePoint probe, double toolRadius);
    /// Takes the sand around `probe` that the tool of `rules` can reach. The field has nominal cells of `cellSize`.
    /// Reuses the memory of the patch.
    void take(const Surface& surface, const Rules& rules, double cellSize /* [scene unit] */, const ProbePoint& probe);

    /// Returns whether (x, y) lies over the field.
    [[nodiscard]] bool overField(double x, double y) const {
        return x >= 0 && y >= 0 && x <= fieldWidth_ && y <= fieldHeight_;
    }
    /// Returns the height at (x, y) [scene unit]: linear within a TIN's triangles, bilinear between the centres of
    /// cells. Beyond the patch, returns the height of the nearest place in it.
    [[nodiscard]] double height(double x, double y) const { return tangent(x, y).value; }
    /// Returns the height at (x, y) with its gradient, which is 0 across an edge of the patch.
    [[nodiscard]] Dual tangent(double x, double y) const {
        return facets_.empty() ? sampledTangent(x, y) : facets_.tangent(x, y);
    }
    [[nodiscard]] bool empty() const { return columns_ == 0 && facets_.empty(); }
    /// Returns how far outside the outline of a tool with an upright side the middle of its cut is [scene unit]. On
    /// cells it is 0: the outline may be anywhere in the cut, which is one cell thick, and is on average in its middle.
    /// On a TIN, the outline is the foot of the cut, which is as thick as the distance between points.
    [[nodiscard]] double cutBeyond() const { return cutBeyond_; }
    /// Returns the triangles of a TIN; empty if heights are sampled.
    [[nodiscard]] const Facets& facets() const { return facets_; }

private:
    /// Cells to sample: their number, their size, and how many a side of the patch may have.
    struct Cells {
        int columns, rows;
        double size;  // [scene unit]
        int most;
    };
    /// Samples the heights that `heightOf(column, row)` returns [unit].
    template <class HeightOf>
    void sample(const Cells& cells, ProbePoint probe, double toolRadius, HeightOf heightOf);

    void takeCells(const HeightField& field, ProbePoint probe, double toolRadius);
    bool takeFacets(const tin::SurfaceView& tin, double cellSize, ProbePoint probe, double toolRadius);
    [[nodiscard]] Dual sampledTangent(double x, double y) const;

    Facets facets_;
    int columns_ = 0, rows_ = 0;
    double west_ = 0, south_ = 0;  // position of node (0,0) [scene unit]
    double spacing_ = 1;
    double cutBeyond_ = 0;
    double fieldWidth_ = -1, fieldHeight_ = -1;
    std::vector<float> heights_;  // row by row from the south-west
};

}  // namespace sand::force
