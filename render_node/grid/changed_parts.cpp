// SPDX-License-Identifier: Apache-2.0
#include "render_node/grid/changed_parts.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace render_node {
namespace {

using Overwritten = shapes::GridVertices::Overwritten;

constexpr int kSmallestSide = 5;  // side of a square [cell], as a power of two
constexpr shapes::HeightRange kNone{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};

/// Division of the changed area into equal squares.
class Squares {
public:
    explicit Squares(std::span<const Overwritten> overwritten) {
        for (const auto& [cells, before] : overwritten) {
            area_ = area_.joinedWith(cells);
        }
        // The squares begin at a corner of a block, so that each block lies in one square.
        area_.x0 -= area_.x0 % shapes::GridVertices::kBlock;
        area_.y0 -= area_.y0 % shapes::GridVertices::kBlock;
        while (across() * down() > kMostChangedParts) {
            ++side_;
        }
    }

    [[nodiscard]] int across() const { return columnOf(area_.x1 - 1) + 1; }
    [[nodiscard]] int down() const { return rowOf(area_.y1 - 1) + 1; }
    /// Calls visit(number of the square) for each square that holds some of these cells.
    template <class Visit>
    void forEachWith(const sand::CellRect& cells, const Visit& visit) const {
        const sand::CellRect within = cells.clippedTo(area_);
        for (int y = rowOf(within.y0); y <= rowOf(within.y1 - 1); ++y) {
            for (int x = columnOf(within.x0); x <= columnOf(within.x1 - 1); ++x) {
                visit(static_cast<std::size_t>(y * across() + x));
            }
        }
    }

private:
    // A shift, because this is asked several times for each block, and a division takes much longer.
    [[nodiscard]] int columnOf(int x) const { return (x - area_.x0) >> side_; }
    [[nodiscard]] int rowOf(int y) const { return (y - area_.y0) >> side_; }

    sand::CellRect area_;
    int side_ = kSmallestSide;
};

}  // namespace

std::vector<ChangedPart> changedParts(std::span<const Overwritten> overwritten, int reach) {
    const Squares squares(overwritten);
    std::vector<ChangedPart> parts(static_cast<std::size_t>(squares.across() * squares.down()), {{}, kNone});
    for (const auto& [cells, before] : overwritten) {
        squares.forEachWith(cells, [&, &changed = cells](std::size_t square) {
            parts[square].cells = parts[square].cells.joinedWith(changed);
        });
    }
    for (const auto& [cells, before] : overwritten) {
        squares.forEachWith(cells.grownBy(reach), [&, &changed = cells, &heights = before](std::size_t square) {
            ChangedPart& part = parts[square];
            if (!part.cells.grownBy(reach).clippedTo(changed).empty()) {
                part.before = shapes::around(part.before, heights);
            }
        });
    }
    std::erase_if(parts, [](const ChangedPart& part) { return part.cells.empty(); });
    return parts;
}

}  // namespace render_node
