// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "base/code_path.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/tool.hpp"

namespace sand {

/// Horizontal offset of a cell's centre from the tool's centre [probe unit].
struct Offset {
    std::int64_t x, y;
    [[nodiscard]] std::int64_t squared() const { return x * x + y * y; }
};

/// Part of a sole: an ellipse with a bowl below it.
struct SolePiece {
    /// Position of the middle: along the heading [half length of the tool], and to the left [half width of the tool].
    double along, across;
    double halfLength, halfWidth;  // [half length of the tool], [half width of the tool]
    double lift;                   // height of the bowl's lowest point over the tool's lowest point [radius]
    double bulge;                  // height of the bowl's rim over the bowl's lowest point [radius]
};
/// Returns the pieces of a sole, or none for a tool of another shape. Those of a footprint are heel, outer side, ball
/// and toes of a right foot whose toes point along its heading. The foot is this project's own drawing.
[[nodiscard]] std::span<const SolePiece> solePieces(ToolKind kind);

/// Shape of a tool with its heading: the cells below it, the cells beside it, and the height of its underside.
///
/// The arithmetic uses only integers and IEEE sums, products, quotients and square roots, so that every machine gets
/// the same results. Turning a tool by a right angle turns its results exactly; mirroring it mirrors them exactly.
class TurnedShape {
public:
    /// Underside of a place that is not below the tool.
    static constexpr std::int32_t kFree = std::numeric_limits<std::int32_t>::max();

    /// Width of the ring around a sphere. A wide ring grows with the sphere from 16 cells on: without it, the first
    /// press of a large sphere would make a wall.
    enum class SphereRing { narrow, wide };

    /// The results are the same with every `path`.
    explicit TurnedShape(const Tool& tool, SphereRing ring = SphereRing::narrow,
                         base::CodePath path = base::fastestCodePath());

    /// Returns the height of the underside over a place [unit] while the tool's centre is at height `z` [probe unit].
    /// Returns kFree if the place is not below the tool.
    [[nodiscard]] std::int32_t underside(std::int32_t z, const Offset& offset) const {
        if (!isRound(tool_.kind)) {
            return longUnderside(z, offset);
        }
        const std::int64_t height = std::int64_t{tool_.radius} * tool_.radius - offset.squared();
        if (height <= 0) {
            return kFree;
        }
        if (tool_.kind == ToolKind::circle) {
            return lowered(z, static_cast<double>(tool_.radius));
        }
        // IEEE square root of an exact integer: one right answer everywhere.
        return lowered(z, std::sqrt(static_cast<double>(height)));
    }
    /// Fills `row` with the undersides over cells of one row, from west to east. `first` is the first cell's offset.
    void undersides(std::int32_t z, const Offset& first, std::span<std::int32_t> row) const;
    /// Returns whether a place is below the tool.
    [[nodiscard]] bool covers(const Offset& offset) const {
        return isRound(tool_.kind) ? offset.squared() < std::int64_t{tool_.radius} * tool_.radius
                                   : longUnderside(0, offset) != kFree;
    }
    /// Returns whether a place beside the tool takes sand, given that covers() is false there. A place takes sand
    /// within two cells of a sphere's outline, and farther out with a wide ring. Around other tools the distance is
    /// larger by an eighth of the tool's width, because large stamps would otherwise pile up a wall around them. A
    /// place between two toes takes no sand.
    [[nodiscard]] bool takes(const Offset& offset) const {
        const std::int64_t outer = tool_.radius + ring_;
        return isRound(tool_.kind) ? offset.squared() <= outer * outer : longTakes(offset);
    }
    /// Returns the weight with which a place beside the tool receives the sand that a drag along `ahead` pushes away.
    /// It is proportional to the cosine of the angle between `ahead` and the outline's normal at the place. For a round
    /// tool it also grows with the distance from the centre. It is 0 or less for places that are not ahead.
    [[nodiscard]] std::int64_t share(const Offset& offset, const Offset& ahead /* [probe unit] */) const {
        // The product stays below 2^32: `ahead` is at most two cells long, and the ring is at most 2^20 away.
        return isRound(tool_.kind) ? offset.x * ahead.x + offset.y * ahead.y : longShare(offset, ahead);
    }
    /// Returns whether place `a` comes before place `b` in an order that turns with the tool. The order is from back to
    /// front along the heading, then from right to left. A mirrored tool reverses right and left. Call it only if
    /// hasHeading(); places around a round tool are ordered by rows instead.
    [[nodiscard]] bool before(const Offset& a, const Offset& b) const;
    /// Returns the distance from the outline within which places take sand, rounded up [cell].
    [[nodiscard]] int ringCells() const { return static_cast<int>((ring_ + kProbePerCell - 1) / kProbePerCell); }
    [[nodiscard]] bool hasHeading() const { return !isRound(tool_.kind); }

    /// Returns a rectangle that contains all cells within `margin` of a tool whose centre is at (x, y) [probe unit]. It
    /// may contain further cells.
    [[nodiscard]] CellRect cellsAround(std::int64_t x, std::int64_t y, std::int64_t margin /* [probe unit] */) const;
    /// Returns a rectangle that contains all cells that take sand while the tool's centre is at (x, y) [probe unit].
    [[nodiscard]] CellRect cellsThatTake(std::int64_t x, std::int64_t y) const {
        // Growing a rectangle by the ring on all sides moves its corners outwards by the ring times the root of two.
        return cellsAround(x, y, isRound(tool_.kind) ? ring_ : ring_ * 3 / 2);
    }
    /// Returns a rectangle that contains all cells that the tool may change while its centre is at (x, y) [probe unit].
    /// For a round tool, each side is at least one cell farther out than that of cellsThatTake(). For other tools, both
    /// rectangles are equal.
    [[nodiscard]] CellRect cellsChanged(std::int64_t x, std::int64_t y) const {
        return cellsAround(x, y, ring_ * 3 / 2);
    }

private:
    static constexpr std::int64_t kRing = 2 * kProbePerCell;  // width of the ring around a sphere [probe unit]

    /// Place in the tool's own axes: along the heading and to the left of it. A mirrored tool's axes are mirrored.
    struct ToolPoint {
        double along, across;  // [probe unit]
    };
    /// Place in the tool's own axes, as exact integers.
    struct WholeToolPoint {
        std::int64_t along, across;  // [probe unit / Heading::kLength]
    };
    [[nodiscard]] WholeToolPoint turnedBack(const Offset& offset) const {
        const std::int64_t across = offset.y * tool_.heading.x - offset.x * tool_.heading.y;
        return {offset.x * tool_.heading.x + offset.y * tool_.heading.y, tool_.heading.mirrored ? -across : across};
    }
    [[nodiscard]] ToolPoint placeOf(const Offset& offset) const {
        const WholeToolPoint whole = turnedBack(offset);  // exact as doubles, because it stays below 2^53
        return {scale_ * static_cast<double>(whole.along), scale_ * static_cast<double>(whole.across)};
    }
    /// Returns the height of a point that is `below` under height `z`, within ±kMaxHeight [unit].
    [[nodiscard]] static std::int32_t lowered(std::int32_t z, double below /* [probe unit] */) {
        const auto under = std::int64_t{z} * kUnitsPerProbe - static_cast<std::int64_t>(below * kUnitsPerProbe);
        return static_cast<std::int32_t>(std::clamp<std::int64_t>(under, -kMaxHeight, kMaxHeight));
    }
    // underside(), takes() and share() for tools that are not round.
    [[nodiscard]] std::int32_t longUnderside(std::int32_t z, const Offset& offset) const;
    [[nodiscard]] bool longTakes(const Offset& offset) const;
    [[nodiscard]] std::int64_t longShare(const Offset& offset, const Offset& ahead) const;
    /// Returns the normal of the outline beside `place`, with any length.
    [[nodiscard]] ToolPoint normalAt(const ToolPoint& place) const;
    /// Returns 1 on the outline of `piece` after growing it by `grown` [probe unit] on all sides, less inside, and more
    /// outside.
    [[nodiscard]] double levelOf(const SolePiece& piece, const ToolPoint& place, double grown) const;
    [[nodiscard]] std::span<const SolePiece> pieces() const;

    Tool tool_;
    base::CodePath path_;
    double length_, width_;      // half length and half width [probe unit]
    std::int64_t ring_;          // distance from the outline within which places take sand [probe unit]
    double scale_;               // 1 / length of the heading vector
    std::int64_t east_, north_;  // distance that the tool reaches from its centre [probe unit]
};

}  // namespace sand
