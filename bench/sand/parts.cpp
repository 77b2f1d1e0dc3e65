// SPDX-License-Identifier: Apache-2.0
// Measures a step with and without bedrock: with sand at rest, after a small edit, and with all sand moving.
#include <optional>
#include <random>

#include "bench/report/curves.hpp"
#include "bench/report/timing.hpp"
#include "bench/sand/relaxations.hpp"
#include "sand/grid/erosion.hpp"
#include "sand/model/ground.hpp"

namespace bench {
namespace {

constexpr int kSweeps = 16;        // per step
constexpr int kBedrockDepth = 64;  // depth of the bedrock below the level sand [cell]

enum class Happening { settled, smallEdit, everythingMoves };

struct Cost {
    std::vector<double> seconds;  // per step
    std::int64_t sweeps = 0;      // of the last step
    std::size_t bytes = 0;        // heights, fluxes, blocks and rock
};

Cost measure(int side, bool withBedrock, Happening happening, const Settings& settings) {
    std::mt19937 random(settings.seed);
    sand::HeightField start(side, side, 1.0);
    std::optional<sand::Ground> ground;
    if (withBedrock) {
        ground.emplace(side, side);
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                ground->setBedrock(x, y, -kBedrockDepth * sand::kUnitsPerCell);
            }
        }
    }
    if (happening == Happening::everythingMoves) {
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                start.setHeight(x, y, static_cast<std::int32_t>(random() % (1U << 22)));
            }
        }
    }
    const sand::Rules rules = rulesFor(start, kTalus);
    sand::grid::Erosion::Options options;
    options.ground = ground ? &*ground : nullptr;
    const sand::grid::Displacement tool({.radius = 3 * sand::kProbePerCell});
    const sand::ProbePoint middle{side * sand::kProbePerCell / 2, side * sand::kProbePerCell / 2, 0};

    Cost cost;
    for (int run = 0; run < settings.runs; ++run) {
        sand::HeightField field = start;
        sand::grid::Erosion erosion(field, rules, options);
        if (happening != Happening::everythingMoves) {
            erosion.sweep(field, kMostSweeps);
        }
        const std::int64_t before = erosion.sweepsDone();
        cost.seconds.push_back(secondsOf([&] {
            if (happening == Happening::smallEdit) {
                erosion.touch(tool.drag(field, rules.rim, options.ground, middle, middle).cells);
            }
            erosion.sweep(field, kSweeps);
        }));
        cost.sweeps = erosion.sweepsDone() - before;
        cost.bytes = static_cast<std::size_t>(field.stride()) * static_cast<std::size_t>(side + 2) * sizeof(int) +
                     erosion.bytes() + (ground ? ground->cells().bytes() : 0);
    }
    return cost;
}

}  // namespace

void parts(const Settings& settings, Csv& csv) {
    csv.note(
        fmt::format("a step of {} sweeps; bedrock {} cells below level sand. One small edit: a sphere of 3 cells "
                    "presses half of itself in. Everything moving: noise of 64 cells.",
                    kSweeps, kBedrockDepth));
    csv.note("CPU time of one thread; sweeps: number until all motion ended");
    csv.columns("ground,state,N,runs,us_median,us_min,us_max,sweeps,bytes");
    for (const int side : settings.sizes) {
        for (const bool withBedrock : {false, true}) {
            for (const auto& [happening, name] : {std::pair{Happening::settled, "settled"},
                                                  {Happening::smallEdit, "one small edit"},
                                                  {Happening::everythingMoves, "everything moving"}}) {
                progress("N = {}, {} bedrock, {}", side, withBedrock ? "with" : "without", name);
                const Cost cost = measure(side, withBedrock, happening, settings);
                const Spread us = spreadOf(cost.seconds);
                csv.row(withBedrock ? "bedrock" : "none", name, side, settings.runs, us.median * 1e6, us.lowest * 1e6,
                        us.highest * 1e6, cost.sweeps, cost.bytes);
            }
        }
    }
}

}  // namespace bench
