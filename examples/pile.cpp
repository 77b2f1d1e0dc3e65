// SPDX-License-Identifier: Apache-2.0
// Smallest program that uses only sand/: a column of sand slides until it rests as a pile.
#include <cinttypes>
#include <cstdio>

#include "sand/replica.hpp"

int main() {
    constexpr int kSide = 65;       // [cell]
    constexpr double kCell = 0.01;  // [scene unit]
    sand::Start start;
    start.terrain = sand::HeightField(kSide, kSide, kCell);
    start.terrain.setHeight(kSide / 2, kSide / 2, 1200 * sand::kUnitsPerCell);  // a column 1200 cells high
    start.rules.columns = start.rules.rows = kSide;
    start.rules.tuning.threshold = sand::kUnitsPerCell;  // stable up to one cell per cell: 45 degrees
    start.rules.tuning.startThreshold = start.rules.tuning.threshold;
    start.rules.tuning.sweepsPerStep = 16;
    start.rules.stepsPerSecond = 60;
    start.rules.tuning.tool.radius = sand::kProbePerCell;

    sand::Replica replica(start);
    sand::Step step;
    while (step.number == 0 || !replica.settled()) {
        ++step.number;
        replica.apply(step);
    }
    const double unit = kCell / sand::kUnitsPerCell;
    const sand::HeightField& pile = std::get<sand::GridData>(replica.surface().data()).field;
    const bool exact = replica.volume() == start.terrain.volume();
    std::printf("%" PRIu64 " steps, %.3f high, volume %s, hash %016" PRIx64 "\n", step.number,
                pile.height(kSide / 2, kSide / 2) * unit, exact ? "exact" : "lost", replica.stateHash());
    return exact ? 0 : 1;
}
