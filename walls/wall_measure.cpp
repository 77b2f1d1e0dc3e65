// SPDX-License-Identifier: Apache-2.0
#include "walls/wall_measure.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace walls {
namespace {

constexpr std::array<Edge, 4> kEdges{Edge::left, Edge::right, Edge::bottom, Edge::top};

std::pair<glm::dvec3, glm::dvec3> endsOf(const Screen& s, Edge edge) {
    switch (edge) {
        case Edge::left:
            return {s.lowerLeft, s.upperLeft};
        case Edge::right:
            return {s.lowerRight, s.upperRight()};
        case Edge::bottom:
            return {s.lowerLeft, s.lowerRight};
        case Edge::top:
            break;
    }
    return {s.upperLeft, s.upperRight()};
}

/// Measures the way from one edge to the neighbour's edge. It should be parallel to `along`.
void measure(Gaps& gaps, const std::pair<glm::dvec3, glm::dvec3>& from, const std::pair<glm::dvec3, glm::dvec3>& to,
             glm::dvec3 along) {
    for (const glm::dvec3 way : {to.first - from.first, to.second - from.second}) {
        const double gap = glm::dot(way, along);
        gaps.least = gaps.count == 0 ? gap : std::min(gaps.least, gap);
        gaps.most = gaps.count == 0 ? gap : std::max(gaps.most, gap);
        gaps.aslant = std::max(gaps.aslant, glm::length(way - along * gap));
        ++gaps.count;
    }
}

std::optional<Seam> seamOf(const Tile& first, const Tile& second) {
    std::optional<Seam> best;
    for (const Edge a : kEdges) {
        for (const Edge b : kEdges) {
            const auto [p, q] = endsOf(first.screen, a);
            const auto [r, s] = endsOf(second.screen, b);
            const double apart = std::min(std::max(glm::distance(p, r), glm::distance(q, s)),
                                          std::max(glm::distance(p, s), glm::distance(q, r)));
            if (apart <= kSeam && (!best || apart < best->apart)) {
                const double between = glm::dot(first.screen.normal(), second.screen.normal());
                best = Seam{0, 0, a, b, apart, 180 - glm::degrees(std::acos(std::clamp(between, -1.0, 1.0)))};
            }
        }
    }
    return best;
}

}  // namespace

std::array<Gaps, 2> gapsOf(const Wall& wall) {
    Gaps across, down;
    for (const Tile& tile : wall.tiles) {
        if (tile.row == 0) {
            continue;
        }
        const auto at = [&](int rank) -> const Screen& {
            return wall.tiles[static_cast<std::size_t>(rank - 1)].screen;
        };
        if (tile.column < wall.grid->columns) {
            measure(across, endsOf(tile.screen, Edge::right), endsOf(at(tile.rank + 1), Edge::left),
                    tile.screen.right());
        }
        if (tile.row < wall.grid->rows) {
            measure(down, endsOf(at(tile.rank + wall.grid->columns), Edge::top), endsOf(tile.screen, Edge::bottom),
                    tile.screen.up());
        }
    }
    across.count /= 2;  // both ends of every edge were measured
    down.count /= 2;
    return {across, down};
}

std::string_view edgeName(Edge edge) {
    constexpr std::array<std::string_view, 4> kNames{"left", "right", "lower", "upper"};
    return kNames.at(static_cast<std::size_t>(edge));
}

std::vector<Seam> seamsOf(const Wall& wall) {
    std::vector<Seam> seams;
    for (std::size_t second = 0; second < wall.tiles.size(); ++second) {
        for (std::size_t first = 0; first < second && wall.tiles[second].row == 0; ++first) {
            if (std::optional<Seam> seam = seamOf(wall.tiles[first], wall.tiles[second])) {
                seam->first = first;
                seam->second = second;
                seams.push_back(*seam);
            }
        }
    }
    return seams;
}

}  // namespace walls
