// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sand/model/rules.hpp"
#include "shapes/model/box.hpp"
#include "shapes/model/sand_rim.hpp"
#include "shapes/model/solid_vertex.hpp"

namespace shapes {

/// Box around the sand: its cut sides down to a floor and, with a closed rim, four wooden boards.
///
/// All lengths are in scene units. Used by one thread.
class SandBox {
public:
    /// Makes a box around sand whose lowest place is at `lowest` [scene unit] and whose cells have the side `cellSize`
    /// [scene unit].
    SandBox(const SandRim& cut, float lowest, double cellSize, sand::Rim rim);

    /// Makes the sides again from `cut`, the current edge of the sand.
    void update(const SandRim& cut) { makeSides(cut); }
    /// Returns whether a box lies over the sand, at least two cells from all cuts. Returns false for any box if the
    /// field has holes.
    [[nodiscard]] bool insideRim(const Box& box) const;
    /// Returns `box`, extended by all places whose look depends on its contents. A side is lit at its upper and lower
    /// ends, so that it changes from top to bottom. The floor around a field without boards is visible.
    [[nodiscard]] Box withSides(const Box& box) const;
    /// Returns the lowest height at which a shadow beyond the rim can be seen.
    [[nodiscard]] double lowest() const { return bounds_.low.z; }
    /// Returns the largest height that the boards, or the sand at the rim, have ever had.
    [[nodiscard]] double highest() const { return bounds_.high.z; }

    /// Part of the sides that is drawn with one call.
    struct Run {
        int firstVertex, vertices;
        Box box;
    };
    [[nodiscard]] const std::vector<SolidVertex>& sides() const { return sides_; }
    [[nodiscard]] const std::vector<Run>& runs() const { return runs_; }
    [[nodiscard]] const std::vector<SolidVertex>& boards() const { return boards_; }

private:
    void makeSides(const SandRim& cut);
    void makeBoards(const SandRim& cut, sand::Rim rim);

    Box bounds_;                                   // of the whole box, and of all sand that has ever been at the rim
    double cellSize_ = 0, width_ = 0, depth_ = 0;  // of the field [scene unit]
    bool hasHoles_ = false;
    float floor_ = 0;  // [scene unit]
    float top_ = 0;    // upper edge of the boards [scene unit]
    std::vector<SolidVertex> sides_, boards_;
    std::vector<Run> runs_;
};

}  // namespace shapes
