// SPDX-License-Identifier: Apache-2.0
// Measures digging at the rate of a session: the time of a step, and the share of sand that has yet to move.
#include <cmath>
#include <numbers>

#include "bench/report/curves.hpp"
#include "bench/report/timing.hpp"
#include "bench/sand/piles.hpp"
#include "bench/sand/relaxations.hpp"
#include "sand/grid/erosion.hpp"
#include "sand/replica.hpp"
#include "scene/model/scene.hpp"

namespace bench {
namespace {

constexpr int kSteps = 200;       // per stroke
constexpr int kMostAfter = 2000;  // largest number of steps after lifting

struct Stroke {
    int side;
    double radius, speed;  // [cell], [cell per step]
    int sweeps;            // per step
};

scene::Scene sceneFor(const Stroke& stroke) {
    scene::Scene scene;
    scene.terrain = sand::HeightField(stroke.side, stroke.side, 1.0);
    scene.rules = rulesFor(scene.terrain, kTalus, 1e-3);
    scene.rules.tuning.sweepsPerStep = stroke.sweeps;
    scene.rules.stepsPerSecond = 60;
    scene.rules.tuning.tool.radius = static_cast<std::int32_t>(stroke.radius * sand::kProbePerCell);
    return scene;
}

sand::Step stepOf(const sand::Replica& replica, const Stroke& stroke, int number) {
    // The stroke is along the diagonal, because 480 cells and their banks then fit into a field of 512.
    const double at = stroke.side / 2.0 + stroke.speed * (number - kSteps / 2.0) / std::numbers::sqrt2;
    return {1, replica.stepNumber() + 1, true, {sand::probePoint(at, at, 0)}};
}

/// Digs one stroke and leaves the tool in the sand. Adds the time of each step to `seconds` [s]. Returns the last hash.
std::uint64_t digStroke(sand::Replica& replica, const Stroke& stroke, std::vector<double>& seconds) {
    std::uint64_t hash = 0;
    for (int i = 0; i <= kSteps; ++i) {
        const sand::Step step = stepOf(replica, stroke, i);
        const double took = secondsOf([&] {
            replica.apply(step);
            hash = replica.stateHash();
        });
        if (i > 0) {  // the first step presses the tool in, and touches every page for the first time
            seconds.push_back(took);
        }
    }
    return hash;
}

/// The sand at the end of a stroke, compared with settled sand.
struct Lag {
    double held = 0, lifted = 0;  // share of the displaced sand that still has to move
    double bank = 0;              // [cell]
    double bankReach = 0;         // [cell]
    int stepsAfter = 0;
};

/// Returns the volume of sand that has to move, divided by the volume of displaced sand. Each volume is half of a sum:
/// of |field - rest|, and of |rest|.
double behind(const sand::HeightField& field, const sand::HeightField& rest) { return misplaced(field, rest); }

Lag lagOf(sand::Replica& replica, const Stroke& stroke) {
    Lag lag;
    const sand::HeightField& field = std::get<sand::GridData>(replica.surface().data()).field;
    const sand::HeightField end = field;
    const sand::grid::Obstacle tool = sand::grid::Displacement(replica.tool()).obstacle(end, replica.probe());
    sand::HeightField held = end;
    sand::grid::Erosion(held, replica.rules()).sweep(held, kMostSweeps, &tool);
    sand::HeightField lifted = end;
    sweepToRest(lifted, replica.rules());
    lag.held = behind(end, held);
    lag.lifted = behind(end, lifted);
    for (int y = 0; y < stroke.side; ++y) {
        for (int x = 0; x < stroke.side; ++x) {
            lag.bank = std::max(lag.bank, static_cast<double>(end.height(x, y)) / sand::kUnitsPerCell);
            if (end.height(x, y) - lifted.height(x, y) > sand::kUnitsPerCell / 2) {
                lag.bankReach = std::max(lag.bankReach, std::abs(x - y) / std::numbers::sqrt2);
            }
        }
    }
    for (; lag.stepsAfter < kMostAfter && behind(field, lifted) > 0.01; ++lag.stepsAfter) {
        replica.apply({1, replica.stepNumber() + 1, false, {}});
    }
    return lag;
}

void measure(const Stroke& stroke, int runs, Csv& csv) {
    progress("N = {}, R = {}, {} cells per step, {} sweeps per step: {} strokes", stroke.side, stroke.radius,
             stroke.speed, stroke.sweeps, runs);
    std::vector<double> seconds;
    std::uint64_t hash = 0;
    Lag lag;
    for (int run = 0; run < runs; ++run) {
        sand::Replica replica(sceneFor(stroke));
        hash = digStroke(replica, stroke, seconds);
        if (run == 0) {
            lag = lagOf(replica, stroke);
        }
    }
    std::uint64_t idleHash = 0;
    std::vector<double> idle;
    idle.reserve(kSteps);
    sand::Replica settled(sceneFor(stroke));
    for (int i = 0; i < kSteps; ++i) {
        idle.push_back(secondsOf([&] {
            settled.apply({1, settled.stepNumber() + 1, false, {}});
            idleHash = settled.stateHash();
        }));
    }
    csv.row(stroke.side, stroke.radius, stroke.speed, stroke.sweeps, quantile(seconds, 0.5) * 1e3,
            quantile(seconds, 0.99) * 1e3, quantile(seconds, 1) * 1e3, quantile(idle, 0.5) * 1e6, lag.held, lag.lifted,
            lag.bank, lag.bankReach, lag.stepsAfter, fmt::format("{:016x}", hash ^ idleHash));
}

}  // namespace

void dig(const Settings& settings, Csv& csv) {
    csv.note(
        fmt::format("a stroke: a sphere of R cells, its centre at the level of the sand, dragged straight along the "
                    "diagonal for {} "
                    "steps; talus 34 degrees, band 1e-3",
                    kSteps));
    csv.note("ms: CPU time of one thread per step, hash included, over the steps of all strokes");
    csv.note(
        "misplaced_held: sum of |height - settled height| over the sum of |settled height - level|. The sand settles "
        "with the tool in its last place. This is sand that has yet to move over displaced sand");
    csv.note("misplaced_lifted: as misplaced_held, but settled without the tool, so that its hole fills too");
    csv.note("bank: highest sand over the level at the end of the stroke [cell]");
    csv.note(
        "bank_reach: largest distance from the stroke's line at which sand is half a cell above its settled height "
        "[cell]");
    csv.note("hash: combined hash of the sand at the end of the stroke and of level sand");
    csv.note("steps_after: number of steps after lifting until misplaced_lifted is 1 %");
    csv.columns(
        "N,R,cells_per_step,sweeps_per_step,ms_p50,ms_p99,ms_max,idle_us,misplaced_held,misplaced_lifted,bank,"
        "bank_reach,steps_after,hash");
    for (const int side : settings.sizes) {
        for (const double radius : {12.0, 2.56}) {
            for (const double speed : {1.5, 2.4}) {
                for (const int count : {1, 4, 8, 16, 32, 64, 128}) {
                    // The stroke and its banks need room along the diagonal.
                    if (speed * kSteps / std::numbers::sqrt2 + 6 * radius < side) {
                        measure({side, radius, speed, count}, settings.runs, csv);
                    }
                }
            }
        }
    }
}

}  // namespace bench
