// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "shapes/grid/hole_edges.hpp"
#include "shapes/grid/vertices.hpp"

namespace shapes {
namespace {

/// Direction from a cell to a neighbour, and the corners of the edge between them, from the cell's middle [half a
/// cell]. Seen from above, the cell is on the left of the way from the first corner to the second one.
struct Face {
    int east, north;
    std::array<glm::ivec2, 2> corners;
};
constexpr std::array<Face, 4> kFaces{Face{1, 0, {glm::ivec2{1, -1}, {1, 1}}}, Face{0, 1, {glm::ivec2{1, 1}, {-1, 1}}},
                                     Face{-1, 0, {glm::ivec2{-1, 1}, {-1, -1}}},
                                     Face{0, -1, {glm::ivec2{-1, -1}, {1, -1}}}};

}  // namespace

bool GridVertices::isHole(int column, int row) const {
    if (holes_.empty()) {
        return false;
    }
    const auto x = static_cast<std::size_t>(std::clamp(column, 0, columns_ - 1));
    const auto y = static_cast<std::size_t>(std::clamp(row, 0, rows_ - 1));
    return holes_[y * static_cast<std::size_t>(columns_) + x] != 0;
}

bool GridVertices::hasHole(const sand::CellRect& vertices) const {
    const sand::CellRect cells = cellsUnder(vertices);
    for (int row = cells.y0; row < cells.y1 && !holes_.empty(); ++row) {
        const auto first = holes_.begin() + static_cast<std::ptrdiff_t>(row) * columns_;
        if (std::find(first + cells.x0, first + cells.x1, 1) != first + cells.x1) {
            return true;
        }
    }
    return false;
}

bool GridVertices::touchesRim(const sand::CellRect& cells) const {
    if (cells.empty()) {
        return false;
    }
    const sand::CellRect around{cells.x0, cells.y0, cells.x1 + 2, cells.y1 + 2};  // vertices over and beside the cells
    return cells.x0 <= 0 || cells.y0 <= 0 || cells.x1 >= columns_ || cells.y1 >= rows_ || hasHole(around);
}

SandRim GridVertices::rim() const {
    SandRim rim{{east(columns_ + 1), north(rows_ + 1)}, {}, !holes_.empty()};
    addFieldEdges(rim);
    if (rim.hasHoles) {
        addHoleEdges(rim);
    }
    return rim;
}

/// Adds the four edges of the field, counter-clockwise from the south-west corner. A hole interrupts them.
void GridVertices::addFieldEdges(SandRim& rim) const {
    const std::array<glm::ivec2, 5> corners{
        glm::ivec2{0, 0}, {columns_ + 1, 0}, {columns_ + 1, rows_ + 1}, {0, rows_ + 1}, {0, 0}};
    for (std::size_t side = 0; side < 4; ++side) {
        const glm::ivec2 step = glm::sign(corners.at(side + 1) - corners.at(side));
        std::vector<glm::vec3> line;
        const auto end = [&] {
            if (line.size() > 1) {
                rim.cuts.push_back(std::move(line));
            }
            line.clear();
        };
        for (glm::ivec2 at = corners.at(side);; at += step) {
            const bool last = at == corners.at(side + 1);
            if (isHole(at.x - 1, at.y - 1)) {
                end();
            } else {
                const glm::ivec2 before = at - step, after = at + step;
                const float here = height(at.x - 1, at.y - 1);
                // Between the middles of two cells is the edge between them.
                const auto edge = [&](glm::ivec2 other) {
                    return glm::vec3(0.5F * (east(at.x) + east(other.x)), 0.5F * (north(at.y) + north(other.y)), here);
                };
                if (line.empty() && at != corners.at(side)) {
                    line.push_back(edge(before));
                }
                line.emplace_back(east(at.x), north(at.y), here);
                if (!last && isHole(after.x - 1, after.y - 1)) {
                    line.push_back(edge(after));
                }
            }
            if (last) {
                break;
            }
        }
        end();
    }
}

/// Adds the edges between cells with and without ground. Neighbouring edges follow each other, so that few are drawn if
/// few are seen.
void GridVertices::addHoleEdges(SandRim& rim) const {
    constexpr int kSide = 32;  // [cell], of a square in which all edges follow each other
    for (int y = 0; y < rows_; y += kSide) {
        for (int x = 0; x < columns_; x += kSide) {
            if (!hasHole({x, y, std::min(x + kSide, columns_) + 2, std::min(y + kSide, rows_) + 2})) {
                continue;
            }
            for (int row = y; row < std::min(y + kSide, rows_); ++row) {
                for (int column = x; column < std::min(x + kSide, columns_); ++column) {
                    addEdgesOf(column, row, rim);
                }
            }
        }
    }
}

void GridVertices::addEdgesOf(int column, int row, SandRim& rim) const {
    if (isHole(column, row)) {
        return;
    }
    for (const Face& face : kFaces) {
        if (!isHole(column + face.east, row + face.north)) {
            continue;
        }
        const auto at = [&](glm::ivec2 corner, float z) {
            return glm::vec3((static_cast<float>(column) + 0.5F * static_cast<float>(1 + corner.x)) * cellSize_,
                             (static_cast<float>(row) + 0.5F * static_cast<float>(1 + corner.y)) * cellSize_, z);
        };
        const auto end = [&](glm::ivec2 corner) {
            // Counter-clockwise from the cell that is south-west of the corner.
            const glm::ivec2 low = glm::ivec2(column, row) + (corner - 1) / 2;
            const std::array<glm::ivec2, 4> cells{low, low + glm::ivec2(1, 0), low + 1, low + glm::ivec2(0, 1)};
            std::array<float, 4> heights{};
            std::array<bool, 4> ground{};
            std::size_t own = 0;
            for (std::size_t i = 0; i < cells.size(); ++i) {
                heights.at(i) = height(cells.at(i).x, cells.at(i).y);
                ground.at(i) = !isHole(cells.at(i).x, cells.at(i).y);
                own = cells.at(i) == glm::ivec2(column, row) ? i : own;
            }
            return at(corner, cornerHeight(heights, ground, own));
        };
        rim.cuts.push_back(
            {end(face.corners[0]), at({face.east, face.north}, height(column, row)), end(face.corners[1])});
    }
}

}  // namespace shapes
