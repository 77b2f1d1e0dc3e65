// SPDX-License-Identifier: Apache-2.0
#include "render_node/grid/changed_parts.hpp"

namespace render_node {
namespace {

constexpr int kSmallestSide = 32;  // [cell], side of a square

}  // namespace

std::vector<sand::CellRect> changedParts(std::span<const shapes::GridVertices::Overwritten> overwritten) {
    sand::CellRect all;
    for (const auto& [cells, before] : overwritten) {
        all = all.joinedWith(cells);
    }
    // The squares begin at a corner of a block, so that each block lies in one square.
    all.x0 -= all.x0 % shapes::GridVertices::kBlock;
    all.y0 -= all.y0 % shapes::GridVertices::kBlock;
    int side = kSmallestSide;
    const auto squaresOf = [&side](int first, int end) { return (end - first + side - 1) / side; };
    while (squaresOf(all.x0, all.x1) * squaresOf(all.y0, all.y1) > kMostChangedParts) {
        side *= 2;
    }
    const int across = squaresOf(all.x0, all.x1), down = squaresOf(all.y0, all.y1);
    std::vector<sand::CellRect> parts(static_cast<std::size_t>(across) * static_cast<std::size_t>(down));
    for (const auto& [cells, before] : overwritten) {
        const int square = (cells.y0 - all.y0) / side * across + (cells.x0 - all.x0) / side;
        sand::CellRect& part = parts[static_cast<std::size_t>(square)];
        part = part.joinedWith(cells);
    }
    std::erase_if(parts, [](const sand::CellRect& part) { return part.empty(); });
    return parts;
}

}  // namespace render_node
