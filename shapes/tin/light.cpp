// SPDX-License-Identifier: Apache-2.0
#include "shapes/tin/light.hpp"

#include <algorithm>
#include <cmath>

#include "sand/model/height_field.hpp"
#include "shapes/model/grain.hpp"

namespace shapes {
namespace {

using sand::tin::LatticePoint;
using sand::tin::SurfaceView;
using sand::tin::Triangle;
using sand::tin::Triangles;
using sand::tin::Vertex;

// Normals are computed in height units.
constexpr double kUnitsPerProbe = sand::kUnitsPerProbe;
constexpr int kCell = sand::tin::kLatticePerCell;

struct Pair {
    Vertex first, second;
};

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
    std::sort(around.begin(), around.end(), [](const Pair& a, const Pair& b) { return a.first < b.first; });
    const glm::dvec3 here = at(vertex);
    glm::dvec3 sum(0);
    for (const Pair& pair : around) {
        sum += glm::cross(at(pair.first) - here, at(pair.second) - here);
    }
    return sum;
}

/// Sets the normal of a vertex. Returns whether it has changed.
bool lightFrom(const SurfaceView& tin, Vertex number, TinVertex& drawn) {
    thread_local std::vector<Pair> around;  // reused, because thousands of vertices per frame need one
    const glm::dvec3 normal = 32767.0 * glm::normalize(normalAt(tin, number, around));
    const auto east = static_cast<std::int16_t>(normal.x), north = static_cast<std::int16_t>(normal.y);
    const bool other = east != drawn.normalEast || north != drawn.normalNorth;
    drawn.normalEast = east;
    drawn.normalNorth = north;
    return other;
}

}  // namespace

std::uint16_t TinLight::mottlingOf(std::int32_t x, std::int32_t y) {
    const int fromX = std::max(0, x - kCell / 2), fromY = std::max(0, y - kCell / 2);
    const int column = fromX / kCell, row = fromY / kCell, alongX = fromX % kCell, alongY = fromY % kCell;
    const auto between = [&](int at) {
        return mottlingAt(column, at) * (kCell - alongX) + mottlingAt(column + 1, at) * alongX;
    };
    const int sum = between(row) * (kCell - alongY) + between(row + 1) * alongY;  // at most kCell² · 255
    return static_cast<std::uint16_t>(static_cast<double>(sum) * 257 / (double{kCell} * kCell));
}

void TinLight::move(Vertex number, const TinVertex& before, const TinVertex& now) {
    if (before.x >= 0) {
        squares_.remove(number, {before.x, before.y});
    }
    if (now.x >= 0) {
        squares_.add(number, {now.x, now.y});
    }
}

void TinLight::lightAll(const SurfaceView& tin, TinGeometry& geometry, std::span<const Vertex> all) {
    for (const TinTriangle& triangle : geometry.triangles) {
        addToRelief(tin, triangle);
    }
    (void)relief_.takeChanged();
    for (const Vertex number : all) {
        lightFrom(tin, number, geometry.vertex(number));
        openTo(tin, number, geometry.vertex(number));
    }
}

std::vector<Vertex> TinLight::relight(const SurfaceView& tin, TinGeometry& geometry,
                                      std::span<const std::int32_t> reshaped) {
    lit_.clear();
    for (const std::int32_t slot : reshaped) {
        const TinTriangle& triangle = geometry.triangle(slot);
        if (triangle.alive()) {
            addToRelief(tin, triangle);
            std::for_each(triangle.corner.begin(), triangle.corner.end(), [this](Vertex corner) { lit_.add(corner); });
        }
    }
    const std::size_t corners = lit_.all().size();
    addVerticesAround(geometry, relief_.takeChanged());
    std::vector<Vertex> others;
    for (std::size_t i = 0; i < lit_.all().size(); ++i) {
        const Vertex number = lit_.all()[i];
        const bool otherNormal = i < corners && lightFrom(tin, number, geometry.vertex(number));
        const bool otherSky = openTo(tin, number, geometry.vertex(number));
        if (otherNormal || otherSky) {
            others.push_back(number);
        }
    }
    return others;
}

void TinLight::addToRelief(const SurfaceView& tin, const TinTriangle& triangle) {
    if (triangle.alive()) {
        const auto corner = [&](std::size_t i) {
            const auto number = static_cast<std::size_t>(triangle.corner[i]);
            return ReliefCorner{tin.triangles.places[number], tin.heights[number]};
        };
        relief_.put({corner(0), corner(1), corner(2)});
    }
}

/// Sets the visible share of the sky at a vertex. Returns whether it has changed.
bool TinLight::openTo(const SurfaceView& tin, Vertex number, TinVertex& drawn) const {
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
void TinLight::addVerticesAround(const TinGeometry& geometry, const std::vector<sand::CellRect>& cells) {
    for (const sand::CellRect& rect : cells) {
        const sand::CellRect reach = rect.grownBy(kReach);
        const LatticePoint southWest{reach.x0 * kCell, reach.y0 * kCell}, northEast{reach.x1 * kCell, reach.y1 * kCell};
        squares_.visitNear(southWest, northEast, [&](Vertex number) {
            const TinVertex& drawn = geometry.vertex(number);
            if (drawn.x >= southWest.x && drawn.x <= northEast.x && drawn.y >= southWest.y && drawn.y <= northEast.y) {
                lit_.add(number);
            }
        });
    }
}

}  // namespace shapes
