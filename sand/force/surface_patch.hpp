// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "sand/force/dual.hpp"
#include "sand/height_field.hpp"
#include "sand/step.hpp"
#include "sand/terrain.hpp"

namespace sand::force {

/// A copy of the sand around the tool, small enough to be handed to a force thread after every step.
///
/// It reaches four tool radii and at least eight cells from its centre, so that the hand may go on for a step; a
/// large tool's patch takes every second or third cell. A TIN is sampled at its nominal cells' middles. Heights are
/// [scene unit], positions [scene unit] from the field's south-west corner.
class SurfacePatch {
public:
    static constexpr int kMaxSideNodes = 96;

    SurfacePatch() = default;
    SurfacePatch(const HeightField& field, ProbePoint centre, double toolRadius /* [scene unit] */);
    /// Around the tool.
    explicit SurfacePatch(const Terrain& terrain);

    /// Whether (x, y) lies over the field.
    [[nodiscard]] bool overField(double x, double y) const {
        return x >= 0 && y >= 0 && x <= fieldWidth_ && y <= fieldHeight_;
    }
    /// Bilinear between the centres of cells; beyond the patch, its nearest node.
    [[nodiscard]] double height(double x, double y) const { return tangent(x, y).value; }
    /// The same with its gradient, which is 0 across an edge of the patch.
    [[nodiscard]] Dual tangent(double x, double y) const;
    [[nodiscard]] bool empty() const { return columns_ == 0; }

private:
    /// Of a field of so many cells of this size; `heightOf(column, row)` is [unit].
    template <class HeightOf>
    void sample(int columns, int rows, double cell, ProbePoint centre, double toolRadius, HeightOf heightOf);

    int columns_ = 0, rows_ = 0;
    double west_ = 0, south_ = 0;  // of node (0,0)
    double spacing_ = 1;
    double fieldWidth_ = -1, fieldHeight_ = -1;
    std::array<float, kMaxSideNodes * kMaxSideNodes> heights_;
};

}  // namespace sand::force
