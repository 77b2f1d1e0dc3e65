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
#include "sand/model/heading.hpp"
#include "sand/model/height_field.hpp"

namespace sand {

enum class ToolKind : std::uint8_t {
    sphere,
    circle,     // flat, as are the next two
    rectangle,  //
    ellipse,    //
    ellipsoid,
    footprint  // of a bare right foot
};
inline constexpr int kToolKinds = 6;

/// As scene files and operators write it.
[[nodiscard]] std::string_view toolName(ToolKind kind);
/// Nothing for a name that no kind has.
[[nodiscard]] std::optional<ToolKind> toolNamed(std::string_view name);
/// Spheres and circles: neither width nor heading changes what they do.
[[nodiscard]] constexpr bool isRound(ToolKind kind) { return kind == ToolKind::sphere || kind == ToolKind::circle; }
/// Width over length, where nobody says another one.
[[nodiscard]] constexpr double usualWidth(ToolKind kind) {
    return isRound(kind) ? 1.0 : kind == ToolKind::footprint ? 0.4 : 0.5;
}

/// A tool but for where it is and which way it is turned. Its lowest point lies `radius` below its centre, whatever its
/// kind: flat tools are stamps that somebody holds there.
struct ToolShape {
    ToolKind kind = ToolKind::sphere;
    std::int32_t radius = 0;     // [probe unit], half of the length
    std::int32_t halfWidth = 0;  // [probe unit], at most the radius; 0 for what is round
    friend bool operator==(const ToolShape&, const ToolShape&) = default;
};

/// Horizontal offset of a cell's centre from the tool's [probe unit].
struct Offset {
    std::int64_t x, y;
    [[nodiscard]] std::int64_t squared() const { return x * x + y * y; }
};

/// A part of the sole of a foot: an ellipse, and a bowl below it.
struct SolePiece {
    double along, across;          // of its middle [half length, half width of the tool]; across: to the left
    double halfLength, halfWidth;  // likewise
    double lift;                   // of the bowl's lowest point over the tool's [radius]
    double bulge;                  // by which the bowl's rim is higher still [radius]
};
/// Heel, outer side, ball and toes: our own drawing of a right foot, whose toes point along its heading.
[[nodiscard]] std::span<const SolePiece> solePieces();

/// A tool as it is turned now: which cells lie below it and beside it, and how high its underside is.
///
/// All arithmetic is on integers and on IEEE sums, products, quotients and roots: the same on every machine. A tool
/// that is turned by a right angle, or mirrored, does exactly what it did, turned or mirrored.
class TurnedShape {
public:
    static constexpr std::int32_t kFree = std::numeric_limits<std::int32_t>::max();

    /// `v3`: with instructions of x86-64-v3, for the same results.
    explicit TurnedShape(const ToolShape& shape, const Heading& heading = {}, bool v3 = base::machineHasV3());

    /// Height of the underside over a place while the centre is at height `z` [probe unit]: [unit], or kFree beside the
    /// tool.
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
    /// The same of cells side by side, a cell apart from `first` on, as many as there is room for.
    void undersides(std::int32_t z, const Offset& first, std::span<std::int32_t> row) const;
    /// Whether a place is below the tool.
    [[nodiscard]] bool covers(const Offset& offset) const {
        return isRound(shape_.kind) ? offset.squared() < std::int64_t{shape_.radius} * shape_.radius
                                    : longUnderside(0, offset) != kFree;
    }
    /// Whether a place beside the tool takes sand: within two cells of a sphere's outline, and of any other's within an
    /// eighth of its width more, or large stamps would pile a wall around them; but not squeezed in between two toes.
    [[nodiscard]] bool takes(const Offset& offset) const {
        const std::int64_t outer = shape_.radius + ring_;
        return isRound(shape_.kind) ? offset.squared() <= outer * outer : longTakes(offset);
    }
    /// How much of the sand that a drag pushes away goes to a place beside the tool: by the cosine of the outline's
    /// normal to the drag. 0 or less for places that are not ahead.
    [[nodiscard]] std::int64_t share(const Offset& offset, const Offset& ahead /* [probe unit] */) const {
        // The drag is at most two cells and the ring at most 2^20 away: the product stays below 2^32.
        return isRound(shape_.kind) ? offset.x * ahead.x + offset.y * ahead.y : longShare(offset, ahead);
    }
    /// The order of places around a tool that has a heading, which turns with it. Round ones go by rows.
    [[nodiscard]] bool before(const Offset& a, const Offset& b) const;
    [[nodiscard]] bool hasHeading() const { return !isRound(shape_.kind); }

    /// The cells that lie below a tool with its centre there, and so many around them; others may be among them.
    [[nodiscard]] CellRect cellsAround(std::int64_t x, std::int64_t y, std::int64_t margin /* [probe unit] */) const;
    /// The same with all that take sand.
    [[nodiscard]] CellRect cellsThatTake(std::int64_t x, std::int64_t y) const {
        // A corner that grows to both sides comes farther out by the root of two.
        return cellsAround(x, y, isRound(shape_.kind) ? ring_ : ring_ * 3 / 2);
    }
    /// The same, and a cell more.
    [[nodiscard]] CellRect cellsChanged(std::int64_t x, std::int64_t y) const {
        return cellsAround(x, y, ring_ * 3 / 2);
    }

private:
    static constexpr std::int64_t kRing = 2 * kProbePerCell;  // [probe unit]
    static constexpr std::int32_t kUnitsPerProbe = kUnitsPerCell / kProbePerCell;

    /// A place in the tool's own axes: along its heading, and to its left.
    struct Place {
        double along, across;  // [probe unit]
    };
    struct WholePlace {
        std::int64_t along, across;  // [probe unit / Heading::kLength]
    };
    [[nodiscard]] WholePlace turnedBack(const Offset& offset) const {
        const std::int64_t across = offset.y * heading_.x - offset.x * heading_.y;
        return {offset.x * heading_.x + offset.y * heading_.y, heading_.mirrored ? -across : across};
    }
    [[nodiscard]] Place placeOf(const Offset& offset) const {
        const WholePlace whole = turnedBack(offset);  // below 2^53: exact
        return {scale_ * static_cast<double>(whole.along), scale_ * static_cast<double>(whole.across)};
    }
    [[nodiscard]] static std::int32_t lowered(std::int32_t z, double below /* [probe unit] */) {
        const auto under = std::int64_t{z} * kUnitsPerProbe - static_cast<std::int64_t>(below * kUnitsPerProbe);
        return static_cast<std::int32_t>(std::clamp<std::int64_t>(under, -kMaxHeight, kMaxHeight));
    }
    // The same of what is not round.
    [[nodiscard]] std::int32_t longUnderside(std::int32_t z, const Offset& offset) const;
    [[nodiscard]] bool longTakes(const Offset& offset) const;
    [[nodiscard]] std::int64_t longShare(const Offset& offset, const Offset& ahead) const;
    [[nodiscard]] Place normalAt(const Place& place) const;
    /// 1 on the outline of a part of the tool that was grown on all sides; less within.
    [[nodiscard]] double levelOf(const SolePiece& piece, const Place& place, double grown) const;
    [[nodiscard]] std::span<const SolePiece> pieces() const;

    ToolShape shape_;
    Heading heading_;
    bool v3_;
    double length_, width_;      // half of them [probe unit]
    std::int64_t ring_;          // how far from the outline it lays sand down [probe unit]
    double scale_;               // one over the length of the heading
    std::int64_t east_, north_;  // how far it reaches [probe unit]
};

}  // namespace sand
