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

/// A scene whose instructions are counted, and the line x = `line` [cell] along which its tool goes up and down.
struct Work {
    borders::Case scene;
    double line = 32;
};

/// Returns the scenes for counting instructions. Scenes whose names begin with "near" have a wall or a rock face in the
/// tool's surroundings; in the others the tool is in the middle of sand.
Work workOf(const std::string& name) {
    Work work;
    borders::Case& scene = work.scene;
    scene.columns = scene.rows = 96;
    scene.sweeps = 16;
    scene.height = [](double x, double y) { return 8 + 1.5 * std::sin(x / 5) + std::sin((x + y) / 7); };
    scene.tin = name.find("tin") != std::string::npos;
    if (name.find("wall") != std::string::npos || name.find("hole") != std::string::npos) {
        scene.wall = [](int x, int) { return x == 64; };
    }
    if (name.find("rock") != std::string::npos) {
        scene.rock = [](double x, double) { return x > 64 && x < 65 ? 60.0 : 0.0; };
    }
    work.line = name.starts_with("near") ? 62 : name.starts_with("rim") ? 95 : 32;
    return work;
}

/// Digs for `steps` steps along a line. Run it under `valgrind --tool=callgrind` to count its instructions.
bool dig(const std::string& name, int steps) {
    const Work work = workOf(name);
    sand::Replica sand(borders::sceneOf(work.scene));
    borders::Hand hand(sand);
    for (int i = 0; i < steps; ++i) {
        const int at = i % 96 < 48 ? i % 96 : 96 - i % 96;
        hand.press(work.line, 12 + 1.5 * at, 8 + 3);
    }
    fmt::print("{} {:016x}\n", name, sand.stateHash());
    return true;
}

struct Options {
    int size = 64;
    std::string dig;
    int steps = 200;
};

}  // namespace

int main(int argc, char** argv) {
    host::CommandLine line("Measures the sand at rims, walls, rock faces and holes.", "sand_borders");
    Options options;
    line.option("--size", options.size, "cells along a side").range(64, 512).showDefault();
    line.option("--dig", options.dig,
                "dig in a scene to count instructions: grid, wall, near-wall, rock, near-rock, tin, rim-tin, hole-tin or "
                "near-hole-tin");
    line.option("--steps", options.steps, "of --dig").range(1, 1000000).showDefault();
    return host::runMain(line, argc, argv, [&] {
        return (options.dig.empty() ? measure(options.size) : dig(options.dig, options.steps)) ? 0 : 1;
    });
}
