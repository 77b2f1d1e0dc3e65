// SPDX-License-Identifier: Apache-2.0
// Measures the sand at borders, and searches for sand that passes a wall. scripts/checks/borders.sh builds and runs it.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <random>

#include "host/command_line.hpp"
#include "tests/support/border_planes.hpp"
#include "tests/support/held_tools.hpp"
#include "tests/support/tool_kinds.hpp"

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

/// Measures slopes of a TIN from which all sand has slid away below a tool that is held.
void measureSlopes(Table& table, int n) {
    using enum sand::ToolKind;
    for (const auto& [east, place] : {std::pair{64.7, "beyond an open rim"}, {58.0, "within an open rim"}}) {
        for (const sand::ToolKind kind : support::everyTool()) {
            const std::string at = fmt::format("slope below a tool, {}, TIN, {}", place, base::nameOf(kind));
            if (table.wants(at)) {
                const double lifted = borders::slideFromTool(n, kind, east, false).missing;
                const borders::OpenTable held = borders::slideFromTool(n, kind, east, true);
                table.row(fmt::format("{}: sand that is missing; without the tool {:.2f}", at, lifted), held.missing,
                          lifted + 0.2, "cell3");
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

/// A random number.
class Random {
public:
    explicit Random(std::uint32_t seed) : random_(seed) {}
    int below(int most) { return static_cast<int>(random_() % static_cast<std::uint32_t>(most)); }
    double within(double low, double high) { return low + (high - low) * below(4096) / 4096; }

private:
    std::mt19937 random_;
};

/// Returns a small scene with random walls, a random rim and a random tool.
borders::Case randomCase(Random& random) {
    borders::Case given;
    given.columns = 12 + random.below(28);
    given.rows = 12 + random.below(28);
    given.tin = random.below(2) == 0;
    given.widest = 1 + random.below(5);
    given.rim = random.below(3) == 0 ? sand::Rim::open : sand::Rim::closed;
    given.talus = random.within(0.1, 1.5);
    given.start = random.below(2) == 0 ? 0 : given.talus * random.within(1, 2);
    given.sweeps = 1 + random.below(16);
    given.tool = static_cast<sand::ToolKind>(random.below(sand::kToolKinds));
    given.radius = random.within(0.3, 6);
    struct Line {
        int x0, y0, x1, y1;
    };
    std::vector<Line> lines(static_cast<std::size_t>(1 + random.below(5)));
    for (Line& line : lines) {  // walls one cell thick, boxes, and the outlines of pockets
        line.x0 = random.below(given.columns);
        line.y0 = random.below(given.rows);
        line.x1 = random.below(2) == 0 ? line.x0 : line.x0 + random.below(given.columns);
        line.y1 = line.x1 == line.x0 ? line.y0 + random.below(given.rows) : line.y0 + random.below(4);
    }
    const int speckle = random.below(3) == 0 ? random.below(30) : 0;  // [%] of single cells
    std::vector<std::uint8_t> walls(static_cast<std::size_t>(given.columns) * static_cast<std::size_t>(given.rows));
    for (std::size_t i = 0; i < walls.size(); ++i) {
        const int x = static_cast<int>(i) % given.columns, y = static_cast<int>(i) / given.columns;
        const bool inLine = std::any_of(lines.begin(), lines.end(), [&](const Line& line) {
            return x >= line.x0 && x <= line.x1 && y >= line.y0 && y <= line.y1;
        });
        walls[i] = inLine || random.below(100) < speckle ? 1 : 0;
    }
    walls[static_cast<std::size_t>(random.below(static_cast<int>(walls.size())))] = 0;  // some ground is left
    given.wall = [walls, columns = given.columns](int x, int y) {
        return walls[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x)] !=
               0;
    };
    const double bump = random.within(0, 6);
    given.height = [bump](double x, double y) { return 8 + bump * std::sin(x) * std::cos(1.3 * y); };
    return given;
}

/// Plays a random session. Returns why it is wrong, or an empty text.
std::string playRandom(std::uint32_t seed) {
    Random random(seed);
    const borders::Case given = randomCase(random);
    sand::Replica sand(borders::sceneOf(given));
    const auto before = borders::volumesByPart(sand);
    const bool open = given.rim == sand::Rim::open;
    borders::Hand hand(sand);
    for (int i = 0; i < 30; ++i) {
        const double x = random.within(-3, given.columns + 3), y = random.within(-3, given.rows + 3);
        const sand::Edit::Kind edit = random.below(12) == 0   ? sand::Edit::settle
                                      : random.below(15) == 0 ? sand::Edit::undo
                                                              : sand::Edit::none;
        if (random.below(4) == 0) {
            hand.hover(edit);
        } else if (random.below(4) == 0) {
            hand.hold(edit);
        } else {
            const double far = random.within(0, 9);
            hand.apply(true,
                       {borders::probeAt(x, y, random.within(4, 16)),
                        borders::probeAt(x + far, y - far / 2, random.within(2, 16))},
                       edit);
        }
        // Over an open rim, sand of every part may leave. All parts together then keep their sum with the outflow.
        const auto now = borders::volumesByPart(sand);
        std::int64_t sum = sand.outflow();
        for (const auto& [place, volume] : before) {
            const auto found = now.find(place);
            const std::int64_t here = found == now.end() ? 0 : found->second;
            if (!open && here != volume) {
                return fmt::format("step {}: the part at {}, {} had {} and has {}", i, place.first, place.second,
                                   volume, here);
            }
            if (open && here > volume) {
                return fmt::format("step {}: the part at {}, {} has won {}", i, place.first, place.second,
                                   here - volume);
            }
            sum += here - volume;
        }
        if (sum != 0 || now.size() != before.size()) {
            return fmt::format("step {}: the volume has changed by {}", i, sum);
        }
    }
    sand::Replica other(borders::sceneOf(given));
    other.decodeState(sand.encodeState());
    return other.stateHash() == sand.stateHash() ? "" : "a replica that loads the state has another hash";
}

bool search(int scenes, std::uint32_t seed) {
    int wrong = 0;
    for (int i = 0; i < scenes; ++i) {
        std::string why;
        try {
            why = playRandom(seed + static_cast<std::uint32_t>(i));
        } catch (const std::exception& error) {
            why = error.what();
        }
        if (!why.empty()) {
            fmt::print("scene {}: {}\n", seed + static_cast<std::uint32_t>(i), why);
            std::fflush(stdout);
            ++wrong;
        }
    }
    fmt::print("{} of {} scenes are wrong\n", wrong, scenes);
    return wrong == 0;
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
            return search(options.search, options.seed) ? 0 : 1;
        }
        if (!options.dig.empty()) {
            return dig(options.dig, options.steps) ? 0 : 1;
        }
        return measure(options.size, options.only, options.list) ? 0 : 1;
    });
}
