// SPDX-License-Identifier: Apache-2.0
// Measures one tick of the force loop, and the copy of the sand that the loop gets after each step.
#include <benchmark/benchmark.h>

#include <array>
#include <memory>

#include "bench/report/timing.hpp"
#include "sand/force/force_model.hpp"
#include "sand/replica.hpp"
#include "sand/tin/refine/start_maker.hpp"
#include "sand/tin/volume/vertex_sand.hpp"

namespace {

using sand::force::Vec3;

constexpr double kCell = 1.0 / 256;
constexpr int kTicksPerStep = 16;
constexpr int kTinSide = 256;

sand::HeightField ripples(int side) {
    sand::HeightField field(side, side, kCell);
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            field.setHeight(column, row, ((column * 7 + row * 13) % 64) * 1024);
        }
    }
    return field;
}

sand::ProbePoint middle(int side) { return {side / 2 * sand::kProbePerCell, side / 2 * sand::kProbePerCell, 0}; }

/// Returns a TIN with a vertex in the middle of every cell, and ripples on it.
sand::tin::VertexSand tinRipples(int side) {
    sand::tin::Mesh mesh(side * sand::kProbePerCell, side * sand::kProbePerCell);
    std::vector<sand::tin::LatticePoint> places;
    places.reserve(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    for (int cell = 0; cell < side * side; ++cell) {
        places.push_back(
            {(cell % side * 2 + 1) * sand::kProbePerCell / 2, (cell / side * 2 + 1) * sand::kProbePerCell / 2});
    }
    mesh.insert(places);
    sand::tin::VertexSand layer(std::move(mesh));
    for (sand::tin::Vertex vertex = 4; vertex < static_cast<sand::tin::Vertex>(places.size() + 4); ++vertex) {
        layer.setHeight(vertex, (((vertex - 4) % side * 7 + (vertex - 4) / side * 13) % 64) * 1024);
    }
    return layer;
}

sand::tin::SurfaceView viewOf(const sand::tin::VertexSand& layer) { return {layer.triangles(), layer.heights()}; }

/// Measures ForceModel::at() with another surface every sixteenth tick.
void tick(benchmark::State& state, const sand::force::SurfacePatch& patch, double side /* [cell] */) {
    sand::ForceConstants constants;
    constants.law = static_cast<sand::ForceLaw>(state.range(0));
    const double radius = static_cast<double>(state.range(1)) * kCell;
    const auto tool = sand::force::Contour::sphere(radius);
    // Three patches, as in a triple buffer. A single patch would stay in the first-level cache.
    const auto patches = std::make_unique<std::array<sand::force::SurfacePatch, 3>>();
    patches->fill(patch);
    sand::force::ForceModel model(constants);
    const Vec3 centre{side * kCell / 2, side * kCell / 2, radius / 2};
    std::vector<double> seconds;
    std::uint64_t tick = 0;
    for (auto _ : state) {
        const std::uint64_t step = tick / kTicksPerStep;
        const double phase = static_cast<double>(tick % 400) / 200 - 1;
        const Vec3 place = centre + Vec3{radius * std::abs(phase), radius * phase * phase / 2, 0};
        ++tick;
        const double before = bench::cpuSeconds();
        auto felt = model.at((*patches)[step % 3], step, tool, place, 1e-3 * static_cast<double>(tick));
        benchmark::DoNotOptimize(felt);
        seconds.push_back(bench::cpuSeconds() - before);
    }
    for (const auto& [name, share] :
         {std::pair{"p50_us", 0.5}, {"p99_us", 0.99}, {"p99.9_us", 0.999}, {"max_us", 1.0}}) {
        state.counters[name] = 1e6 * bench::quantile(seconds, share);
    }
}
/// Measures a tick on a height field. Arguments: law, radius [cell], side of the field [cell].
void forceTick(benchmark::State& state) {
    const auto side = static_cast<int>(state.range(2));
    tick(state, {ripples(side), middle(side), static_cast<double>(state.range(1)) * kCell}, side);
}
// Every row has as many ticks, because a percentile depends on their number. 20,000 ticks are twenty seconds of the
// loop.
BENCHMARK(forceTick)
    ->ArgNames({"law", "cells", "side"})
    ->ArgsProduct({{0, 1}, {2, 10, 31, 63, 127}, {512, 4096}})
    ->Iterations(20000);

/// Measures a tick on a TIN. Arguments: law, radius [cell].
void forceTickOfTin(benchmark::State& state) {
    const sand::tin::VertexSand layer = tinRipples(kTinSide);
    const double radius = static_cast<double>(state.range(1)) * kCell;
    const sand::force::SurfacePatch patch(viewOf(layer), kCell, middle(kTinSide), radius);
    tick(state, patch, kTinSide);
    state.counters["triangles"] = static_cast<double>(patch.facets().size());
}
BENCHMARK(forceTickOfTin)->ArgNames({"law", "cells"})->ArgsProduct({{0, 1}, {2, 4, 5}})->Iterations(20000);

/// Measures the copy of a height field around the tool. Argument: radius [cell].
void surfacePatch(benchmark::State& state) {
    const sand::HeightField field = ripples(2048);
    for (auto step : state) {
        sand::force::SurfacePatch patch(field, middle(2048), static_cast<double>(state.range(0)) * kCell);
        benchmark::DoNotOptimize(patch);
    }
}
BENCHMARK(surfacePatch)->Arg(2)->Arg(10)->Arg(31)->Arg(63)->Arg(127);

/// Measures the sampling of a TIN with more than Facets::kMost triangles around the tool. Argument: radius [cell].
void surfacePatchOfFineTin(benchmark::State& state) {
    constexpr int kSide = 520;
    static const auto fine = std::make_shared<const sand::tin::TinStart>(
        sand::tin::follow(ripples(kSide), nullptr,
                          {.widest = sand::kProbePerCell, .maxError = 0, .mostVertices = 2 * kSide * kSide})
            .start);
    sand::Start start;
    start.terrain = sand::HeightField(1, 1, kCell);
    start.tin = fine;
    start.rules.columns = start.rules.rows = kSide;
    start.rules.tuning.threshold = start.rules.tuning.startThreshold = sand::kUnitsPerCell;
    start.rules.tuning.sweepsPerStep = 1;
    start.rules.stepsPerSecond = 60;
    start.rules.tuning.tool.radius = static_cast<std::int32_t>(state.range(0)) * sand::kProbePerCell;
    const sand::Replica replica(start);
    sand::force::SurfacePatch patch;
    for (auto step : state) {
        patch.take(replica.surface(), replica.rules(), replica.cellSize(), middle(kSide));
        benchmark::DoNotOptimize(patch);
    }
}
BENCHMARK(surfacePatchOfFineTin)->Arg(10)->Arg(31);

/// Measures the copy of a TIN's triangles into the memory of the previous copy. Argument: radius [cell].
void facets(benchmark::State& state) {
    const sand::tin::VertexSand layer = tinRipples(kTinSide);
    sand::force::Facets facets;
    const auto reach = static_cast<std::int32_t>(std::max<std::int64_t>(4 * state.range(0), 8)) * sand::kProbePerCell;
    for (auto step : state) {
        benchmark::DoNotOptimize(facets.take(viewOf(layer), middle(kTinSide), reach, kCell / sand::kProbePerCell));
    }
    state.counters["triangles"] = static_cast<double>(facets.size());
}
BENCHMARK(facets)->Arg(2)->Arg(4)->Arg(5);

}  // namespace

BENCHMARK_MAIN();
