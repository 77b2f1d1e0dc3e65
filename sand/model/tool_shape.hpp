// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

#include "base/code_path.hpp"
#include "base/names.hpp"
#include "sand/model/heading.hpp"
#include "sand/model/height_field.hpp"

namespace sand {

/// Kind of a tool. The underside of a flat tool is level.
enum class ToolKind : std::uint8_t {
    sphere,
    circle,     // flat
    rectangle,  // flat
    ellipse,    // flat
    ellipsoid,
    footprint  // sole of a bare right foot
};
/// The names are those of scene files and operator commands.
constexpr auto valuesOf(ToolKind) {
    using enum ToolKind;
    return std::array{base::Named{sphere, "sphere"},       base::Named{circle, "circle"},
                      base::Named{rectangle, "rectangle"}, base::Named{ellipse, "ellipse"},
                      base::Named{ellipsoid, "ellipsoid"}, base::Named{footprint, "footprint"}};
}
inline constexpr int kToolKinds = static_cast<int>(valuesOf(ToolKind{}).size());

/// Returns whether the tool is a sphere or a circle. A round tool ignores width and heading.
[[nodiscard]] constexpr bool isRound(ToolKind kind) { return kind == ToolKind::sphere || kind == ToolKind::circle; }
/// Returns the default ratio of width to length.
[[nodiscard]] constexpr double usualWidth(ToolKind kind) {
    return isRound(kind) ? 1.0 : kind == ToolKind::footprint ? 0.4 : 0.5;
}

/// Kind and size of a tool, without its position and heading.
///
/// The lowest point of every tool is `radius` below its centre. A flat tool is a stamp whose underside is that far
/// below its centre.
struct ToolShape {
    ToolKind kind = ToolKind::sphere;
    std::int32_t radius = 0;     // half of the length [probe unit]
    std::int32_t halfWidth = 0;  // half of the width, at most the radius [probe unit]; 0 for a round tool
    friend bool operator==(const ToolShape&, const ToolShape&) = default;
};

/// Horizontal offset of a cell's centre from the tool's centre [probe unit].
struct Offset {
    std::int64_t x, y;
    [[nodiscard]] std::int64_t squared() const { return x * x + y * y; }
};

/// Part of the sole of a foot: an ellipse with a bowl below it.
struct SolePiece {
    /// Position of the middle: along the heading [half length of the tool], and to the left [half width of the tool].
    double along, across;
    double halfLength, halfWidth;  // [half length of the tool], [half width of the tool]
    double lift;                   // height of the bowl's lowest point over the tool's lowest point [radius]
    double bulge;                  // height of the bowl's rim over the bowl's lowest point [radius]
};
/// Returns heel, outer side, ball and toes of a right foot whose toes point along its heading. The foot is this
/// project's own drawing.
[[nodiscard]] std::span<const SolePiece> solePieces();

/// A tool with its heading: the cells below it, the cells beside it, and the height of its underside.
///
/// The arithmetic uses only integers and IEEE sums, products, quotients and square roots, so that every machine gets
/// the same results. Turning a tool by a right angle turns its results exactly; mirroring it mirrors them exactly.
class TurnedShape {
public:
    /// Underside of a place that is not below the tool.
    static constexpr std::int32_t kFree = std::numeric_limits<std::int32_t>::max();

    /// The results are the same with every `path`.
    explicit TurnedShape(const ToolShape& shape, const Heading& heading = {},
                         base::CodePath path = base::fastestCodePath());

    /// Returns the height of the underside over a place [unit] while the tool's centre is at height `z` [probe unit].
    /// Returns kFree if the place is not below the tool.
    [[nodiscard]] std::int32_t underside(std::int32_t z, const Offset& offset) const {
        if (!isRound(shape_.kind)) {
            return longUnderside(z, offset);
        }
        const std::int64_t height = std::int64_t{shape_.radius} * shape_.radius - offset.squared();
        if (height <= 0) {
            return kFree;
        }
        if (shape_.kind == ToolKind::circle) {
            return lowered(z, static_cast<double>(shape_.radius));
        }
        // IEEE square root of an exact integer: one right answer everywhere.
        return lowered(z, std::sqrt(static_cast<double>(height)));
    }
    /// Fills `row` with the undersides over cells of one row, from west to east. `first` is the first cell's offset.
    void undersides(std::int32_t z, const Offset& first, std::span<std::int32_t> row) const;
    /// Returns whether a place is below the tool.
    [[nodiscard]] bool covers(const Offset& offset) const {
        return isRound(shape_.kind) ? offset.squared() < std::int64_t{shape_.radius} * shape_.radius
                                    : longUnderside(0, offset) != kFree;
    }
    /// Returns whether a place beside the tool takes sand, given that covers() is false there. A place takes sand
    /// within two cells of a sphere's outline. Around other tools the distance is larger by an eighth of the tool's
    /// width, because large stamps would otherwise pile up a wall around them. A place between two toes takes no sand.
    [[nodiscard]] bool takes(const Offset& offset) const {
        const std::int64_t outer = shape_.radius + ring_;
        return isRound(shape_.kind) ? offset.squared() <= outer * outer : longTakes(offset);
    }
    /// Returns the weight with which a place beside the tool receives the sand that a drag along `ahead` pushes away.
    /// It is proportional to the cosine of the angle between `ahead` and the outline's normal at the place. For a round
    /// tool it also grows with the distance from the centre. It is 0 or less for places that are not ahead.
    [[nodiscard]] std::int64_t share(const Offset& offset, const Offset& ahead /* [probe unit] */) const {
        // The product stays below 2^32: `ahead` is at most two cells long, and the ring is at most 2^20 away.
        return isRound(shape_.kind) ? offset.x * ahead.x + offset.y * ahead.y : longShare(offset, ahead);
    }
    /// Returns whether place `a` comes before place `b` in an order that turns with the tool. The order is from back to
    /// front along the heading, then from right to left. A mirrored tool reverses right and left. Call it only if
    /// hasHeading(); places around a round tool are ordered by rows instead.
    [[nodiscard]] bool before(const Offset& a, const Offset& b) const;
    [[nodiscard]] bool hasHeading() const { return !isRound(shape_.kind); }

    /// Returns a rectangle that contains all cells within `margin` of a tool whose centre is at (x, y) [probe unit]. It
    /// may contain further cells.
    [[nodiscard]] CellRect cellsAround(std::int64_t x, std::int64_t y, std::int64_t margin /* [probe unit] */) const;
    /// Returns a rectangle that contains all cells that take sand while the tool's centre is at (x, y) [probe unit].
    [[nodiscard]] CellRect cellsThatTake(std::int64_t x, std::int64_t y) const {
        // Growing a rectangle by the ring on all sides moves its corners outwards by the ring times the root of two.
        return cellsAround(x, y, isRound(shape_.kind) ? ring_ : ring_ * 3 / 2);
    }
    /// Returns a rectangle that contains all cells that the tool may change while its centre is at (x, y) [probe unit].
    /// For a round tool, each side is at least one cell farther out than that of cellsThatTake(). For other tools, both
    /// rectangles are equal.
    [[nodiscard]] CellRect cellsChanged(std::int64_t x, std::int64_t y) const {
        return cellsAround(x, y, ring_ * 3 / 2);
    }

private:
    static constexpr std::int64_t kRing = 2 * kProbePerCell;  // width of the ring around a sphere [probe unit]
    static constexpr std::int32_t kUnitsPerProbe = kUnitsPerCell / kProbePerCell;

    /// Place in the tool's own axes: along the heading and to the left of it. A mirrored tool's axes are mirrored.
    struct Place {
        double along, across;  // [probe unit]
    };
    /// Place in the tool's own axes, as exact integers.
    struct WholePlace {
        std::int64_t along, across;  // [probe unit / Heading::kLength]
    };
    [[nodiscard]] WholePlace turnedBack(const Offset& offset) const {
        const std::int64_t across = offset.y * heading_.x - offset.x * heading_.y;
        return {offset.x * heading_.x + offset.y * heading_.y, heading_.mirrored ? -across : across};
    }
    [[nodiscard]] Place placeOf(const Offset& offset) const {
        const WholePlace whole = turnedBack(offset);  // exact as doubles, because it stays below 2^53
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
    [[nodiscard]] Place normalAt(const Place& place) const;
    /// Returns 1 on the outline of `piece` after growing it by `grown` [probe unit] on all sides, less inside, and more
    /// outside.
    [[nodiscard]] double levelOf(const SolePiece& piece, const Place& place, double grown) const;
    [[nodiscard]] std::span<const SolePiece> pieces() const;

    ToolShape shape_;
    Heading heading_;
    base::CodePath path_;
    double length_, width_;      // half length and half width [probe unit]
    std::int64_t ring_;          // distance from the outline within which places take sand [probe unit]
    double scale_;               // 1 / length of the heading vector
    std::int64_t east_, north_;  // distance that the tool reaches from its centre [probe unit]
};

}  // namespace sand
