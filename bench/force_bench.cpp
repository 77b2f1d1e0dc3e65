// SPDX-License-Identifier: Apache-2.0
// What one tick of the force loop costs, and what one step costs to hand it the sand.
#include <benchmark/benchmark.h>

#include "sand/force/contact_force.hpp"

namespace {

constexpr double kWidth = 2.0;
constexpr int kSide = 512;

sand::HeightField ripples() {
    sand::HeightField field(kSide, kSide, kWidth / kSide);
    for (int row = 0; row < kSide; ++row) {
        for (int column = 0; column < kSide; ++column) {
            field.setHeight(column, row, ((column * 7 + row * 13) % 64) * 1024);
        }
    }
    return field;
}

sand::ProbePoint centre() { return {kSide / 2 * sand::kProbePerCell, kSide / 2 * sand::kProbePerCell, 0}; }

/// range: tool radius in hundredths of a scene unit.
void forceTick(benchmark::State& state) {
    const double radius = static_cast<double>(state.range(0)) / 100;
    const sand::force::SurfacePatch patch(ripples(), centre(), radius);
    sand::force::Vec3 place{1, 1, 0};
    for (auto tick : state) {
        place.x = place.x > 1.005 ? 1 : place.x + 1e-4;
        benchmark::DoNotOptimize(place);
        const auto contact = sand::force::measureContact(patch, place, radius);
        auto force = sand::force::guarded(sand::force::contactForce({}, contact, {0.001, 0, 0}), 0.01);
        benchmark::DoNotOptimize(force);
    }
}
BENCHMARK(forceTick)->Arg(1)->Arg(4)->Arg(20);

void surfacePatch(benchmark::State& state) {
    const sand::HeightField field = ripples();
    for (auto step : state) {
        sand::force::SurfacePatch patch(field, centre(), static_cast<double>(state.range(0)) / 100);
        benchmark::DoNotOptimize(patch);
    }
}
BENCHMARK(surfacePatch)->Arg(1)->Arg(4)->Arg(20);

}  // namespace

BENCHMARK_MAIN();
