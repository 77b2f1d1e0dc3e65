// SPDX-License-Identifier: Apache-2.0
// Measures the sand at borders, and searches for sand that passes a wall. scripts/checks/borders.sh builds and runs it.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "host/command_line.hpp"
#include "tests/sand/borders/random_scenes.hpp"
#include "tests/support/borders/border_planes.hpp"
#include "tests/support/borders/held_tools.hpp"
#include "tests/support/borders/tool_kinds.hpp"

namespace {

using borders::kCoarse;
using borders::kGrid;
using borders::kTin;

/// Experiments with their results. Leaves out an experiment whose name does not contain `only`.
class Table {
public:
    Table(std::string only, bool lists) : only_(std::move(only)), lists_(lists) {}

    /// Returns whether the experiment `name` is to be done. With --list, prints its name and returns false.
    [[nodiscard]] bool wants(const std::string& name) const {
        const bool chosen = name.find(only_) != std::string::npos;
        if (chosen && lists_) {
            fmt::print("{}\n", name);
        }
        return chosen && !lists_;
    }

    void row(const std::string& what, double value, double most, const char* unit) {
        const bool within = value <= most;
        good_ = good_ && within;
        fmt::print("{:<98} {:>9.4g} {:>9.4g} {:<6} {}\n", what, value, most, unit, within ? "ok" : "WRONG");
        std::fflush(stdout);
    }
    [[nodiscard]] bool good() const { return good_; }

private:
    std::string only_;
    bool lists_;
    bool good_ = true;
};

/// Measures piles and drags at closed rims, and damp banks.
void measureRims(Table& table, int n) {
    // A half pile must have half of the error of the whole pile, up to a tenth.
    for (const auto& [ground, name] : {std::pair{kGrid, "grid"}, {kTin, "TIN"}}) {
        for (const bool settles : {false, true}) {
            const std::string at =
                fmt::format("half a pile at a closed rim, {}, {}", name, settles ? "settle" : "steps");
            if (table.wants(at)) {
                const double whole = borders::rimPile(ground, n, true, settles);
                table.row(fmt::format("{}; the whole pile has {:.1f}", at, whole),
                          borders::rimPile(ground, n, false, settles), 0.55 * whole, "cell3");
            }
        }
    }
    if (table.wants("drag along a closed rim, grid")) {
        table.row("drag along a closed rim against its mirror, grid", borders::rimDrag(kGrid, n).misplaced, 10,
                  "cell3");
    }
    // A mesh differs from its mirror image, so that a drag in the middle leaves two different halves.
    if (table.wants("drag along a closed rim, TIN")) {
        const borders::Drag fine = borders::rimDrag(kTin, n);
        table.row("drag along a closed rim, TIN; at most the mesh's own mirror error", fine.misplaced,
                  borders::mirrorError(kTin, n), "cell3");
        table.row("the same, largest difference", fine.largest, 0.5, "cell");
    }
    if (table.wants("drag along a closed rim, default mesh")) {
        table.row("drag along a closed rim, default mesh; at most its own mirror error",
                  borders::rimDrag(kCoarse, n).misplaced, borders::mirrorError(kCoarse, n), "cell3");
    }
    for (const double start : {1.62, 0.81 * 1.2}) {
        const std::string at = fmt::format("bank that slides from a slope of {:.2f}, TIN", start);
        if (table.wants(at)) {
            const borders::Steepness bank = borders::wetBank(n, start);
            table.row(at + ": steepest / talus", bank.largest, 1.05, "");
            table.row("the same, share more than 2 % too steep", bank.tooSteep, 0.01, "");
        }
    }
}

/// Measures sand that a tool pushes through walls and over rock, and sand above a tool's underside.
void measureTools(Table& table, int n) {
    using enum sand::ToolKind;
    using enum borders::Where;
    for (const sand::ToolKind kind : support::everyTool()) {
        const auto measure = [&](const char* what, const auto& value) {
            const std::string name = fmt::format("{}, {}", what, base::nameOf(kind));
            if (table.wants(name)) {
                table.row(name, value(), 0, "cell3");
            }
        };
        measure("through walls, grid", [&] { return borders::throughWalls(kGrid, n, kind); });
        measure("through walls, TIN", [&] { return borders::throughWalls(kTin, n, kind); });
        measure("over a ridge of rock, grid", [&] { return borders::overRidge(n, kind); });
    }
    for (const auto& [where, place] : {std::pair{middle, "in the middle"}, {rim, "at a rim"}, {hole, "at a hole"}}) {
        for (const sand::ToolKind kind : {sphere, ellipsoid, circle, rectangle, ellipse}) {
            const bool bowl = kind == sphere || kind == ellipsoid;
            const std::string name = fmt::format("sand over the underside {}, TIN, {}", place, base::nameOf(kind));
            if (table.wants(name)) {
                table.row(name, borders::underTool(kTin, n, kind, where), bowl ? 0.4 : 1e-3, "cell");
            }
        }
    }
    for (const auto& [ground, name] : {std::pair{kGrid, "grid"}, {kTin, "TIN"}}) {
        for (const bool atRest : {false, true}) {
            const std::string at = fmt::format("settle with a tool held, {}, {}", name, atRest ? "at rest" : "moving");
            if (table.wants(at)) {
                const borders::Held held = borders::heldSettle(ground, n, atRest);
                table.row(at + ": sand over the underside", held.largest, ground.tin ? 0.4 : 0, "cell");
                table.row("the same, volume", held.volume, ground.tin ? 10 : 0, "cell3");
                table.row("the same, moves in the step after", held.still ? 0 : 1, 0, "");
            }
        }
    }
}

/// Measures planes of one kind of sand (O5) and the method of images at closed rims, walls or rock faces.
void measurePlane(Table& table, int n, const borders::Ground& ground, borders::Face face, const borders::Sand& sand) {
    const std::string at = fmt::format("{}, {}, {}", borders::nameOf(face), sand.name, ground.tin ? "TIN" : "grid");
    if (table.wants("plane at rest, " + at)) {
        double moved = 0;
        for (const double degrees : {0.0, 22.5, 45.0, 90.0}) {
            moved += borders::movedOfPlane(ground, n, face, sand, degrees, false, 0.95);
        }
        table.row("plane at rest, " + at, moved, 0, "cell3");
    }
    const std::string slid = "plane that has slid, error of its slope, " + at;
    // A plane of a TIN takes minutes.
    if ((!ground.tin || sand.name == "dry") && table.wants(slid)) {
        // A TIN takes a slope of up to 1.001 of the talus for the talus.
        table.row(slid, borders::errorOfSlidPlane(ground, n, face, sand, false), ground.tin ? 1e-3 : 1e-4, "");
    }
    const std::string images = "plane and piles against their mirror image, " + at;
    if (table.wants(images)) {
        const borders::Image image = borders::mirrored(ground, n, face, sand);
        // Beyond a grid's closed rim the ground continues with the same slope. Walls and rock are mirrors.
        const double most = ground.tin ? 0.3 * image.mirrorError : face == borders::Face::rim ? 0.015 * image.moved : 0;
        const std::string of = ground.tin ? fmt::format("the mesh's own error is {:.1f}", image.mirrorError)
                                          : fmt::format("{:.0f} have moved", image.moved);
        table.row(fmt::format("{}; {}", images, of), image.atRest, most, "cell3");
    }
}

void measurePlanes(Table& table, int n) {
    using enum borders::Face;
    for (const borders::Ground& ground : {kGrid, kTin}) {
        for (const borders::Face face : {rim, wall, rock}) {
            for (const borders::Sand& sand : borders::sands()) {
                if (!ground.tin || face != rock) {
                    measurePlane(table, n, ground, face, sand);
                }
            }
        }
    }
}

/// Measures the sand in tools that are held in corners, half outside the field, over walls, holes and rock.
void measureHeldTools(Table& table, int n) {
    using enum sand::ToolKind;
    for (const auto& [ground, name] : {std::pair{kGrid, "grid"}, {kTin, "TIN"}}) {
        for (const borders::HeldAt place : borders::kHeldAt) {
            for (const sand::ToolKind kind : support::everyTool()) {
                const std::string at =
                    fmt::format("settle around a tool, {}, {}, {}", borders::nameOf(place), name, base::nameOf(kind));
                if ((ground.tin && place == borders::HeldAt::overRock) || !table.wants(at)) {
                    continue;
                }
                const borders::HeldSettle held = borders::settleAround(ground, n, kind, place);
                const bool flat = kind == circle || kind == rectangle || kind == ellipse;
                table.row(at + ": sand in it", held.largest, !ground.tin ? 0 : flat ? 1e-3 : 0.4, "cell");
                const std::string why = borders::whyWrong(held);
                table.row("the same, volume, walls and rest" + (why.empty() ? "" : ": " + why), why.empty() ? 0 : 1, 0,
                          "");
            }
        }
    }
}

/// Measures slopes of a TIN below a tool that is held while sand slides over an open rim.
void measureSlopes(Table& table, int n) {
    struct Place {
        double east, height;  // [cell at n = 64]
        const char* name;
    };
    for (const Place& place :
         {Place{64.7, 20, "beyond an open rim"}, {58, 20, "within an open rim"}, {56, 12, "that touches it"}}) {
        for (const sand::ToolKind kind : support::everyTool()) {
            const std::string at = fmt::format("slope below a tool {}, {}", place.name, base::nameOf(kind));
            // A flat tool holds back the sand that touches it, so that the slope behind it is another one.
            const bool bowl = kind == sand::ToolKind::sphere || kind == sand::ToolKind::ellipsoid;
            if ((bowl || place.height == 20) && table.wants(at)) {
                const double lifted = borders::slideFromTool(n, {kind, place.east, place.height, false}).missing;
                const borders::OpenTable held = borders::slideFromTool(n, {kind, place.east, place.height, true});
                table.row(fmt::format("{}: sand missing; without it {:.2f}; {} sweeps", at, lifted, held.sweeps),
                          held.missing, lifted + 0.2, "cell3");
                table.row("the same, not at rest after 1000 steps", held.atRest ? 0 : 1, 0, "");
            }
        }
    }
}

bool measure(int n, const std::string& only, bool lists) {
    Table table(only, lists);
    if (!lists) {
        fmt::print("{} cells a side; lengths as for 64\n{:<98} {:>9} {:>9}\n", n, "experiment", "measured", "at most");
    }
    measureRims(table, n);
    measureTools(table, n);
    measurePlanes(table, n);
    measureHeldTools(table, n);
    measureSlopes(table, n);
    return table.good();
}

/// A scene whose instructions are counted, and the line x = `line` [cell] along which its tool goes up and down.
struct Work {
    borders::Case scene;
    double line = 32;
};

/// Returns the scenes for counting instructions. Scenes whose names begin with "near" have a wall or a rock face
/// beside the tool. In the others, the tool is in the middle of sand.
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
    std::string only;
    bool list = false;
    std::string dig;
    int steps = 200;
    int search = 0;
    std::uint32_t seed = 1;
};

}  // namespace

int main(int argc, char** argv) {
    host::CommandLine line("Measures the sand at rims, walls, rock faces and holes.", "sand_borders");
    Options options;
    line.option("--size", options.size, "cells along a side").range(64, 512).showDefault();
    line.option("--only", options.only, "measure only the experiments whose names contain this text");
    line.flag("--list", options.list, "print the names of the experiments, and measure nothing");
    line.option(
        "--dig", options.dig,
        "dig in a scene to count instructions: grid, wall, near-wall, rock, near-rock, tin, rim-tin, hole-tin or "
        "near-hole-tin");
    line.option("--steps", options.steps, "of --dig").range(1, 1000000).showDefault();
    line.option("--search", options.search, "play so many random scenes, and compare the volume of each part")
        .range(0, 1000000);
    line.option("--seed", options.seed, "of the first random scene").showDefault();
    return host::runMain(line, argc, argv, [&] {
        if (options.search > 0) {
            return borders::playRandomScenes(options.search, options.seed) ? 0 : 1;
        }
        if (!options.dig.empty()) {
            return dig(options.dig, options.steps) ? 0 : 1;
        }
        return measure(options.size, options.only, options.list) ? 0 : 1;
    });
}
