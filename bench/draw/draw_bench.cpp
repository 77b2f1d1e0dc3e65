// SPDX-License-Identifier: Apache-2.0
// Measures the drawing of one eye of one tile. The wall has 3 × 4 tiles of 1024 × 768 pixels each and shows dunes of
// 512 × 512 or 2048 × 2048 cells. LP_NUM_THREADS sets llvmpipe's threads (0: draw in the calling thread).
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "render_node/gl/gl_context.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/pictures/sample_scene.hpp"

namespace {

constexpr int kAcross = 4;
constexpr int kDown = 3;

sample::Window windowOf(int tile) {
    const int column = tile % kAcross;
    const int row = tile / kAcross;
    return {column / double{kAcross}, row / double{kDown}, (column + 1) / double{kAcross}, (row + 1) / double{kDown}};
}

/// Draws the tiles of the wall. Argument 0: whether chunks outside a tile are left out. Argument 1: cells on a side.
void drawWall(benchmark::State& state) {
    const auto context = render_node::makeOffscreenContext(render_node::Backend::automatic);
    const scene::Scene scene = sample::duneScene(static_cast<int>(state.range(1)));
    const render_node::EyeTarget target(1024, 768);
    const bool culling = state.range(0) != 0;
    // Each tile has its own view, as on the ranks. A view holds only the chunks inside its tile.
    double chunks = 0;
    double kilobytes = 0;
    for (int tile = 0; tile < kAcross * kDown; ++tile) {
        render_node::ScenePainter view(scene, glm::dmat4(1));
        view.setCulling(culling);
        view.draw(sample::camera({1, 0.2, 0.9}, {1, 1, 0}, windowOf(tile)), target);
        target.finish();
        chunks += view.counts().chunks;
        kilobytes += static_cast<double>(view.geometryBytes()) / 1024;
        state.counters["chunks_of_field"] = view.counts().chunksOfField;
    }
    render_node::ScenePainter view(scene, glm::dmat4(1));
    view.setCulling(culling);
    int tile = 0;
    for (auto _ : state) {
        view.draw(sample::camera({1, 0.2, 0.9}, {1, 1, 0}, windowOf(tile)), target);
        target.finish();
        tile = (tile + 1) % (kAcross * kDown);
    }
    state.counters["chunks_per_tile"] = chunks / (kAcross * kDown);
    state.counters["geometry_kB_per_tile"] = kilobytes / (kAcross * kDown);
    state.counters["triangles"] = view.counts().triangles;
    state.SetLabel(context->renderer());
}
BENCHMARK(drawWall)
    ->ArgNames({"culled", "cells"})
    ->Args({0, 512})
    ->Args({1, 512})
    ->Args({1, 2048})
    ->Iterations(4 * kAcross * kDown)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// Draws a tile while the head moves, so that every frame draws the whole tile and new chunks. Argument: cells on a
/// side.
void moveHead(benchmark::State& state) {
    const auto context = render_node::makeOffscreenContext(render_node::Backend::automatic);
    const scene::Scene scene = sample::duneScene(static_cast<int>(state.range(0)));
    const render_node::EyeTarget target(1024, 768);
    render_node::ScenePainter view(scene, glm::dmat4(1));
    render_node::EyeMemory memory;
    int frame = 0;
    for (auto _ : state) {
        const double along = 0.3 * std::sin(0.05 * ++frame);
        view.drawIfChanged(sample::camera({1 + along, 0.2, 0.9}, {1 + along, 1, 0}, windowOf(5)), target, memory);
        target.finish();
    }
    state.counters["triangles"] = view.counts().triangles;
    state.counters["geometry_kB"] = static_cast<double>(view.geometryBytes()) / 1024;
}
BENCHMARK(moveHead)
    ->ArgName("cells")
    ->Arg(512)
    ->Arg(2048)
    ->Iterations(63)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// Gives the changed heights of a new furrow to the view, and draws. Argument: side of the changed square [cell].
void updateChange(benchmark::State& state) {
    const auto context = render_node::makeOffscreenContext(render_node::Backend::automatic);
    const scene::Scene scene = sample::duneScene(512);
    const render_node::EyeTarget target(64, 48);
    render_node::ScenePainter view(scene, glm::dmat4(1));
    const int side = static_cast<int>(state.range(0));
    for (auto _ : state) {
        view.update(sand::GridData{scene.terrain}, sample::changeOf({200, 200, 200 + side, 200 + side}));
        view.draw(sample::camera({1, 1, 2}, {1, 1, 0}), target);
        target.finish();
    }
}
BENCHMARK(updateChange)->ArgName("cells")->Arg(0)->Arg(64)->Arg(312)->Unit(benchmark::kMillisecond)->UseRealTime();

/// Measures a frame in which the tool of Dorjgotov et al. 2007 digs, for one eye of a tile that shows the whole field.
/// Argument 0: 1 draws what changed, 0 everything. Argument 1: cells on a side. The step of sand is not timed.
void dig(benchmark::State& state) {
    const auto context = render_node::makeOffscreenContext(render_node::Backend::automatic);
    const int side = static_cast<int>(state.range(1));
    scene::Scene scene = sample::flatScene(side, side, 0.01);
    sand::grid::makeDunes({.height = 0.02}, scene.terrain);  // these dunes are at rest
    // The default of a scene file.
    const double radius = 0.01 / scene.terrain.cellSize();
    scene.rules.tuning.sweepsPerStep = std::max(4, static_cast<int>(std::ceil(radius * radius / 6)));
    sand::Replica replica(scene);
    render_node::ScenePainter view(scene, glm::dmat4(1));
    const render_node::EyeTarget target(1024, 768);
    const sample::Window window{0.25, 0.25, 0.75, 0.75};
    const render_node::Camera camera = sample::camera({1, 0.2, 0.9}, {1, 1, 0}, window);
    render_node::EyeMemory memory;
    view.drawIfChanged(camera, target, memory);
    double pixels = 0;
    for (auto _ : state) {
        state.PauseTiming();
        const double at = static_cast<double>(replica.stepNumber() % 200) / 200;
        const double place = 0.7 + 0.6 * at;
        replica.apply({0, replica.stepNumber() + 1, true, {sample::probeAt(scene, {place, place, 0.01})}});
        state.ResumeTiming();
        memory.drawn = state.range(0) != 0;
        view.update(replica.surface().data(), replica.takeChange());
        view.setTool(replica.probe(), replica.engaged());
        pixels += static_cast<double>(view.drawIfChanged(camera, target, memory).area()) / (1024 * 768);
        target.finish();
    }
    state.counters["share_of_pixels"] = pixels / static_cast<double>(state.iterations());
    state.counters["chunks"] = view.counts().chunks;
    state.counters["triangles"] = view.counts().triangles;
}
BENCHMARK(dig)
    ->ArgNames({"in_part", "cells"})
    ->ArgsProduct({{0, 1}, {512, 2048}})
    ->Iterations(100)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// Draws a tile of the wall with overlays. Argument 0: Overlays::bits().
void overlays(benchmark::State& state) {
    const auto context = render_node::makeOffscreenContext(render_node::Backend::automatic);
    const scene::Scene scene = sample::duneScene(512);
    render_node::ScenePainter view(scene, glm::dmat4(1));
    view.setLayers(lockstep::Overlays(static_cast<std::uint8_t>(state.range(0))));
    const render_node::EyeTarget target(1024, 768);
    const render_node::Camera camera = sample::camera({1, 0.2, 0.9}, {1, 1, 0}, windowOf(6));
    view.draw(camera, target);
    target.finish();
    for (auto _ : state) {
        view.draw(camera, target);
        target.finish();
    }
}
BENCHMARK(overlays)->ArgName("bits")->DenseRange(0, 3)->Iterations(30)->Unit(benchmark::kMillisecond)->UseRealTime();

void readBack(benchmark::State& state) {
    const auto context = render_node::makeOffscreenContext(render_node::Backend::automatic);
    const render_node::EyeTarget target(1024, 768);
    for (auto _ : state) {
        benchmark::DoNotOptimize(target.read());
    }
}
BENCHMARK(readBack)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
