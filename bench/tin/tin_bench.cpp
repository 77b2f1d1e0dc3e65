// SPDX-License-Identifier: Apache-2.0
// Measures how long it takes to make a TIN and to change it: whole meshes, and one tool's imprint in a large mesh.
#include <benchmark/benchmark.h>

#include <array>
#include <random>
#include <vector>

#include "sand/tin/volume/vertex_sand.hpp"

namespace {

using sand::tin::LatticePoint;
using sand::tin::Mesh;
using sand::tin::Vertex;
using sand::tin::VertexSand;

constexpr std::int32_t kSide = 512 * 256;  // side of 512 cells [probe unit]
constexpr int kVertices = 250'000;

std::vector<LatticePoint> randomPlaces(int count) {
    std::mt19937 random(1);
    std::vector<LatticePoint> places;
    for (int i = 0; i < count; ++i) {
        const auto x = static_cast<std::int32_t>(random() % (kSide + 1));
        places.push_back({x, static_cast<std::int32_t>(random() % (kSide + 1))});
    }
    return places;
}

/// Returns the points of a square lattice. The four corners of each square are on one circle.
std::vector<LatticePoint> latticePlaces() {
    std::vector<LatticePoint> places;
    for (std::int32_t y = 0; y <= kSide; y += 264) {
        for (std::int32_t x = 0; x <= kSide; x += 264) {
            places.push_back({x, y});
        }
    }
    return places;
}

Mesh meshOf(const std::vector<LatticePoint>& places) {
    Mesh mesh(kSide, kSide);
    mesh.insert(places);
    return mesh;
}

void insertAll(benchmark::State& state, const std::vector<LatticePoint>& places) {
    for (auto _ : state) {
        const Mesh mesh = meshOf(places);
        benchmark::DoNotOptimize(mesh.vertexCount());
    }
    state.counters["vertices"] = static_cast<double>(places.size());
}

void insertOneByOne(benchmark::State& state) {
    const std::vector<LatticePoint> places = randomPlaces(kVertices);
    Mesh mesh = meshOf(places);
    std::mt19937 random(2);
    for (auto _ : state) {
        const auto x = static_cast<std::int32_t>(random() % kSide);
        benchmark::DoNotOptimize(mesh.insert(LatticePoint{x, static_cast<std::int32_t>(random() % kSide)}));
    }
}

/// Inserts an ellipse of 32 points with a radius of 16 cells by 8, and makes its edges constraints. Returns its
/// vertices. About 380 vertices of the mesh are inside.
template <class Surface>
std::vector<Vertex> imprint(Surface& surface, const LatticePoint& centre) {
    constexpr std::array<std::array<int, 2>, 32> kUnit{
        {{4096, 0},      {4017, 399},    {3784, 784},   {3406, 1138},  {2896, 1448},  {2276, 1703},   {1567, 1892},
         {799, 2009},    {0, 2048},      {-799, 2009},  {-1567, 1892}, {-2276, 1703}, {-2896, 1448},  {-3406, 1138},
         {-3784, 784},   {-4017, 399},   {-4096, 0},    {-4017, -399}, {-3784, -784}, {-3406, -1138}, {-2896, -1448},
         {-2276, -1703}, {-1567, -1892}, {-799, -2009}, {0, -2048},    {799, -2009},  {1567, -1892},  {2276, -1703},
         {2896, -1448},  {3406, -1138},  {3784, -784},  {4017, -399}}};
    std::vector<Vertex> ring;
    ring.reserve(kUnit.size());
    for (const auto& [x, y] : kUnit) {
        ring.push_back(surface.insert(LatticePoint{centre.x + x, centre.y + y}));
    }
    for (std::size_t i = 0; i < ring.size(); ++i) {
        surface.constrain(ring[i], ring[(i + 1) % ring.size()]);
    }
    return ring;
}

LatticePoint somewhere(std::mt19937& random) {
    const auto x = static_cast<std::int32_t>(5000 + random() % (kSide - 10'000));
    return {x, static_cast<std::int32_t>(5000 + random() % (kSide - 10'000))};
}

void imprintMesh(benchmark::State& state) {
    Mesh mesh = meshOf(randomPlaces(kVertices));
    (void)mesh.takeChange();  // the first change is the whole mesh
    std::mt19937 random(3);
    for (auto _ : state) {
        const std::vector<Vertex> ring = imprint(mesh, somewhere(random));
        state.PauseTiming();
        for (const Vertex vertex : ring) {
            mesh.remove(vertex);
        }
        (void)mesh.takeChange();
        state.ResumeTiming();
    }
}

/// Measures an imprint in a mesh with sand on it, as one change.
void imprintLayer(benchmark::State& state) {
    VertexSand layer(meshOf(randomPlaces(kVertices)));
    (void)layer.takeChange();  // the first change is the whole mesh
    std::mt19937 random(3);
    for (auto _ : state) {
        std::vector<Vertex> ring;
        layer.edit([&](Mesh& mesh) { ring = imprint(mesh, somewhere(random)); });
        state.PauseTiming();
        layer.edit([&](Mesh& mesh) {
            for (const Vertex vertex : ring) {
                mesh.remove(vertex);
            }
        });
        (void)layer.takeChange();
        state.ResumeTiming();
    }
}

void dissolveLayer(benchmark::State& state) {
    VertexSand layer(meshOf(randomPlaces(kVertices)));
    (void)layer.takeChange();  // the first change is the whole mesh
    std::mt19937 random(3);
    for (auto _ : state) {
        state.PauseTiming();
        std::vector<Vertex> ring;
        layer.edit([&](Mesh& mesh) { ring = imprint(mesh, somewhere(random)); });
        state.ResumeTiming();
        layer.edit([&](Mesh& mesh) {
            for (const Vertex vertex : ring) {
                mesh.remove(vertex);
            }
        });
        benchmark::DoNotOptimize(layer.takeChange());
    }
}

void locateAnywhere(benchmark::State& state) {
    const Mesh mesh = meshOf(randomPlaces(kVertices));
    std::mt19937 random(4);
    std::int32_t last = 0;
    const auto reach = static_cast<std::int32_t>(state.range(0));
    LatticePoint place{kSide / 2, kSide / 2};
    for (auto _ : state) {
        place.x += static_cast<std::int32_t>(random() % static_cast<std::uint32_t>(2 * reach + 1)) - reach;
        place.y += static_cast<std::int32_t>(random() % static_cast<std::uint32_t>(2 * reach + 1)) - reach;
        last = locate(mesh.triangles(), place, last).triangle;
    }
}

}  // namespace

BENCHMARK_CAPTURE(insertAll, random, randomPlaces(kVertices))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(insertAll, lattice, latticePlaces())->Unit(benchmark::kMillisecond);
BENCHMARK(insertOneByOne)->Unit(benchmark::kMicrosecond);
BENCHMARK(imprintMesh)->Unit(benchmark::kMicrosecond);
BENCHMARK(imprintLayer)->Unit(benchmark::kMicrosecond);
BENCHMARK(dissolveLayer)->Unit(benchmark::kMicrosecond);
BENCHMARK(locateAnywhere)->Arg(16)->Arg(1000)->Unit(benchmark::kNanosecond);
BENCHMARK_MAIN();
