// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "sand/tin/geometry/tin_start.hpp"
#include "sand/tin/volume/vertex_sand.hpp"

/// Meshes of every kind, piles on them, and the distance of sand from the expected shape. Lengths are in cells of 256
/// probe units.
namespace tin_piles {

using sand::tin::LatticePoint;
using sand::tin::Vertex;
using sand::tin::VertexSand;

inline constexpr int kCell = 256;         // [probe unit]
inline constexpr double kHeight = 65536;  // [unit], length of a cell's side

enum class Kind : std::uint8_t { regular, jittered, random };

inline const char* nameOf(Kind kind) {
    constexpr std::array kNames{"regular", "jittered", "random"};
    return kNames.at(static_cast<std::size_t>(kind));
}

/// Returns a random number in [0, 1), the same with every standard library.
inline double chance(std::mt19937& random) { return static_cast<double>(random()) / 4294967296.0; }

/// Returns the places of about n² vertices on n x n cells. A regular mesh is a square lattice turned by `degrees` about
/// the middle. In a jittered mesh each vertex of this lattice is moved by up to a quarter of a cell in each direction.
/// A random mesh has independent places. Each mesh also has a vertex per cell along the rim.
inline std::vector<LatticePoint> placesOf(Kind kind, int n, double degrees, std::uint32_t seed) {
    std::mt19937 random(seed);
    const std::int32_t side = n * kCell;
    std::vector<LatticePoint> places;
    for (std::int32_t at = kCell; at < side; at += kCell) {
        places.insert(places.end(), {{at, 0}, {at, side}, {0, at}, {side, at}});
    }
    if (kind == Kind::random) {
        for (int i = 0; i < n * n; ++i) {
            const auto x = static_cast<std::int32_t>(chance(random) * side);
            places.push_back({x, static_cast<std::int32_t>(chance(random) * side)});
        }
        return places;
    }
    const double jitter = kind == Kind::jittered ? 0.5 : 0;
    const double east = std::cos(degrees * std::numbers::pi / 180);
    const double north = std::sin(degrees * std::numbers::pi / 180);
    for (int row = -n; row <= 2 * n; ++row) {
        for (int column = -n; column <= 2 * n; ++column) {
            const double a = column - n / 2.0 + jitter * (chance(random) - 0.5);
            const double b = row - n / 2.0 + jitter * (chance(random) - 0.5);
            const double x = n / 2.0 + east * a - north * b;
            const double y = n / 2.0 + north * a + east * b;
            if (std::min({x, y, n - x, n - y}) > 0.4) {
                places.push_back({static_cast<std::int32_t>(std::floor(x * kCell + 0.5)),
                                  static_cast<std::int32_t>(std::floor(y * kCell + 0.5))});
            }
        }
    }
    return places;
}

/// Returns level sand with jittered places.
inline sand::tin::TinStart levelStart(int side /* [cell] */, std::uint32_t seed) {
    sand::tin::TinStart start;
    start.width = start.depth = side * kCell;
    start.places = {{0, 0}, {start.width, 0}, {start.width, start.depth}, {0, start.depth}};
    const auto more = placesOf(Kind::jittered, side, 0, seed);
    start.places.insert(start.places.end(), more.begin(), more.end());
    start.heights.assign(start.places.size(), 0);
    return start;
}

inline VertexSand layerOf(Kind kind, int n, double degrees = 0, std::uint32_t seed = 1) {
    sand::tin::Mesh mesh(n * kCell, n * kCell);
    static_cast<void>(mesh.insert(placesOf(kind, n, degrees, seed)));
    return VertexSand(std::move(mesh));
}

/// Calls visit(weights, x, y) for the centres of 256 equal parts of a triangle.
template <class Visit>
void everywhereIn(const std::array<LatticePoint, 3>& at, const Visit& visit) {
    constexpr int kParts = 16;
    const auto visitPoint = [&](double a, double b) {
        const std::array<double, 3> weights{a / kParts, b / kParts, 1 - (a + b) / kParts};
        visit(weights, (weights[0] * at[0].x + weights[1] * at[1].x + weights[2] * at[2].x) / kCell,
              (weights[0] * at[0].y + weights[1] * at[1].y + weights[2] * at[2].y) / kCell);
    };
    for (int i = 0; i < kParts; ++i) {
        for (int j = 0; i + j < kParts; ++j) {
            visitPoint(i + 1 / 3.0, j + 1 / 3.0);
            if (i + j + 1 < kParts) {
                visitPoint(i + 2 / 3.0, j + 2 / 3.0);
            }
        }
    }
}

/// Calls visit(corners, doubled area [probe unit²], weights, x, y) for points all over the field.
template <class Visit>
void everywhere(const VertexSand& layer, const Visit& visit) {
    const sand::tin::Triangles& mesh = layer.triangles();
    for (const sand::tin::Triangle& triangle : mesh.triangles) {
        if (triangle.alive()) {
            std::array<LatticePoint, 3> at;
            std::transform(triangle.corner.begin(), triangle.corner.end(), at.begin(),
                           [&](Vertex corner) { return mesh.places[static_cast<std::size_t>(corner)]; });
            const auto part = static_cast<double>(doubledArea(at[0], at[1], at[2])) / 256;
            everywhereIn(at, [&](const std::array<double, 3>& weights, double x, double y) {
                visit(triangle.corner, part, weights, x, y);
            });
        }
    }
}

/// Gives every vertex the volume that the profile z = f(x, y) [cell] has under the vertex's share of the surface.
template <class Profile>
void fill(VertexSand& layer, const Profile& profile) {
    std::vector<double> volumes(layer.volumes().size());
    everywhere(layer, [&](const std::array<Vertex, 3>& corner, double area, const auto& weights, double x, double y) {
        for (std::size_t k = 0; k < 3; ++k) {
            volumes[static_cast<std::size_t>(corner[k])] += 3 * area * weights[k] * kHeight * profile(x, y);
        }
    });
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        if (layer.triangles().alive(static_cast<Vertex>(i))) {
            layer.add(static_cast<Vertex>(i),
                      static_cast<std::int64_t>(std::floor(volumes[i] + 0.5)) - layer.volumes()[i]);
        }
    }
}

/// Returns the volume between the surface and a profile, divided by the profile's volume, where `counts(x, y)` is true.
template <class Profile, class Counts>
double misplaced(const VertexSand& layer, const Profile& profile, const Counts& counts) {
    double wrong = 0;
    double all = 0;
    everywhere(layer, [&](const std::array<Vertex, 3>& corner, double area, const auto& weights, double x, double y) {
        if (counts(x, y)) {
            double height = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                height += weights[k] * layer.heights()[static_cast<std::size_t>(corner[k])] / kHeight;
            }
            const double expected = profile(x, y);
            wrong += area * std::abs(height - expected);
            all += area * expected;
        }
    });
    return wrong / all;
}

template <class Profile>
double misplaced(const VertexSand& layer, const Profile& profile) {
    return misplaced(layer, profile, [](double, double) { return true; });
}

/// Returns the height of the surface over a place [cell].
inline double heightAt(const VertexSand& layer, LatticePoint place, std::int32_t& triangle) {
    const sand::tin::Located there = locate(layer.triangles(), place, triangle);
    triangle = there.triangle;
    const auto& corner = layer.triangles().triangles[static_cast<std::size_t>(triangle)].corner;
    double sum = 0;
    double area = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto weight = static_cast<double>(there.weights[k]);
        sum += weight * layer.heights()[static_cast<std::size_t>(corner[k])] / kHeight;
        area += weight;
    }
    return sum / area;
}

/// The lowest and the highest height of a surface [unit].
struct Extremes {
    double lowest = std::numeric_limits<double>::max(), highest = std::numeric_limits<double>::lowest();
};

inline Extremes extremesOf(const VertexSand& layer) {
    Extremes result;
    for (Vertex vertex = 0; vertex < static_cast<Vertex>(layer.heights().size()); ++vertex) {
        if (layer.triangles().alive(vertex)) {
            const double height = layer.heights()[static_cast<std::size_t>(vertex)];
            result = {std::min(result.lowest, height), std::max(result.highest, height)};
        }
    }
    return result;
}

}  // namespace tin_piles
