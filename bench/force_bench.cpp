// SPDX-License-Identifier: Apache-2.0
// What one tick of the force loop costs, and what one step costs to hand it the sand.
#include <benchmark/benchmark.h>

#include <array>
#include <memory>

#include "bench/timing.hpp"
#include "sand/force/force_model.hpp"

namespace {

using sand::force::Vec3;

constexpr double kCell = 1.0 / 256;
constexpr int kTicksPerStep = 16;

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

/// ForceModel::at with another surface every sixteenth tick. range: law, radius [cell], side of the field [cell].
void forceTick(benchmark::State& state) {
    sand::ForceConstants constants;
    constants.law = static_cast<sand::ForceLaw>(state.range(0));
    const double radius = static_cast<double>(state.range(1)) * kCell;
    const auto side = static_cast<int>(state.range(2));
    const auto tool = sand::force::Contour::sphere(radius);
    // Several patches, as a triple buffer hands them over: none may stay in the first cache because it is alone.
    const auto patches = std::make_unique<std::array<sand::force::SurfacePatch, 3>>();
    patches->fill({ripples(side), middle(side), radius});
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
    for (const auto& [name, share] : {std::pair{"p50_us", 0.5}, {"p99_us", 0.99}, {"p99.9_us", 0.999}}) {
        state.counters[name] = 1e6 * bench::quantile(seconds, share);
    }
}
// As many ticks in every row: a percentile of fewer is another number. 20,000 are twenty seconds of the loop.
BENCHMARK(forceTick)
    ->ArgNames({"law", "cells", "side"})
    ->ArgsProduct({{0, 1}, {2, 10, 20}, {512, 4096}})
    ->Iterations(20000);

/// range: radius [cell].
void surfacePatch(benchmark::State& state) {
    const sand::HeightField field = ripples(512);
    for (auto step : state) {
        sand::force::SurfacePatch patch(field, middle(512), static_cast<double>(state.range(0)) * kCell);
        benchmark::DoNotOptimize(patch);
    }
}
BENCHMARK(surfacePatch)->Arg(2)->Arg(10)->Arg(50);

}  // namespace

BENCHMARK_MAIN();
