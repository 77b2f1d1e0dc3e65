// SPDX-License-Identifier: Apache-2.0
// Measures sweeps, steps and copies of the sand. The sweeps are of fields in which all sand moves. A memcpy of the same
// bytes in the same run is the reference: quote the ratio, because machines differ.
#include <benchmark/benchmark.h>

#include <cstring>
#include <random>
#include <string>

#include "sand/grid/dunes.hpp"
#include "sand/grid/erosion.hpp"
#include "sand/replica.hpp"
#include "scene/model/scene.hpp"

namespace {

sand::HeightField roughField(int side) {
    std::mt19937 random(61);
    sand::HeightField field(side, side, 1.0);
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            field.setHeight(x, y, static_cast<std::int32_t>(random() % (1U << 22)));
        }
    }
    return field;
}

void reportPerCell(benchmark::State& state, double cells) {
    state.counters["ns_per_cell"] =
        benchmark::Counter(cells * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void sweep(benchmark::State& state, sand::Scheme scheme, base::CodePath path, std::int32_t band = 0) {
    const int side = static_cast<int>(state.range(0));
    sand::HeightField field = roughField(side);
    sand::Rules rules;
    rules.columns = rules.rows = side;
    rules.tuning.threshold = 64;  // nearly all sand moves
    rules.tuning.startThreshold = rules.tuning.threshold + band;
    rules.scheme = scheme;
    sand::grid::Erosion erosion(field, rules, {.path = path});
    for (auto _ : state) {
        erosion.sweep(field, 1);
    }
    state.SetLabel(std::string(base::nameOf(path)));
    reportPerCell(state, static_cast<double>(side) * side);
}
BENCHMARK_CAPTURE(sweep, G, sand::Scheme::isotropic, base::fastestCodePath())->Arg(512)->Arg(1024)->Arg(2048);
BENCHMARK_CAPTURE(sweep, G_band, sand::Scheme::isotropic, base::fastestCodePath(), 1)->Arg(512)->Arg(1024)->Arg(2048);
BENCHMARK_CAPTURE(sweep, G_plain, sand::Scheme::plainIsotropic, base::fastestCodePath())->Arg(512);
BENCHMARK_CAPTURE(sweep, G_baseline, sand::Scheme::isotropic, base::CodePath::baseline)->Arg(512);

void copy(benchmark::State& state) {
    const auto cells = static_cast<std::size_t>(state.range(0) * state.range(0));
    const std::vector<std::int32_t> from(cells, 1);
    std::vector<std::int32_t> to(cells);
    for (auto _ : state) {
        std::memcpy(to.data(), from.data(), cells * sizeof from[0]);
        benchmark::ClobberMemory();
    }
    reportPerCell(state, static_cast<double>(cells));
}
BENCHMARK(copy)->Name("memcpy")->Arg(512)->Arg(1024)->Arg(2048);

scene::Scene level(double toolCells, int sweeps, std::int32_t band = 0) {
    scene::Scene scene;
    scene.terrain = sand::HeightField(512, 512, 1.0);
    scene.rules.columns = scene.rules.rows = 512;
    scene.rules.tuning.threshold = 44204;  // 34 degrees
    scene.rules.tuning.startThreshold = scene.rules.tuning.threshold + band;
    scene.rules.tuning.sweepsPerStep = sweeps;
    scene.rules.stepsPerSecond = 60;
    scene.rules.tuning.tool.radius = static_cast<std::int32_t>(toolCells * sand::kProbePerCell);
    return scene;
}

constexpr int kLap = 503;  // steps of one circle, so that every build digs the same sand

/// Measures a step of digging in a circle, 1.5 cells long, with its hash.
void dig(benchmark::State& state, double toolCells, int sweeps, std::int32_t band = 0) {
    sand::Replica replica(level(toolCells, sweeps, band));
    for (auto _ : state) {
        const double angle = static_cast<double>(replica.stepNumber()) * 1.5 / 120;
        const auto at = [](double cell) { return static_cast<std::int32_t>(cell * sand::kProbePerCell); };
        replica.apply({1,
                       replica.stepNumber() + 1,
                       true,
                       {{at(256 + 120 * std::cos(angle)), at(256 + 120 * std::sin(angle)), 0}}});
        benchmark::DoNotOptimize(replica.stateHash());
    }
}
BENCHMARK_CAPTURE(dig, paper_tool, 2.56, 4)->Iterations(kLap)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(dig, tool_of_12_cells, 12.0, 24)->Iterations(kLap)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(dig, tool_of_12_cells_band, 12.0, 24, 44)->Iterations(kLap)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(dig, tool_of_30_cells, 30.0, 150)->Iterations(kLap)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(dig, tool_of_30_cells_band, 30.0, 150, 44)->Iterations(kLap)->Unit(benchmark::kMillisecond);

/// Measures two steps, in which a hand touches the sand, far from moving sand, and leaves it. The result is the
/// cost of a snapshot for an undo.
void touchDown(benchmark::State& state) {
    const int side = static_cast<int>(state.range(0));
    scene::Scene scene = level(2.56, 4);
    scene.terrain = sand::HeightField(side, side, 1.0);
    sand::grid::makeDunes({}, scene.terrain);
    scene.rules.columns = scene.rules.rows = side;
    sand::Replica replica(scene);
    for (auto _ : state) {
        for (const bool engaged : {true, false}) {
            const auto place = static_cast<std::int32_t>(side / 2 * sand::kProbePerCell);
            replica.apply({1, replica.stepNumber() + 1, engaged, {{place, place, 0}}});
        }
    }
}
BENCHMARK(touchDown)->Arg(512)->Arg(2048)->Unit(benchmark::kMillisecond);

/// Measures the compression of a snapshot.
void compressed(benchmark::State& state) {
    const int side = static_cast<int>(state.range(0));
    scene::Scene scene = level(2.56, 4);
    scene.terrain = sand::HeightField(side, side, 1.0);
    sand::grid::makeDunes({}, scene.terrain);
    scene.rules.columns = scene.rules.rows = side;
    const sand::Replica replica(scene);
    for (auto _ : state) {
        benchmark::DoNotOptimize(replica.copySand()->encode());
    }
}
BENCHMARK(compressed)->Arg(512)->Arg(2048)->Unit(benchmark::kMillisecond);

/// Measures a step with settled sand and a hovering hand.
void idle(benchmark::State& state) {
    sand::Replica replica(level(12, 24));
    for (auto _ : state) {
        replica.apply({1, replica.stepNumber() + 1, false, {}});
        benchmark::DoNotOptimize(replica.stateHash());
    }
}
BENCHMARK(idle)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
