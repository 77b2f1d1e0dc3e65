// SPDX-License-Identifier: Apache-2.0
// Measures digging at the rate of a session: the time of a step, and the share of sand that has yet to move.
#include <cmath>
#include <memory>
#include <numbers>

#include "bench/report/curves.hpp"
#include "bench/report/timing.hpp"
#include "bench/sand/dig_lag.hpp"
#include "bench/sand/relaxations.hpp"
#include "tests/support/sand/tin_piles.hpp"

namespace bench {
namespace {

constexpr int kSteps = 200;         // per stroke
constexpr int kLargestTin = 512;    // [cell], side of the largest field that is a TIN, too
constexpr double kSlowRadius = 12;  // [cell], largest tool that makes all strokes
constexpr double kTinRadius = 12;   // [cell], largest tool in a TIN
constexpr double kTinSpeed = 1.5;   // [cell per step]

struct Stroke {
    bool tin;
    int side;
    double radius, speed;  // [cell], [cell per step]
    int sweeps;            // per step

    /// Returns whether the stroke and its banks have room along the diagonal.
    [[nodiscard]] bool fits() const { return speed * kSteps / std::numbers::sqrt2 + 6 * radius < side; }
    [[nodiscard]] bool measured() const {
        const bool inTin = side <= kLargestTin && radius <= kTinRadius && speed == kTinSpeed &&
                           (sweeps == 4 || sweeps == 16 || sweeps == 64);
        // The banks of a large tool are hundreds of cells high. Their sand takes minutes to come to rest.
        const bool inGrid = radius <= kSlowRadius ||
                            (speed == kTinSpeed && (sweeps == 128 || sweeps == 64 || sweeps == 16 || sweeps == 4));
        return fits() && (tin ? inTin : inGrid);
    }
};

scene::Scene sceneFor(const Stroke& stroke) {
    scene::Scene scene;
    scene.terrain = sand::HeightField(stroke.side, stroke.side, 1.0);
    scene.rules = rulesFor(scene.terrain, kTalus, 1e-3);
    scene.rules.tuning.sweepsPerStep = stroke.sweeps;
    scene.rules.stepsPerSecond = 60;
    scene.rules.tuning.tool.radius = static_cast<std::int32_t>(stroke.radius * sand::kProbePerCell);
    if (stroke.tin) {
        scene.tin = std::make_shared<const sand::tin::TinStart>(tin_piles::levelStart(stroke.side, 1));
    }
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

/// Returns the median time of a step of settled sand [s], and its hash.
std::pair<double, std::uint64_t> idle(const Stroke& stroke) {
    std::uint64_t hash = 0;
    std::vector<double> seconds;
    seconds.reserve(kSteps);
    sand::Replica settled(sceneFor(stroke));
    for (int i = 0; i < kSteps; ++i) {
        seconds.push_back(secondsOf([&] {
            settled.apply({1, settled.stepNumber() + 1, false, {}});
            hash = settled.stateHash();
        }));
    }
    return {quantile(seconds, 0.5), hash};
}

void measure(const Stroke& stroke, int most, Csv& csv) {
    const char* kind = stroke.tin ? "TIN" : "grid";
    progress("{}, N = {}, R = {}, {} cells per step, {} sweeps per step", kind, stroke.side, stroke.radius,
             stroke.speed, stroke.sweeps);
    std::vector<double> seconds;
    std::uint64_t hash = 0;
    Lag lag;
    int run = 0;
    for (int runs = 1; run < runs; ++run) {
        sand::Replica replica(sceneFor(stroke));
        const double took = secondsOf([&] { hash = digStroke(replica, stroke, seconds); });
        if (run == 0) {
            runs = runsFor(took, most);
            lag = stroke.tin ? lagOfTin(replica, stroke.side) : lagOfGrid(replica);
        }
    }
    const auto [idleSeconds, idleHash] = idle(stroke);
    csv.row(kind, stroke.side, stroke.radius, stroke.speed, stroke.sweeps, run, quantile(seconds, 0.5) * 1e3,
            quantile(seconds, 0.99) * 1e3, quantile(seconds, 1) * 1e3, idleSeconds * 1e6, lag.held, lag.lifted,
            lag.bank, lag.bankReach, lag.stepsAfter, fmt::format("{:016x}", hash ^ idleHash));
}

}  // namespace

void dig(const Settings& settings, Csv& csv) {
    csv.note(
        fmt::format("a stroke: a sphere of R cells, its centre at the level of the sand, dragged straight along the "
                    "diagonal for {} steps; talus 34 degrees, band 1e-3",
                    kSteps));
    csv.note("TIN: one vertex per cell, at a random place of the cell; heights are compared at the middles of cells");
    csv.note("ms: CPU time of one thread per step, hash included, over the steps of all strokes");
    csv.note("runs: strokes, " + runsRule(settings.runs));
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
        "sand,N,R,cells_per_step,sweeps_per_step,runs,ms_p50,ms_p99,ms_max,idle_us,misplaced_held,misplaced_lifted,"
        "bank,bank_reach,steps_after,hash");
    for (const int side : settings.sizes) {
        for (const bool tin : {false, true}) {
            for (const double radius : {61.0, 30.0, 12.0, 6.0, 2.56}) {
                for (const double speed : {1.5, 2.4}) {
                    for (const int count : {1, 4, 8, 16, 32, 64, 128}) {
                        const Stroke stroke{tin, side, radius, speed, count};
                        if (stroke.measured()) {
                            measure(stroke, settings.runs, csv);
                        }
                    }
                }
            }
        }
    }
}

}  // namespace bench
