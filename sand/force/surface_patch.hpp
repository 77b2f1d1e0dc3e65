// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "sand/force/dual.hpp"
#include "sand/force/facets.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/step.hpp"
#include "sand/replica.hpp"

namespace sand::force {

/// A copy of the sand around the tool, small enough to be handed to a force thread after every step.
///
/// It reaches four tool radii and at least eight cells from its centre, so that the hand may go on for a step, and no
/// farther than the field. It takes every cell while a side has at most kMostCells of them, then every second, third
/// and so on, counted from the field's corner, so that a hand that moves feels the same cells. Of a TIN it takes the
/// triangles (Facets). Where these are more than Facets::kMost, it takes the height at the nominal cells' middles, of
/// which a side has at most kMostHeights. Heights are [scene unit], positions [scene unit] from the field's south-west
/// corner. Many threads may read.
class SurfacePatch {
public:
    static constexpr int kMostCells = 1024;  // on a side of a height field's patch
    static constexpr int kMostHeights = 96;  // on a side of a TIN's: a height costs a walk through its triangles

    SurfacePatch() = default;
    SurfacePatch(const HeightField& field, ProbePoint centre, double toolRadius /* [scene unit] */);
    /// The triangles of a TIN of such nominal cells; empty where these are too many.
    SurfacePatch(const tin::SurfaceView& tin, double cellSize, ProbePoint centre, double toolRadius);
    /// Around the tool.
    explicit SurfacePatch(const Replica& terrain) { take(terrain, terrain.probe()); }
    /// Takes the sand around `centre` that the replica's tool can reach. Reuses the memory of the patch.
    void take(const Replica& terrain, const ProbePoint& centre);

    /// Whether (x, y) lies over the field.
    [[nodiscard]] bool overField(double x, double y) const {
        return x >= 0 && y >= 0 && x <= fieldWidth_ && y <= fieldHeight_;
    }
    /// Linear over a TIN's triangles, bilinear between the centres of cells; beyond the patch, its nearest place.
    [[nodiscard]] double height(double x, double y) const { return tangent(x, y).value; }
    /// The same with its gradient, which is 0 across an edge of the patch.
    [[nodiscard]] Dual tangent(double x, double y) const {
        return facets_.empty() ? sampledTangent(x, y) : facets_.tangent(x, y);
    }
    [[nodiscard]] bool empty() const { return columns_ == 0 && facets_.empty(); }
    /// Where the sand stands that a tool with an upright side has cut [scene unit]: so far outside of its outline. On
    /// cells the outline lies anywhere in the cut, which is a cell thick, in its middle on the average. On a TIN it is
    /// the foot, and the cut is as thick as points lie apart.
    [[nodiscard]] double cutBeyond() const { return cutBeyond_; }
    /// The triangles of a TIN; none where heights are sampled.
    [[nodiscard]] const Facets& facets() const { return facets_; }

private:
    /// What is sampled: so many cells of this size, at most `most` of them on a side of the patch.
    struct Cells {
        int columns, rows;
        double size;  // [scene unit]
        int most;
    };
    /// `heightOf(column, row)` is [unit].
    template <class HeightOf>
    void sample(const Cells& cells, ProbePoint centre, double toolRadius, HeightOf heightOf);

    void takeCells(const HeightField& field, ProbePoint centre, double toolRadius);
    bool takeFacets(const tin::SurfaceView& tin, double cellSize, ProbePoint centre, double toolRadius);
    [[nodiscard]] Dual sampledTangent(double x, double y) const;

    Facets facets_;
    int columns_ = 0, rows_ = 0;
    double west_ = 0, south_ = 0;  // of node (0,0)
    double spacing_ = 1;
    double cutBeyond_ = 0;
    double fieldWidth_ = -1, fieldHeight_ = -1;
    std::vector<float> heights_;  // row by row from the south-west
};

}  // namespace sand::force
