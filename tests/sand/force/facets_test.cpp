// SPDX-License-Identifier: Apache-2.0
#include "sand/force/facets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <random>
#include <vector>

#include "sand/tin/geometry/tin_start.hpp"
#include "tests/sand/tin/tool_fixture.hpp"

namespace {

using sand::force::Dual;
using sand::force::Facets;
using sand::tin::LatticePoint;
using sand::tin::Triangles;
using sand::tin::VertexSand;

constexpr double kProbe = 1.0 / sand::kProbePerCell;  // [scene unit]; a cell is one scene unit

/// Returns a rough TIN of 48 x 48 cells with two sheer steps at constrained edges, and a group of slivers.
VertexSand roughLayer(std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto below = [&](std::uint32_t most) { return static_cast<std::int32_t>(random() % most); };
    constexpr std::int32_t kSide = 48 * sand::kProbePerCell;
    sand::tin::Mesh mesh(kSide, kSide);
    for (int i = 0; i < 400; ++i) {
        mesh.insert(LatticePoint{below(kSide), below(kSide)});
    }
    for (int i = 0; i < 12; ++i) {
        mesh.insert(LatticePoint{6000 + 16 * i, 6000 + i % 2});
    }
    for (const std::int32_t x : {5200, 5202}) {
        mesh.constrain(mesh.insert(LatticePoint{x, 4000}), mesh.insert(LatticePoint{x + 300, 8000}));
    }
    VertexSand layer(std::move(mesh));
    const auto places = layer.triangles().places;
    for (sand::tin::Vertex vertex = 0; vertex < static_cast<sand::tin::Vertex>(places.size()); ++vertex) {
        const auto& place = places[static_cast<std::size_t>(vertex)];
        layer.setHeight(vertex, below(1 << 17) + (place.x > 5201 ? 1 << 20 : 0));
    }
    return layer;
}

/// Returns a slope with a hole of 8 x 8 cells in its middle.
VertexSand layerWithAHole() {
    const sand::tin::Cells cells = sand::tin::nominalCells(24 * 256, 24 * 256);
    std::vector<sand::tin::Holes::Run> runs;
    for (std::int32_t row = 8; row < 16; ++row) {
        runs.push_back({row, 8, 16});
    }
    sand::tin::Mesh mesh(cells.width, cells.depth, std::make_shared<const sand::tin::Holes>(cells, runs));
    for (const auto& part : mesh.holes()->outline()) {
        const sand::tin::Vertex from = mesh.insert(part.from);
        mesh.constrain(from, mesh.insert(part.to));
    }
    VertexSand layer(std::move(mesh));
    const auto places = layer.triangles().places;
    for (std::size_t i = 0; i < places.size(); ++i) {
        layer.setHeight(static_cast<sand::tin::Vertex>(i), 100 * places[i].x);
    }
    return layer;
}

sand::tin::SurfaceView viewOf(const VertexSand& layer) { return {layer.triangles(), layer.heights()}; }

/// Lowest and highest height at a place, over the planes of all triangles that contain it [cell]. `slope` is the
/// steepest of their slopes, summed over both axes.
struct Found {
    double lowest = 1e30, highest = -1e30, slope = 0;
};
Found search(const VertexSand& layer, double x, double y /* [probe unit] */) {
    Found found;
    for (const auto& triangle : layer.triangles().triangles) {
        if (!triangle.alive()) {
            continue;
        }
        std::array<long double, 3> px{}, py{}, h{};
        for (std::size_t k = 0; k < 3; ++k) {
            const auto corner = static_cast<std::size_t>(triangle.corner[k]);
            px[k] = layer.triangles().places[corner].x;
            py[k] = layer.triangles().places[corner].y;
            h[k] = layer.heights()[corner] / sand::kUnitsPerCell;
        }
        const long double ux = px[1] - px[0], uy = py[1] - py[0], vx = px[2] - px[0], vy = py[2] - py[0];
        const long double area = ux * vy - uy * vx;
        const long double u = ((x - px[0]) * vy - (y - py[0]) * vx) / area;
        const long double v = ((y - py[0]) * ux - (x - px[0]) * uy) / area;
        if (u < 0 || v < 0 || u + v > 1) {
            continue;
        }
        const auto height = static_cast<double>(h[0] + u * (h[1] - h[0]) + v * (h[2] - h[0]));
        found.lowest = std::min(found.lowest, height);
        found.highest = std::max(found.highest, height);
        const long double east = ((h[1] - h[0]) * vy - (h[2] - h[0]) * uy) / area;
        const long double north = ((h[2] - h[0]) * ux - (h[1] - h[0]) * vx) / area;
        found.slope = std::max(found.slope, static_cast<double>(std::abs(east) + std::abs(north)));
    }
    return found;
}

TEST(Facets, AreTheTrianglesToAPartOfAHeightUnit) {
    constexpr std::uint32_t kSeed = 4;
    SCOPED_TRACE(kSeed);
    const VertexSand layer = roughLayer(kSeed);
    Facets facets;
    ASSERT_TRUE(facets.take(viewOf(layer), {5200, 6000, 0}, 4000, kProbe));
    EXPECT_LT(facets.size(), layer.triangles().triangles.size());
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<double> place(-3999, 3999), step(-40, 40);
    double worst = 0, x = 0, y = 0;
    for (int i = 0; i < 1200; ++i) {
        x = i % 8 == 0 ? place(random) : std::clamp(x + step(random), -3999.0, 3999.0);
        y = i % 8 == 0 ? place(random) : std::clamp(y + step(random), -3999.0, 3999.0);
        const Found there = search(layer, 5200 + x, 6000 + y);
        const double height = facets.tangent((5200 + x) * kProbe, (6000 + y) * kProbe).value;
        const double error = std::max(height - there.highest, there.lowest - height);
        // Half of 1/256 of a probe unit along each axis, and the rounding of doubles.
        ASSERT_LE(error, there.slope / 512 + 1e-9) << x << ", " << y;
        worst = std::max(worst, error);
    }
    EXPECT_GT(worst, 0);
    std::printf("at most %.3f height units off, over steps of %d\n", worst * sand::kUnitsPerCell, 1 << 20);
}

/// Returns twice the area of a, b and a place in parts of a probe unit, which is exact. A probe unit has kParts parts.
constexpr std::int64_t kParts = 256;
std::int64_t areaWith(const LatticePoint& a, const LatticePoint& b, std::int64_t x, std::int64_t y) {
    return (std::int64_t{b.x} - a.x) * (y - kParts * a.y) - (std::int64_t{b.y} - a.y) * (x - kParts * a.x);
}

TEST(Facets, TellTheSideOfAnEdgeExactlyOfTheRoundedPlace) {
    constexpr std::uint32_t kSeed = 12;
    SCOPED_TRACE(kSeed);
    std::mt19937 random(kSeed);
    const VertexSand layer = roughLayer(kSeed);
    const Triangles& mesh = layer.triangles();
    Facets facets;
    ASSERT_TRUE(facets.take(viewOf(layer), {6144, 6144, 0}, 6144, kProbe));
    int asked = 0;
    for (const auto& triangle : mesh.triangles) {
        if (!triangle.alive()) {
            continue;
        }
        std::array<LatticePoint, 3> at{};
        for (std::size_t k = 0; k < 3; ++k) {
            at[k] = mesh.places[static_cast<std::size_t>(triangle.corner[k])];
        }
        for (int i = 0; i < 60; ++i) {
            const LatticePoint a = at[static_cast<std::size_t>(i % 3)], b = at[static_cast<std::size_t>((i + 1) % 3)];
            const double along = static_cast<double>(random() % 4096) / 4096;
            const auto x = static_cast<std::int64_t>(std::lround(kParts * (a.x + along * (b.x - a.x)))),
                       y = static_cast<std::int64_t>(std::lround(kParts * (a.y + along * (b.y - a.y))));
            if (areaWith(at[0], at[1], x, y) <= 0 || areaWith(at[1], at[2], x, y) <= 0 ||
                areaWith(at[2], at[0], x, y) <= 0) {
                continue;  // on the edge, or in the triangle beyond
            }
            const double ux = at[1].x - at[0].x, uy = at[1].y - at[0].y, vx = at[2].x - at[0].x, vy = at[2].y - at[0].y;
            const auto height = [&](std::size_t k) {
                return layer.heights()[static_cast<std::size_t>(triangle.corner[k])] / sand::kUnitsPerCell;
            };
            const double east = ((height(1) - height(0)) * vy - (height(2) - height(0)) * uy) / (ux * vy - uy * vx);
            const auto within = [&] { return (static_cast<double>(random() % 800) / 1000 - 0.4) / kParts; };
            const Dual found = facets.tangent((static_cast<double>(x) / kParts + within()) * kProbe,
                                              (static_cast<double>(y) / kParts + within()) * kProbe);
            ASSERT_NEAR(found.slope.x * kProbe, east, 1e-9 * (1 + std::abs(east)))
                << x << ", " << y << " of " << kParts << " in a probe unit";
            ++asked;
        }
    }
    EXPECT_GT(asked, 10000);
}

/// Returns the same mesh with other slots and with triangles that begin at other corners.
Triangles shuffled(const Triangles& mesh, std::mt19937& random) {
    Triangles other = mesh;
    std::vector<std::int32_t> slot(mesh.triangles.size());
    for (std::size_t i = 0; i < slot.size(); ++i) {
        slot[i] = static_cast<std::int32_t>(i);
    }
    std::ranges::shuffle(slot, random);
    const auto renamed = [&](std::int32_t old) { return old < 0 ? old : slot[static_cast<std::size_t>(old)]; };
    for (std::size_t i = 0; i < slot.size(); ++i) {
        const auto turn = random() % 3;
        for (std::size_t k = 0; k < 3; ++k) {
            auto& triangle = other.triangles[static_cast<std::size_t>(slot[i])];
            triangle.corner[k] = mesh.triangles[i].corner[(k + turn) % 3];
            triangle.neighbour[k] = renamed(mesh.triangles[i].neighbour[(k + turn) % 3]);
        }
    }
    std::ranges::transform(mesh.triangleAt, other.triangleAt.begin(), renamed);
    return other;
}

TEST(Facets, SayTheSameWhicheverWayTheyWalkThroughWhicheverSlots) {
    constexpr std::uint32_t kSeed = 9;
    SCOPED_TRACE(kSeed);
    std::mt19937 random(kSeed);
    const VertexSand layer = roughLayer(kSeed);
    const Triangles other = shuffled(layer.triangles(), random);
    std::vector<std::pair<double, double>> places;  // [probe unit]: vertices, middles of edges, the rim, anywhere
    for (const auto& triangle : layer.triangles().triangles) {
        if (!triangle.alive()) {
            continue;
        }
        const LatticePoint a = layer.triangles().places[static_cast<std::size_t>(triangle.corner[0])];
        const LatticePoint b = layer.triangles().places[static_cast<std::size_t>(triangle.corner[1])];
        places.insert(places.end(), {{a.x, a.y}, {(a.x + b.x) / 2.0, (a.y + b.y) / 2.0}});
        places.emplace_back(random() % 12288, random() % 2 * 12288);
        places.emplace_back(random() % 12288, random() % 12288);
    }
    const auto ask = [&](const Facets& facets, const std::pair<double, double>& place) {
        const Dual felt = facets.tangent(place.first * kProbe, place.second * kProbe);
        return std::array{felt.value, felt.slope.x, felt.slope.y};
    };
    for (const std::int32_t reach : {2500, 20000}) {
        Facets facets, others;
        ASSERT_TRUE(facets.take(viewOf(layer), {12000, 300, 0}, reach, kProbe));
        ASSERT_TRUE(others.take({other, layer.heights()}, {12000, 300, 0}, reach, kProbe));
        EXPECT_EQ(facets.size(), others.size());
        std::vector<std::array<double, 3>> first;
        first.reserve(places.size());
        for (const auto& place : places) {
            first.push_back(ask(facets, place));
        }
        for (std::size_t i = places.size(); i-- > 0;) {
            ASSERT_EQ(ask(facets, places[i]), first[i]) << places[i].first << ", " << places[i].second;
            ASSERT_EQ(ask(others, places[i * 7 % places.size()]), first[i * 7 % places.size()]);
        }
    }
}

TEST(Facets, AreFlatBeyondTheirSquareAndRefuseToBeTooMany) {
    const VertexSand layer = roughLayer(3);
    Facets facets;
    ASSERT_TRUE(facets.take(viewOf(layer), {-90000, 6000, 0}, 1000, kProbe));
    const Dual corner = facets.tangent(-3, 100), inside = facets.tangent(kProbe / 256, 7000 * kProbe);
    EXPECT_EQ(corner.value, inside.value);
    EXPECT_EQ(corner.slope.x, 0);
    EXPECT_EQ(corner.slope.y, 0);
    const Dual west = facets.tangent(-3, 6500 * kProbe);
    EXPECT_EQ(west.slope.x, 0);
    EXPECT_NE(west.slope.y, 0);
    const VertexSand dense = tin_samples::levelLayer(64, 64, sand::kProbePerCell);
    ASSERT_GT(dense.triangles().triangles.size(), Facets::kMost);
    EXPECT_FALSE(facets.take(viewOf(dense), {8192, 8192, 0}, 8192, kProbe));
    EXPECT_TRUE(facets.empty());
    EXPECT_TRUE(facets.take(viewOf(dense), {8192, 8192, 0}, 2560, kProbe));
}

TEST(Facets, FeelAHoleAsTheLowestGroundAround) {
    const VertexSand layer = layerWithAHole();
    Facets facets;
    ASSERT_TRUE(facets.take(viewOf(layer), {12 * 256, 12 * 256, 0}, 8 * 256, kProbe));
    const Dual inside = facets.tangent(11, 13);
    EXPECT_EQ(inside.value, 0) << "the west rim is the lowest";
    EXPECT_EQ(inside.slope.x, 0);
    EXPECT_EQ(inside.slope.y, 0);
    const Dual beside = facets.tangent(6, 13);
    EXPECT_NEAR(beside.value, 100 * 6 * 256 / 65536.0, 1e-9);
    EXPECT_NEAR(beside.slope.x, 100 * 256 / 65536.0, 1e-9);
}

}  // namespace
