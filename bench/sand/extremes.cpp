// SPDX-License-Identifier: Apache-2.0
// Brings sand at the ends of its ranges to rest: sweeps, volume, and the largest excess over the talus.
#include "bench/report/curves.hpp"
#include "tests/support/sand/extreme_worlds.hpp"

namespace bench {

void extremes(const Settings&, Csv& csv) {
    csv.note("worlds of tests/sand/grid/extreme_worlds_test.cpp; a unit is 2^-16 cells");
    csv.note("talus: difference of two cells at the talus [unit]; start: largest excess over it at the start [unit]");
    csv.note("excess: that at rest [unit]; measure: slope of a face by scheme G, face: difference of two cells,");
    csv.note("thickness: of a layer on rock that is steeper than the talus");
    csv.note("bound: what the excess may be at rest, by the formula `why`; stays 1: no sand may move");
    csv.note(
        "moved: sum of the differences of heights to the start [unit]; lost: volume at the start minus volume and");
    csv.note("outflow at the end [unit · cell]");
    csv.columns(
        "world,scheme,band,columns,rows,talus,sweeps,at_rest,moved,outflow,lost,measure,start,excess,bound,stays,why");
    for (const double width : {0.0, samples::kDefaultBand}) {
        const samples::Law law{sand::Scheme::isotropic, width};
        for (const ::extremes::World& world : ::extremes::worlds(law)) {
            progress("{}, band {}", world.name, width);
            const ::extremes::Outcome outcome = ::extremes::relax(world);
            const char* measure = world.measure == ::extremes::Measure::slope  ? "slope"
                                  : world.measure == ::extremes::Measure::face ? "face"
                                                                               : "thickness";
            csv.row(
                "\"" + world.name + "\"", "G", width, world.field.columns(), world.field.rows(), world.talus,
                outcome.sweeps, outcome.settled ? 1 : 0, outcome.moved, outcome.outflow, outcome.lost, measure,
                ::extremes::excessOf(world, world.field), outcome.excess,
                world.stays && world.measure == ::extremes::Measure::slope ? "" : fmt::format("{:.6g}", world.bound),
                world.stays ? 1 : 0, "\"" + world.why + "\"");
        }
    }
}

}  // namespace bench
