// SPDX-License-Identifier: Apache-2.0
#include "render_node/grid/vertices.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "render_node/gl/grain_texture.hpp"

namespace render_node {

SandSurface::SandSurface(const sand::HeightField& field)
    : columns_(field.columns()),
      rows_(field.rows()),
      cellSize_(static_cast<float>(field.cellSize())),
      heights_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {
    update(field, field.bounds());
}

void SandSurface::update(const sand::HeightField& field, const sand::CellRect& cells) {
    const double unit = field.unit();
    for (int row = cells.y0; row < cells.y1; ++row) {
        const std::int32_t* from = field.row(row);
        float* to = heights_.data() + static_cast<std::ptrdiff_t>(row) * columns_;
        for (int column = cells.x0; column < cells.x1; ++column) {
            to[column] = static_cast<float>(from[column] * unit);
        }
    }
}

sand::CellRect SandSurface::differing(const sand::HeightField& field, const sand::CellRect& cells) const {
    const double unit = field.unit();
    sand::CellRect found{cells.x1, cells.y1, cells.x0, cells.y0};
    for (int row = cells.y0; row < cells.y1; ++row) {
        const std::int32_t* now = field.row(row);
        const float* drawn = heights_.data() + static_cast<std::ptrdiff_t>(row) * columns_;
        const auto same = [&](int column) { return drawn[column] == static_cast<float>(now[column] * unit); };
        int first = cells.x0;
        while (first < cells.x1 && same(first)) {
            ++first;
        }
        if (first == cells.x1) {
            continue;
        }
        int end = cells.x1;
        while (same(end - 1)) {
            --end;
        }
        found = {std::min(found.x0, first), std::min(found.y0, row), std::max(found.x1, end), row + 1};
    }
    return found.empty() ? sand::CellRect{} : found;
}

HeightRange SandSurface::heights(const sand::CellRect& vertices) const {
    const int west = std::clamp(vertices.x0 - 1, 0, columns_ - 1);
    const int east = std::clamp(vertices.x1 - 2, 0, columns_ - 1);
    const int south = std::clamp(vertices.y0 - 1, 0, rows_ - 1);
    const int north = std::clamp(vertices.y1 - 2, 0, rows_ - 1);
    // By lanes, which become vectors: every change asks for the heights around it.
    constexpr int kLanes = 8;
    std::array<float, kLanes> lowest{}, highest{};
    lowest.fill(height(west, south));
    highest = lowest;
    const auto add = [&](std::size_t lane, float height) {
        lowest[lane] = height < lowest[lane] ? height : lowest[lane];
        highest[lane] = height > highest[lane] ? height : highest[lane];
    };
    for (int row = south; row <= north; ++row) {
        const float* heights = heights_.data() + static_cast<std::ptrdiff_t>(row) * columns_;
        int column = west;
        for (; column + kLanes <= east + 1; column += kLanes) {
            for (std::size_t lane = 0; lane < kLanes; ++lane) {
                add(lane, heights[static_cast<std::size_t>(column) + lane]);
            }
        }
        for (; column <= east; ++column) {
            add(0, heights[column]);
        }
    }
    return {*std::ranges::min_element(lowest), *std::ranges::max_element(highest)};
}

float SandSurface::height(int column, int row) const {
    const auto x = static_cast<std::size_t>(std::clamp(column, 0, columns_ - 1));
    const auto y = static_cast<std::size_t>(std::clamp(row, 0, rows_ - 1));
    return heights_[y * static_cast<std::size_t>(columns_) + x];
}

SandRim SandSurface::rim() const {
    SandRim rim;
    const auto add = [&](std::size_t side, int column, int row) {
        rim.sides[side].emplace_back(east(column), north(row), height(column - 1, row - 1));
    };
    for (int column = 0; column <= columns_ + 1; ++column) {
        add(0, column, 0);
        add(2, columns_ + 1 - column, rows_ + 1);
    }
    for (int row = 0; row <= rows_ + 1; ++row) {
        add(1, columns_ + 1, row);
        add(3, 0, rows_ + 1 - row);
    }
    return rim;
}

float SandSurface::along(int vertex, int cells) const {
    return std::clamp(static_cast<float>(vertex) - 0.5F, 0.0F, static_cast<float>(cells)) * cellSize_;
}

glm::vec2 SandSurface::slope(int vertexColumn, int vertexRow) const {
    const int x = std::clamp(vertexColumn - 1, 0, columns_ - 1);
    const int y = std::clamp(vertexRow - 1, 0, rows_ - 1);
    // One-sided at the rim; a field of one column is level across.
    const auto rise = [this](float low, float high, int cells) {
        return cells == 0 ? 0.0F : (high - low) / (static_cast<float>(cells) * cellSize_);
    };
    const int west = std::max(x - 1, 0);
    const int east = std::min(x + 1, columns_ - 1);
    const int south = std::max(y - 1, 0);
    const int north = std::min(y + 1, rows_ - 1);
    return {rise(height(west, y), height(east, y), east - west),
            rise(height(x, south), height(x, north), north - south)};
}

float SandSurface::mottling(int column, int row) const {
    const int x = std::clamp(column - 1, 0, columns_ - 1);
    const int y = std::clamp(row - 1, 0, rows_ - 1);
    return static_cast<float>(mottlingAt(x, y)) / 255;
}

SandVertex SandSurface::vertex(int column, int row) const {
    const int x = std::clamp(column - 1, 0, columns_ - 1);
    const int y = std::clamp(row - 1, 0, rows_ - 1);
    const float here = height(x, y);
    float open = 0;
    openSky({&open, 1}, cellSize_,
            [&](std::size_t, int east, int north) { return height(x + east, y + north) - here; });
    return vertexUnder(open, column, row);
}

void SandSurface::vertices(int firstColumn, int row, std::span<SandVertex> out) const {
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

SandVertex SandSurface::vertexUnder(float open, int column, int row) const {
    const int x = std::clamp(column - 1, 0, columns_ - 1);
    const int y = std::clamp(row - 1, 0, rows_ - 1);
    const glm::vec2 steep = slope(column, row);
    const float scale = 32767 / std::sqrt(1 + steep.x * steep.x + steep.y * steep.y);
    SandVertex vertex{};
    vertex.height = height(x, y);
    vertex.column = static_cast<std::uint16_t>(std::min(column, columns_ + 1));
    vertex.row = static_cast<std::uint16_t>(std::min(row, rows_ + 1));
    vertex.normalEast = static_cast<std::int16_t>(-steep.x * scale);
    vertex.normalNorth = static_cast<std::int16_t>(-steep.y * scale);
    vertex.open = static_cast<std::uint16_t>(open * 65535);
    vertex.mottling = static_cast<std::uint16_t>(mottlingAt(x, y) * 257);
    return vertex;
}

}  // namespace render_node
