// SPDX-License-Identifier: Apache-2.0
// Measures the sand at borders, and searches for sand that passes a wall. scripts/borders.sh builds and runs it.
#include <fmt/format.h>

#include <cstdio>

#include "host/command_line.hpp"
#include "tests/support/border_experiments.hpp"

namespace {

constexpr borders::Ground kGrid{}, kTin{.tin = true}, kCoarse{.tin = true, .widest = 16};

struct Table {
    bool good = true;

    void row(const char* what, double value, double most, const char* unit) {
        const bool within = value <= most;
        good = good && within;
        fmt::print("{:<66} {:>9.3f} {:>9.3f} {:<6} {}\n", what, value, most, unit, within ? "ok" : "WRONG");
        std::fflush(stdout);
    }
};

bool measure(int n) {
    using enum sand::ToolKind;
    using enum borders::Where;
    Table table;
    fmt::print("{} cells a side; lengths as for 64\n{:<66} {:>9} {:>9}\n", n, "experiment", "measured", "at most");
    // A half pile must have half of the error of the whole pile.
    for (const auto& [ground, name] : {std::pair{kGrid, "grid"}, {kTin, "TIN"}}) {
        for (const bool settles : {false, true}) {
            table.row(fmt::format("half a pile at a closed rim, {}, {}", name, settles ? "settle" : "steps").c_str(),
                      borders::rimPile(ground, n, false, settles), 0.55 * borders::rimPile(ground, n, true, settles),
                      "cell3");
        }
    }
    const borders::Drag grid = borders::rimDrag(kGrid, n), fine = borders::rimDrag(kTin, n),
                        coarse = borders::rimDrag(kCoarse, n);
    table.row("drag along a closed rim against its mirror, grid", grid.misplaced, 10, "cell3");
    table.row("drag along a closed rim against its mirror, TIN", fine.misplaced, 10, "cell3");
    table.row("the same, largest difference", fine.largest, 0.5, "cell");
    table.row("the same on the default mesh; at most its own mirror error", coarse.misplaced,
              borders::mirrorError(kCoarse, n), "cell3");
    for (const double start : {1.62, 0.81 * 1.2}) {
        const borders::Steepness bank = borders::wetBank(n, start);
        table.row(fmt::format("bank that slides from a slope of {:.2f}, TIN: steepest / talus", start).c_str(),
                  bank.largest, 1.05, "");
        table.row("the same, share more than 2 % too steep", bank.tooSteep, 0.01, "");
    }
    for (const sand::ToolKind kind : {sphere, circle, rectangle, ellipse, ellipsoid, footprint}) {
        const auto name = [&](const char* what) { return fmt::format("{}, {}", what, sand::toolName(kind)); };
        table.row(name("through walls, grid").c_str(), borders::throughWalls(kGrid, n, kind), 0, "cell3");
        table.row(name("through walls, TIN").c_str(), borders::throughWalls(kTin, n, kind), 0, "cell3");
        table.row(name("over a ridge of rock, grid").c_str(), borders::overRidge(n, kind), 0, "cell3");
    }
    for (const auto& [where, place] : {std::pair{middle, "in the middle"}, {rim, "at a rim"}, {hole, "at a hole"}}) {
        for (const sand::ToolKind kind : {sphere, ellipsoid, circle, rectangle, ellipse}) {
            const bool bowl = kind == sphere || kind == ellipsoid;
            table.row(fmt::format("sand over the underside {}, TIN, {}", place, sand::toolName(kind)).c_str(),
                      borders::underTool(kTin, n, kind, where), bowl ? 0.4 : 1e-3, "cell");
        }
    }
    for (const auto& [ground, name] : {std::pair{kGrid, "grid"}, {kTin, "TIN"}}) {
        for (const bool atRest : {false, true}) {
            const borders::Held held = borders::heldSettle(ground, n, atRest);
            const char* const when = atRest ? "at rest" : "moving";
            table.row(fmt::format("settle with a tool held, {}, {}: sand over the underside", name, when).c_str(),
                      held.largest, ground.tin ? 0.4 : 0, "cell");
            table.row("the same, volume", held.volume, ground.tin ? 10 : 0, "cell3");
            table.row("the same, moves in the step after", held.still ? 0 : 1, 0, "");
        }
    }
    return table.good;
}

struct Options {
    int size = 64;
};

}  // namespace

int main(int argc, char** argv) {
    host::CommandLine line("Measures the sand at rims, walls, rock faces and holes.", "sand_borders");
    Options options;
    line.option("--size", options.size, "cells along a side").range(64, 512).showDefault();
    return host::runMain(line, argc, argv, [&] { return measure(options.size) ? 0 : 1; });
}
