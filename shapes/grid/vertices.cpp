// SPDX-License-Identifier: Apache-2.0
#include "shapes/grid/vertices.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "shapes/model/grain.hpp"

namespace shapes {
namespace {

constexpr int kLanes = GridVertices::kBlock;
constexpr float kFarAbove = std::numeric_limits<float>::infinity();
constexpr float kFarBelow = -std::numeric_limits<float>::infinity();

}  // namespace

/// Lowest and highest of many heights, kept separately for each lane of a vector.
class GridVertices::RangeByLanes {
public:
    RangeByLanes() {
        lowest_.fill(kFarAbove);
        highest_.fill(kFarBelow);
    }
    void add(std::size_t lane, float height) { add(lane, height, height); }
    void add(std::size_t lane, float low, float high) {
        lowest_[lane] = low < lowest_[lane] ? low : lowest_[lane];
        highest_[lane] = high > highest_[lane] ? high : highest_[lane];
    }
    [[nodiscard]] HeightRange range() const {
        return {*std::min_element(lowest_.begin(), lowest_.end()), *std::max_element(highest_.begin(), highest_.end())};
    }
    [[nodiscard]] HeightRange ofLastLane() const { return {lowest_.back(), highest_.back()}; }

private:
    std::array<float, kLanes> lowest_{}, highest_{};
};

/// Comparison, conversion and copying of a block's heights, row by row.
class GridVertices::BlockWalk {
public:
    /// Copies a row of `cells` heights, at most kLanes, starting in the west.
    template <class Count>
    void takeRow(const std::int32_t* from, float* drawn, Count cells, double unit, int row) {
        std::uint32_t differs = 0;
        for (std::size_t lane = 0; lane < cells; ++lane) {
            const float now = static_cast<float>(from[lane] * unit);
            const float before = drawn[lane];
            const std::uint32_t other = now != before ? 1 : 0;
            differs |= other;
            columns_[lane] |= other;
            float lowest = kFarAbove, highest = kFarBelow;
            if (other != 0) {
                lowest = highest = before;
            }
            before_.add(lane, lowest, highest);
            now_.add(lane, now);
            drawn[lane] = now;
        }
        if (differs != 0) {
            rows_ = {rows_.first < 0 ? row : rows_.first, row + 1};
        }
    }
    [[nodiscard]] bool differs() const { return rows_.first >= 0; }
    [[nodiscard]] HeightRange now() const { return now_.range(); }
    [[nodiscard]] HeightRange lastColumn() const { return now_.ofLastLane(); }
    /// Returns the cells that differed, in a block whose first column is `column`.
    [[nodiscard]] Overwritten overwritten(int column) const {
        const auto other = [](std::uint32_t lane) { return lane != 0; };
        const auto first = std::find_if(columns_.begin(), columns_.end(), other) - columns_.begin();
        const auto end = std::find_if(columns_.rbegin(), columns_.rend(), other).base() - columns_.begin();
        return {{column + static_cast<int>(first), rows_.first, column + static_cast<int>(end), rows_.second},
                before_.range()};
    }

private:
    std::array<std::uint32_t, kLanes> columns_{};  // whether a height of this column differed
    std::pair<int, int> rows_{-1, -1};             // first row with a difference, and the row after the last one
    RangeByLanes before_, now_;
};

GridVertices::GridVertices(const sand::HeightField& field, const sand::Ground* ground)
    : columns_(field.columns()),
      rows_(field.rows()),
      cellSize_(static_cast<float>(field.cellSize())),
      blocksAcross_(blocksFor(columns_)),
      heights_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)),
      ranges_(static_cast<std::size_t>(blocksAcross_) * static_cast<std::size_t>(blocksFor(rows_))),
      lastColumns_(ranges_.size()) {
    std::vector<Overwritten> all;
    takeOver(field, field.bounds(), all);
    for (int row = 0; row < rows_ && ground != nullptr; ++row) {
        for (int column = 0; column < columns_; ++column) {
            if (ground->isWall(column, row)) {
                holes_.resize(heights_.size());
                holes_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                       static_cast<std::size_t>(column)] = 1;
            }
        }
    }
}

std::size_t GridVertices::blockAt(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(blocksAcross_) + static_cast<std::size_t>(x);
}

void GridVertices::takeOver(const sand::HeightField& field, const sand::CellRect& cells,
                            std::vector<Overwritten>& overwritten) {
    for (int y = cells.y0 / kBlock; y * kBlock < cells.y1; ++y) {
        for (int x = cells.x0 / kBlock; x * kBlock < cells.x1; ++x) {
            takeOverBlock(field, x, y, overwritten);
        }
    }
}

void GridVertices::takeOverBlock(const sand::HeightField& field, int blockX, int blockY,
                                 std::vector<Overwritten>& overwritten) {
    const sand::CellRect cells =
        sand::CellRect{blockX * kBlock, blockY * kBlock, (blockX + 1) * kBlock, (blockY + 1) * kBlock}.clippedTo(
            field.bounds());
    const double unit = field.unit();
    BlockWalk walk;
    for (int row = cells.y0; row < cells.y1; ++row) {
        float* drawn = &heights_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                                 static_cast<std::size_t>(cells.x0)];
        if (cells.x1 - cells.x0 == kLanes) {  // a constant number of cells lets the compiler use vectors
            walk.takeRow(field.row(row) + cells.x0, drawn, std::integral_constant<std::size_t, kLanes>(), unit, row);
        } else {
            walk.takeRow(field.row(row) + cells.x0, drawn, static_cast<std::size_t>(cells.x1 - cells.x0), unit, row);
        }
    }
    placesRead_ += std::int64_t{cells.x1 - cells.x0} * (cells.y1 - cells.y0);
    if (walk.differs()) {
        ranges_[blockAt(blockX, blockY)] = walk.now();
        lastColumns_[blockAt(blockX, blockY)] = walk.lastColumn();
        overwritten.push_back(walk.overwritten(cells.x0));
    }
}

sand::CellRect GridVertices::cellsUnder(const sand::CellRect& vertices) const {
    return {std::clamp(vertices.x0 - 1, 0, columns_ - 1), std::clamp(vertices.y0 - 1, 0, rows_ - 1),
            std::clamp(vertices.x1 - 2, 0, columns_ - 1) + 1, std::clamp(vertices.y1 - 2, 0, rows_ - 1) + 1};
}

HeightRange GridVertices::heights(const sand::CellRect& cells) const {
    const auto endBlock = [](int end, int all) { return end == all ? blocksFor(end) : end / kBlock; };
    const sand::CellRect blocks{blocksFor(cells.x0), blocksFor(cells.y0), endBlock(cells.x1, columns_),
                                endBlock(cells.y1, rows_)};
    RangeByLanes around;
    if (blocks.empty()) {
        add(cells, around);
        return around.range();
    }
    // Uses the ranges of blocks that lie within `cells`, and reads the rest on the four sides cell by cell.
    const sand::CellRect within =
        sand::CellRect{blocks.x0 * kBlock, blocks.y0 * kBlock, blocks.x1 * kBlock, blocks.y1 * kBlock}.clippedTo(cells);
    add({cells.x0, cells.y0, cells.x1, within.y0}, around);
    add({cells.x0, within.y1, cells.x1, cells.y1}, around);
    const bool oneColumn = within.x0 - cells.x0 == 1;
    add({cells.x0, within.y0, oneColumn ? cells.x0 : within.x0, within.y1}, around);
    add({within.x1, within.y0, cells.x1, within.y1}, around);
    HeightRange found = around.range();
    for (int y = blocks.y0; y < blocks.y1; ++y) {
        if (oneColumn) {
            found = shapes::around(found, lastColumns_[blockAt(blocks.x0 - 1, y)]);
        }
        for (int x = blocks.x0; x < blocks.x1; ++x) {
            found = shapes::around(found, ranges_[blockAt(x, y)]);
        }
    }
    placesRead_ += std::int64_t{blocks.x1 - blocks.x0 + (oneColumn ? 1 : 0)} * (blocks.y1 - blocks.y0);
    return found;
}

void GridVertices::add(const sand::CellRect& cells, RangeByLanes& range) const {
    if (cells.empty()) {
        return;
    }
    for (int row = cells.y0; row < cells.y1; ++row) {
        const float* heights = heights_.data() + static_cast<std::ptrdiff_t>(row) * columns_;
        int column = cells.x0;
        for (; column + kLanes <= cells.x1; column += kLanes) {
            for (std::size_t lane = 0; lane < kLanes; ++lane) {
                range.add(lane, heights[static_cast<std::size_t>(column) + lane]);
            }
        }
        for (; column < cells.x1; ++column) {
            range.add(0, heights[column]);
        }
    }
    placesRead_ += std::int64_t{cells.x1 - cells.x0} * (cells.y1 - cells.y0);
}

float GridVertices::height(int column, int row) const {
    const auto x = static_cast<std::size_t>(std::clamp(column, 0, columns_ - 1));
    const auto y = static_cast<std::size_t>(std::clamp(row, 0, rows_ - 1));
    return heights_[y * static_cast<std::size_t>(columns_) + x];
}

float GridVertices::along(int vertex, int cells) const {
    return std::clamp(static_cast<float>(vertex) - 0.5F, 0.0F, static_cast<float>(cells)) * cellSize_;
}

glm::vec2 GridVertices::slope(int vertexColumn, int vertexRow) const {
    const int x = std::clamp(vertexColumn - 1, 0, columns_ - 1);
    const int y = std::clamp(vertexRow - 1, 0, rows_ - 1);
    if (holes_.empty() && x > 0 && x + 1 < columns_ && y > 0 && y + 1 < rows_) {  // most vertices
        const float* under = heights_.data() + static_cast<std::ptrdiff_t>(y) * columns_ + x;
        return glm::vec2(under[1] - under[-1], under[columns_] - under[-columns_]) / (2 * cellSize_);
    }
    // The slope at the rim is one-sided. A field of one column has slope 0 across it.
    const auto rise = [this](float low, float high, int cells) {
        return cells == 0 ? 0.0F : (high - low) / (static_cast<float>(cells) * cellSize_);
    };
    int west = std::max(x - 1, 0);
    int east = std::min(x + 1, columns_ - 1);
    int south = std::max(y - 1, 0);
    int north = std::min(y + 1, rows_ - 1);
    if (!holes_.empty()) {  // the slope is one-sided beside a hole, too
        west = isHole(west, y) ? x : west;
        east = isHole(east, y) ? x : east;
        south = isHole(x, south) ? y : south;
        north = isHole(x, north) ? y : north;
    }
    return {rise(height(west, y), height(east, y), east - west),
            rise(height(x, south), height(x, north), north - south)};
}

float GridVertices::mottling(int column, int row) const {
    const int x = std::clamp(column - 1, 0, columns_ - 1);
    const int y = std::clamp(row - 1, 0, rows_ - 1);
    return static_cast<float>(mottlingAt(x, y)) / 255;
}

GridVertex GridVertices::vertex(int column, int row) const {
    const int x = std::clamp(column - 1, 0, columns_ - 1);
    const int y = std::clamp(row - 1, 0, rows_ - 1);
    const float here = height(x, y);
    float open = 0;
    const std::span<float> one(&open, 1);
    if (x >= kReach && x + kReach < columns_ && y >= kReach && y + kReach < rows_) {
        const float* under = heights_.data() + static_cast<std::ptrdiff_t>(y) * columns_ + x;
        openSky(one, cellSize_, [under, here, columns = std::ptrdiff_t{columns_}](std::size_t, int east, int north) {
            return under[north * columns + east] - here;
        });
    } else {
        openSky(one, cellSize_, [&](std::size_t, int east, int north) { return height(x + east, y + north) - here; });
    }
    return vertexUnder(open, column, row);
}

void GridVertices::vertices(int firstColumn, int row, std::span<GridVertex> out) const {
    const int last = firstColumn + static_cast<int>(out.size()) - 1;
    const bool inside = row - 1 >= kReach && row - 1 + kReach < rows_;
    // Places whose whole reach lies within the field need no clamping.
    const int from = inside ? std::clamp(1 + kReach, firstColumn, last + 1) : last + 1;
    const int end = inside ? std::clamp(columns_ + 1 - kReach, from, last + 1) : last + 1;
    constexpr int kAtOnce = 64;
    std::array<float, kAtOnce> open;
    for (int begin = from; begin < end; begin += kAtOnce) {
        const std::span<float> places(open.data(), static_cast<std::size_t>(std::min(kAtOnce, end - begin)));
        const float* here = heights_.data() + static_cast<std::ptrdiff_t>(row - 1) * columns_ + (begin - 1);
        openSky(places, cellSize_, [here, columns = std::ptrdiff_t{columns_}](std::size_t place, int east, int north) {
            return here[static_cast<std::ptrdiff_t>(place) + north * columns + east] - here[place];
        });
        for (std::size_t place = 0; place < places.size(); ++place) {
            const int column = begin + static_cast<int>(place);
            out[static_cast<std::size_t>(column - firstColumn)] = vertexUnder(places[place], column, row);
        }
    }
    for (int column = firstColumn; column <= last; ++column) {
        if (column < from || column >= end) {
            out[static_cast<std::size_t>(column - firstColumn)] = vertex(column, row);
        }
    }
}

std::vector<GridVertex> GridVertices::verticesIn(const sand::CellRect& part) const {
    const auto across = static_cast<std::size_t>(part.x1 - part.x0), down = static_cast<std::size_t>(part.y1 - part.y0);
    std::vector<GridVertex> all(across * down);
    for (std::size_t row = 0; row < down; ++row) {
        vertices(part.x0, part.y0 + static_cast<int>(row), std::span(all).subspan(row * across, across));
    }
    return all;
}

GridVertex GridVertices::vertexUnder(float open, int column, int row) const {
    const int x = std::clamp(column - 1, 0, columns_ - 1);
    const int y = std::clamp(row - 1, 0, rows_ - 1);
    const glm::vec2 steep = slope(column, row);
    const float scale = 32767 / std::sqrt(1 + steep.x * steep.x + steep.y * steep.y);
    GridVertex vertex{};
    vertex.height = height(x, y);
    vertex.column = static_cast<std::uint16_t>(2 * std::min(column, columns_ + 1));
    vertex.row = static_cast<std::uint16_t>(2 * std::min(row, rows_ + 1));
    vertex.normalEast = static_cast<std::int16_t>(-steep.x * scale);
    vertex.normalNorth = static_cast<std::int16_t>(-steep.y * scale);
    vertex.open = static_cast<std::uint16_t>(open * 65535);
    vertex.mottling = static_cast<std::uint16_t>(mottlingAt(x, y) * 257);
    return vertex;
}

}  // namespace shapes
