// SPDX-License-Identifier: Apache-2.0
#include "shapes/grid/hole_edges.hpp"

#include <algorithm>

namespace shapes {
namespace {

bool areOpposite(const std::array<bool, 4>& ground) {
    return ground[0] == ground[2] && ground[1] == ground[3] && ground[0] != ground[1];
}

}  // namespace

float cornerHeight(const std::array<float, 4>& heights, const std::array<bool, 4>& ground, std::size_t own) {
    if (areOpposite(ground)) {
        return heights[own];
    }
    float sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < heights.size(); ++i) {
        sum += ground[i] ? heights[i] : 0;
        count += ground[i] ? 1 : 0;
    }
    return sum / static_cast<float>(count);
}

HoleEdges::HoleEdges(const GridVertices& surface, const sand::CellRect& vertices)
    : vertices_(vertices), columns_(surface.columns()), rows_(surface.rows()) {
    blocks_ = blocksOf(vertices.x1 - vertices.x0 - 1, vertices.y1 - vertices.y0 - 1);
    for (TriangleBlock& block : blocks_) {
        block.first = static_cast<int>(indices_.size());
        for (int y = block.quads.y0; y < block.quads.y1; ++y) {
            for (int x = block.quads.x0; x < block.quads.x1; ++x) {
                addQuad(surface, x, y);
            }
        }
        block.count = static_cast<int>(indices_.size()) - block.first;
    }
}

void HoleEdges::addQuad(const GridVertices& surface, int x, int y) {
    const int across = vertices_.x1 - vertices_.x0;
    const auto at = [&](int east, int north) { return static_cast<std::uint32_t>((y + north) * across + x + east); };
    const auto isGround = [&](int east, int north) {  // cell c lies under vertex c + 1
        return !surface.isHole(vertices_.x0 + x + east - 1, vertices_.y0 + y + north - 1);
    };
    const std::array<std::uint32_t, 4> corners{at(0, 0), at(1, 0), at(1, 1), at(0, 1)};
    const std::array<bool, 4> ground{isGround(0, 0), isGround(1, 0), isGround(1, 1), isGround(0, 1)};
    if (std::count(ground.begin(), ground.end(), true) == 4) {
        // The diagonals alternate as in all other chunks.
        const std::size_t first = (x + y) % 2 == 0 ? 0 : 1;
        triangle(corners[0], corners[1], corners[first == 0 ? 2 : 3]);
        triangle(corners[first], corners[2], corners[3]);
    } else if (areOpposite(ground)) {
        for (std::size_t i = 0; i < ground.size(); ++i) {
            std::array<bool, 4> alone{};
            alone[i] = ground[i];
            if (ground[i]) {
                addPiece(corners, alone);
            }
        }
    } else if (std::count(ground.begin(), ground.end(), true) > 0) {
        addPiece(corners, ground);
    }
}

/// The piece is a fan around the middle of the quad. Sides between two cells with ground stay whole, because the quad
/// beyond such a side has no vertex on it.
void HoleEdges::addPiece(const std::array<std::uint32_t, 4>& corners, const std::array<bool, 4>& ground) {
    const auto mean = [&](const std::array<bool, 4>& places, const std::array<bool, 4>& sources) {
        Added vertex;
        int column = 0, row = 0, count = 0;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            if (places[i]) {
                column += placeOf(corners[i], 0);
                row += placeOf(corners[i], 1);
                ++count;
            }
            if (sources[i]) {
                vertex.from.at(vertex.count++) = corners[i];
            }
        }
        vertex.column = static_cast<std::uint16_t>(column / count);
        vertex.row = static_cast<std::uint16_t>(row / count);
        return add(vertex);
    };
    const std::uint32_t middle = mean({true, true, true, true}, ground);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const std::size_t next = (i + 1) % corners.size();
        std::array<bool, 4> side{};
        side[i] = side[next] = true;
        std::array<bool, 4> end{};
        end[ground[i] ? i : next] = true;
        if (ground[i] && ground[next]) {
            triangle(middle, corners[i], corners[next]);
        } else if (ground[i]) {
            triangle(middle, corners[i], mean(side, end));
        } else if (ground[next]) {
            triangle(middle, mean(side, end), corners[next]);
        }
    }
}

/// Returns the place of a vertex of the chunk's grid along an axis [half a cell].
int HoleEdges::placeOf(std::uint32_t corner, int axis) const {
    const int across = vertices_.x1 - vertices_.x0, number = static_cast<int>(corner);
    return axis == 0 ? 2 * std::min(vertices_.x0 + number % across, columns_ + 1)
                     : 2 * std::min(vertices_.y0 + number / across, rows_ + 1);
}

std::uint32_t HoleEdges::add(const Added& vertex) {
    added_.push_back(vertex);
    const int grid = (vertices_.x1 - vertices_.x0) * (vertices_.y1 - vertices_.y0);
    return static_cast<std::uint32_t>(grid + static_cast<int>(added_.size()) - 1);
}

void HoleEdges::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    indices_.insert(indices_.end(), {a, b, c});
}

std::vector<GridVertex> HoleEdges::added(std::span<const GridVertex> grid) const {
    std::vector<GridVertex> all;
    all.reserve(added_.size());
    for (const Added& wanted : added_) {
        std::array<int, 4> sums{};  // normal east and north, open sky, mottling
        float height = 0;
        for (std::size_t i = 0; i < wanted.count; ++i) {
            const GridVertex& from = grid[wanted.from.at(i)];
            height += from.height;
            sums = {sums[0] + from.normalEast, sums[1] + from.normalNorth, sums[2] + from.open,
                    sums[3] + from.mottling};
        }
        const int count = wanted.count;
        all.push_back({height / static_cast<float>(count), wanted.column, wanted.row,
                       static_cast<std::int16_t>(sums[0] / count), static_cast<std::int16_t>(sums[1] / count),
                       static_cast<std::uint16_t>(sums[2] / count), static_cast<std::uint16_t>(sums[3] / count)});
    }
    return all;
}

}  // namespace shapes
