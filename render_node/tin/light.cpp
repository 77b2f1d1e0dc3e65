// SPDX-License-Identifier: Apache-2.0
// Computes the light on a TIN: normals, mottling, and the visible share of the sky at its vertices.
#include <algorithm>
#include <cmath>
#include <limits>

#include "render_node/gl/grain_texture.hpp"
#include "render_node/surface/open_sky.hpp"
#include "render_node/tin/vertices.hpp"
#include "sand/model/height_field.hpp"

namespace render_node {
namespace {

using sand::tin::LatticePoint;
using sand::tin::SurfaceView;
using sand::tin::Triangle;
using sand::tin::Triangles;
using sand::tin::Vertex;

// Height units per probe unit. Normals are computed in height units.
constexpr double kUnitsPerProbe = double{sand::kUnitsPerCell} / sand::kProbePerCell;
// Largest distance at which a place reads heights: the largest sky distance, and two cells for interpolation [cell].
constexpr int kLightReach = kSkyDistances.back() + 2;

struct Pair {
    Vertex first, second;
};

/// Bounds of places [probe unit] and heights [scene unit].
struct Reach {
    std::int32_t west = std::numeric_limits<std::int32_t>::max(), south = west;
    std::int32_t east = std::numeric_limits<std::int32_t>::min(), north = east;
    double lowest = std::numeric_limits<double>::max(), highest = std::numeric_limits<double>::lowest();

    void add(std::int32_t x, std::int32_t y, double height) {
        west = std::min(west, x);
        east = std::max(east, x);
        south = std::min(south, y);
        north = std::max(north, y);
        lowest = std::min(lowest, height);
        highest = std::max(highest, height);
    }
};

bool overlapOnGround(const Box& a, const Box& b) {
    return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y;
}

/// Returns the mean normal of the triangles around a vertex, weighted by their areas. It does not have length 1
/// [unit²]. `around` is scratch memory.
glm::dvec3 normalAt(const SurfaceView& tin, Vertex vertex, std::vector<Pair>& around) {
    const Triangles& mesh = tin.triangles;
    const auto at = [&](Vertex corner) {
        const LatticePoint& place = mesh.places[static_cast<std::size_t>(corner)];
        return glm::dvec3(kUnitsPerProbe * place.x, kUnitsPerProbe * place.y,
                          tin.heights[static_cast<std::size_t>(corner)]);
    };
    around.clear();
    aroundVertex(mesh, vertex, [&](std::int32_t slot, int corner) {
        const Triangle& triangle = mesh.triangles[static_cast<std::size_t>(slot)];
        if (!triangle.hole) {
            const auto next = static_cast<std::size_t>(corner + 1);
            around.push_back({triangle.corner[next % 3], triangle.corner[(next + 1) % 3]});
        }
    });
    if (around.empty()) {
        return {0, 0, 1};  // in a hole, where nothing is drawn
    }
    // A sum of floats depends on its order, and the first triangle of a star is arbitrary.
    std::ranges::sort(around, {}, &Pair::first);
    const glm::dvec3 here = at(vertex);
    glm::dvec3 sum(0);
    for (const Pair& pair : around) {
        sum += glm::cross(at(pair.first) - here, at(pair.second) - here);
    }
    return sum;
}

}  // namespace

std::uint16_t TinVertices::mottlingOf(std::int32_t x, std::int32_t y) {
    const int fromX = std::max(0, x - kCell / 2), fromY = std::max(0, y - kCell / 2);
    const int column = fromX / kCell, row = fromY / kCell, alongX = fromX % kCell, alongY = fromY % kCell;
    const auto between = [&](int at) {
        return mottlingAt(column, at) * (kCell - alongX) + mottlingAt(column + 1, at) * alongX;
    };
    const int sum = between(row) * (kCell - alongY) + between(row + 1) * alongY;  // at most kCell² · 255
    return static_cast<std::uint16_t>(static_cast<double>(sum) * 257 / (double{kCell} * kCell));
}

/// Returns the vertices whose light has changed because of these triangles. Adds the triangles around them to the
/// changes.
std::vector<Vertex> TinVertices::relight(const SurfaceView& tin, const std::vector<std::int32_t>& reshaped) {
    lit_.clear();
    for (const std::int32_t slot : reshaped) {
        if (triangle(slot).alive()) {
            addToRelief(tin, triangle(slot));
            TinChunk& chunk = chunks_[static_cast<std::size_t>(inChunk_[static_cast<std::size_t>(slot)].chunk)];
            chunk.reshaped = chunk.partsReshaped = true;
            std::ranges::for_each(triangle(slot).corner, [this](Vertex corner) { lit_.add(corner); });
        }
    }
    const std::size_t corners = lit_.all().size();
    addVerticesAround(relief_.takeChanged());
    std::vector<Vertex> others;
    for (std::size_t i = 0; i < lit_.all().size(); ++i) {
        const Vertex number = lit_.all()[i];
        const bool otherNormal = i < corners && lightFrom(tin, number);
        const bool otherSky = openTo(tin, number);
        if (otherNormal || otherSky) {
            others.push_back(number);
        }
    }
    shaded_.clear();
    for (const Vertex number : others) {
        aroundVertex(tin.triangles, number, [this](std::int32_t slot, int) { shaded_.add(slot); });
    }
    for (const std::int32_t slot : shaded_.all()) {
        if (triangle(slot).alive()) {  // triangles in holes are not drawn
            changedBoxes_.add(boxOf(triangle(slot)));
        }
    }
    return others;
}

void TinVertices::addToRelief(const SurfaceView& tin, const TinTriangle& triangle) {
    if (triangle.alive()) {
        const auto corner = [&](std::size_t i) {
            const auto number = static_cast<std::size_t>(triangle.corner[i]);
            return ReliefCorner{tin.triangles.places[number], tin.heights[number]};
        };
        relief_.put({corner(0), corner(1), corner(2)});
    }
}

std::optional<Box> TinVertices::reachOf(const SurfaceView& tin, const sand::TinChange& sandChange) {
    const Triangles& mesh = tin.triangles;
    Reach changed;
    const auto addVertex = [&](Vertex vertex) {
        const auto number = static_cast<std::size_t>(vertex);
        changed.add(mesh.places[number].x, mesh.places[number].y, tin.heights[number] * unit_);
    };
    const auto addDrawn = [&](Vertex number) {
        const bool known = static_cast<std::size_t>(number) < vertices_.size();
        if (known && vertex(number).x >= 0) {
            changed.add(vertex(number).x, vertex(number).y, vertex(number).height);
        }
    };
    for (const std::int32_t slot : sandChange.triangles) {
        const Triangle& now = mesh.triangles[static_cast<std::size_t>(slot)];
        if (now.isGround()) {
            std::ranges::for_each(now.corner, addVertex);
        }
        if (static_cast<std::size_t>(slot) < triangles_.size() && triangle(slot).alive()) {
            std::ranges::for_each(triangle(slot).corner, addDrawn);
        }
    }
    // The drawn triangles in a star's slots need no box here. They either belong to that star, or have changed earlier,
    // and the box of that change contains them.
    for (const Vertex number : sandChange.vertices) {
        addDrawn(number);
        if (mesh.alive(number)) {
            addVertex(number);
            aroundVertex(mesh, number, [&](std::int32_t slot, int corner) {
                const Triangle& now = mesh.triangles[static_cast<std::size_t>(slot)];
                for (std::size_t k = 1; k < 3 && !now.hole; ++k) {
                    addVertex(now.corner[(static_cast<std::size_t>(corner) + k) % 3]);
                }
            });
        }
    }
    if (changed.west <= 0 || changed.south <= 0 || changed.east >= width_ || changed.north >= depth_) {
        return std::nullopt;
    }
    Box reach{{changed.west * probe_, changed.south * probe_, changed.lowest},
              {changed.east * probe_, changed.north * probe_, changed.highest}};
    // Vertices within this distance see a changed sky, and the triangles around them are shaded again.
    const double margin = kLightReach * cellSize_;
    const Box lit{reach.low - margin, reach.high + margin};
    reach = lit;
    for (TinChunk& chunk : chunks_) {
        if (!chunk.slots.empty() && overlapOnGround(boxOf(chunk), lit)) {
            reach = around(reach, boxOf(chunk));
        }
    }
    return reach;
}

bool TinVertices::lightFrom(const SurfaceView& tin, Vertex number) {
    thread_local std::vector<Pair> around;  // reused, because thousands of vertices per frame need one
    const glm::dvec3 normal = 32767.0 * glm::normalize(normalAt(tin, number, around));
    const auto east = static_cast<std::int16_t>(normal.x), north = static_cast<std::int16_t>(normal.y);
    TinVertex& drawn = vertex(number);
    const bool other = east != drawn.normalEast || north != drawn.normalNorth;
    drawn.normalEast = east;
    drawn.normalNorth = north;
    return other;
}

bool TinVertices::openTo(const SurfaceView& tin, Vertex number) {
    TinVertex& drawn = vertex(number);
    const auto here = static_cast<float>(tin.heights[static_cast<std::size_t>(number)]);
    float share = 0;
    const TinRelief::Between place = TinRelief::between(drawn.x, drawn.y);
    const auto look = [&](const auto& height) {
        openSky({&share, 1}, static_cast<float>(sand::kUnitsPerCell),
                [&](std::size_t, int east, int north) { return height(east, north) - here; });
    };
    if (relief_.isWithin(place, kSkyDistances.back())) {
        look([&](int east, int north) { return relief_.within(place, east, north); });
    } else {
        look([&](int east, int north) { return relief_.at(place, east, north); });
    }
    // 255 steps are as fine as a screen shows. With finer steps the value would change at all vertices within ten cells
    // of moving sand.
    const auto open = static_cast<std::uint16_t>(std::lround(share * 255) * 257);
    const bool other = open != drawn.open;
    drawn.open = open;
    return other;
}

/// Adds to lit_ the vertices whose sky these cells of the relief may change.
void TinVertices::addVerticesAround(const std::vector<sand::CellRect>& cells) {
    for (const sand::CellRect& rect : cells) {
        const sand::CellRect reach = rect.grownBy(kLightReach);
        const LatticePoint southWest{reach.x0 * kCell, reach.y0 * kCell}, northEast{reach.x1 * kCell, reach.y1 * kCell};
        squares_.visitNear(southWest, northEast, [&](Vertex number) {
            const TinVertex& drawn = vertex(number);
            if (drawn.x >= southWest.x && drawn.x <= northEast.x && drawn.y >= southWest.y && drawn.y <= northEast.y) {
                lit_.add(number);
            }
        });
    }
}

}  // namespace render_node
