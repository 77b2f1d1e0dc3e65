// SPDX-License-Identifier: Apache-2.0
// Measures one edit. Resting sand in other places should add no time.
#include "bench/report/curves.hpp"
#include "bench/report/timing.hpp"
#include "bench/sand/relaxations.hpp"
#include "sand/grid/erosion.hpp"
#include "sand/grid/tile_hash.hpp"

namespace bench {
namespace {

constexpr int kStepSweeps = 16;  // per step

struct Costs {
    std::vector<double> step;    // [s], the press and kStepSweeps sweeps
    std::vector<double> toRest;  // [s], the press and all sweeps until nothing moves
    std::uint64_t hash = 0;      // of the sand after kStepSweeps sweeps
};

Costs measure(int side, double radius, bool skipSettled, int runs) {
    const sand::HeightField level(side, side, 1.0);
    const sand::Rules rules = rulesFor(level, kTalus);
    const sand::grid::Displacement tool({.radius = static_cast<std::int32_t>(radius * sand::kProbePerCell)});
    const sand::ProbePoint probe = sand::probePoint(side / 2.0, side / 2.0, 0);
    sand::grid::Erosion::Options options;
    options.skipSettled = skipSettled;
    Costs costs;
    for (int run = 0; run < runs; ++run) {
        sand::HeightField field = level;
        sand::grid::Erosion erosion(field, rules, options);
        erosion.sweep(field, 2);
        const double before = cpuSeconds();
        erosion.touch(tool.drag(field, rules.rim, nullptr, probe, probe).cells);
        erosion.sweep(field, kStepSweeps);
        costs.step.push_back(cpuSeconds() - before);
        costs.hash = sand::grid::TileHash(field).sum();
        if (skipSettled) {
            const double paused = cpuSeconds();
            erosion.sweep(field, kMostSweeps);
            costs.toRest.push_back(costs.step.back() + cpuSeconds() - paused);
        }
    }
    return costs;
}

}  // namespace

void edit(const Settings& settings, Csv& csv) {
    csv.note(fmt::format("an edit: a sphere of `radius` cells presses half of itself into level sand, then {} sweeps",
                         kStepSweeps));
    csv.note("full: every block is visited in every sweep, and the sand is the same bit for bit");
    csv.note("CPU time of one thread; hash: of the sand after these sweeps");
    csv.columns("blocks,N,radius,runs,ms_median,ms_min,ms_max,ms_to_rest,hash");
    for (const int side : settings.sizes) {
        for (const double radius : {2.56, 4.0, 8.0, 12.0, 16.0, 32.0}) {
            if (4 * radius > side) {
                continue;
            }
            for (const bool skipSettled : {true, false}) {
                progress("N = {}, R = {}, {} blocks", side, radius, skipSettled ? "active" : "all");
                const Costs costs = measure(side, radius, skipSettled, settings.runs);
                const Spread step = spreadOf(costs.step);
                csv.row(skipSettled ? "active" : "full", side, radius, settings.runs, step.median * 1e3,
                        step.lowest * 1e3, step.highest * 1e3,
                        skipSettled ? fmt::format("{:.6g}", spreadOf(costs.toRest).median * 1e3) : "",
                        fmt::format("{:016x}", costs.hash));
            }
        }
    }
}

}  // namespace bench
