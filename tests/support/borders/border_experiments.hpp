// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tests/support/borders/border_scenes.hpp"
#include "tests/support/sand/oracles.hpp"

/// Experiments at borders. `n` is the number of cells along a field. All lengths grow with n, and a scene of 64 cells
/// has a tool with a radius of 6 cells. The result of a mirrored experiment or a closed form is known.
namespace borders {

struct Ground {
    bool tin = false;
    int widest = 1;  // of a TIN
};
inline constexpr Ground kGrid{}, kTin{.tin = true}, kCoarse{.tin = true, .widest = 16};
inline constexpr std::array kGrounds{kGrid, kTin};
inline constexpr int kSide = 64;  // of the fields of tests

inline Case caseOf(const Ground& ground, int n) {
    Case result;
    result.columns = result.rows = n;
    result.tin = ground.tin;
    result.widest = ground.widest;
    result.radius = 6.0 * n / 64;
    result.sweeps = std::max(8, 8 * n * n / 64 / 64);
    return result;
}

/// O1 against a closed rim: half a cylinder in the west, or with `whole`, the whole cylinder on a field of 2 n x n.
/// Returns the misplaced volume [cell³ at n = 64].
inline double rimPile(const Ground& ground, int n, bool whole, bool settles) {
    Case given = caseOf(ground, n);
    const double scale = n / 64.0, middle = whole ? n : 0;
    given.columns = whole ? 2 * n : n;
    const oracles::Cylinder pile(12 * scale, 8 * scale, kTalus);
    given.height = [&](double x, double y) { return pile.start(std::hypot(x - middle, y - n / 2.0)); };
    sand::Replica sand(sceneOf(given));
    Hand hand(sand);
    if (settles) {
        hand.hover(sand::Edit::settle);
    }
    hand.rest();
    return misplaced(sand, [&](double x, double y) { return pile.rest(std::hypot(x - middle, y - n / 2.0)); }) / scale /
           scale / scale;
}

/// Obstacle that sand leans against.
enum class Face { rim, corner, wall, rock };
inline std::string nameOf(Face face) {
    constexpr std::array kNames{"rim", "corner", "wall", "rock"};
    return kNames[static_cast<std::size_t>(face)];
}

constexpr int kFaceCells = 4;  // cells west of the sand that leans against a wall or a rock face

/// Puts a face west of the sand. Returns the place of the face [cell from the west].
inline double putFace(Case& given, Face face) {
    if (face == Face::wall) {
        given.wall = [](int x, int) { return x == kFaceCells - 1; };
    } else if (face == Face::rock) {
        given.rock = [](double x, double) { return x > kFaceCells - 1 && x < kFaceCells ? 1000.0 : 0.0; };
    }
    return face == Face::wall || face == Face::rock ? kFaceCells : 0;
}

/// Released sand that leans against a face in the west: half a cylinder (O1), a quarter of one in a corner, or half a
/// prism (O2). Returns the misplaced volume as a share of the pile. `band` is the share by which the slope that starts
/// a slide exceeds the talus.
inline double leaningPile(const Ground& ground, int n, Face face, bool prism, double band = 0) {
    Case given = caseOf(ground, n);
    const double scale = n / 64.0, west = putFace(given, face);
    const double south = face == Face::corner ? 0 : n / 2.0;
    const oracles::Cylinder cylinder(12 * scale, 8 * scale, kTalus);
    const oracles::Prism wide(12 * scale, 8 * scale, kTalus);
    const auto distance = [=](double x, double y) { return prism ? x - west : std::hypot(x - west, y - south); };
    given.start = kTalus * (1 + band);
    given.height = [&](double x, double y) {
        const double r = distance(x, y);
        return x < west ? 0 : prism ? wide.start(r) : cylinder.start(r);
    };
    sand::Replica sand(sceneOf(given));
    Hand(sand).rest();
    double whole = 0;
    const auto right = [&](double x, double y) {
        const double r = distance(x, y);
        return prism ? wide.rest(r) : cylinder.rest(r);
    };
    for (int y = 0; y < n; ++y) {
        for (int x = static_cast<int>(west); x < n; ++x) {
            whole += right(x + 0.5, y + 0.5);
        }
    }
    return misplaced(sand, right, [=](double x, double) { return x > west; }) / whole;
}

/// The method of images. A tool is dragged along a closed rim, half of it outside. It must leave half of the sand that
/// it leaves in the middle of a field twice as wide. Both drags go from south to north at the east rim of the western
/// half.
struct Drag {
    double misplaced = 0, largest = 0;  // [cell³ at n = 64], [cell]
};
inline Drag rimDrag(const Ground& ground, int n, sand::ToolKind kind = sand::ToolKind::sphere) {
    const double scale = n / 64.0;
    Case given = caseOf(ground, n);
    given.tool = kind;
    given.height = [&](double, double) { return 8 * scale; };
    sand::Replica half(sceneOf(given));
    given.columns = 2 * n;
    sand::Replica whole(sceneOf(given));
    for (sand::Replica* sand : {&half, &whole}) {
        Hand hand(*sand);
        hand.drag(n, n / 4.0, n, 3 * n / 4.0, 8 * scale + given.radius * (1 - 0.8));
        hand.rest();
    }
    Drag result;
    for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) {
            const double apart = std::abs(heightAt(half, x + 0.5, y + 0.5) - heightAt(whole, x + 0.5, y + 0.5));
            result.misplaced += apart / scale / scale / scale;
            result.largest = std::max(result.largest, apart / scale);
        }
    }
    return result;
}

/// Returns the difference between the sand that a drag along the middle of a field leaves in the west and in the
/// east. The mesh alone causes it [cell³ at n = 64].
inline double mirrorError(const Ground& ground, int n) {
    const double scale = n / 64.0;
    Case given = caseOf(ground, n);
    given.columns = 2 * n;
    given.height = [&](double, double) { return 8 * scale; };
    sand::Replica sand(sceneOf(given));
    Hand hand(sand);
    hand.drag(n, n / 4.0, n, 3 * n / 4.0, 8 * scale + given.radius * (1 - 0.8));
    hand.rest();
    double sum = 0;
    for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) {
            sum += std::abs(heightAt(sand, x + 0.5, y + 0.5) - heightAt(sand, 2 * n - x - 0.5, y + 0.5));
        }
    }
    return sum / scale / scale / scale;
}

/// A damp bank of slope 2.5. Cohesion bears a slope of 1.62, so that it slides, and must stop at the talus of 0.81.
/// Returns the steepness of the bank at rest, away from the field's ends.
inline Steepness wetBank(int n, double start) {
    const double scale = n / 64.0;
    Case given = caseOf({.tin = true}, n);
    given.talus = 0.81;
    given.start = start;
    given.height = [=](double x, double) { return std::clamp(10 * scale - 2.5 * (x - n / 2.0), 0.0, 20 * scale); };
    sand::Replica sand(sceneOf(given));
    Hand(sand).rest();
    return steepnessOf(sand, given.talus, [=](double x, double) { return x > n / 4.0 && x < 3 * n / 4.0; });
}

/// Level sand on both sides of a wall one cell wide, and in a pocket of walls.
inline Case walled(const Ground& ground, int n, sand::ToolKind kind) {
    Case given = caseOf(ground, n);
    const int middle = n / 2, from = 11 * n / 16, to = 14 * n / 16;
    const double scale = n / 64.0;
    given.tool = kind;
    given.radius = 4 * scale;
    given.height = [=](double, double) { return 8 * scale; };
    given.wall = [=](int x, int y) {
        const bool line = x == middle;
        const bool inside = x > from && x < to && y > from && y < to;
        const bool box = x >= from && x <= to && y >= from && y <= to;
        return line || (box && !inside);
    };
    return given;
}

/// A tool dragged against a wall, along it, through it at an angle, and over the pocket's border. Returns the volume
/// that has passed a wall [cell³ at n = 64].
inline double throughWalls(const Ground& ground, int n, sand::ToolKind kind) {
    const Case given = walled(ground, n, kind);
    const double scale = n / 64.0, z = 8 * scale;
    sand::Replica sand(sceneOf(given));
    const sand::Replica before = sand;
    Hand hand(sand);
    hand.drag(n / 8.0, n / 2.0, n / 2.0 - scale, n / 2.0, z);
    hand.hover();
    hand.drag(n / 2.0 - 2 * scale, n / 8.0, n / 2.0 - 2 * scale, 7 * n / 8.0, z);
    hand.hover();
    hand.drag(n / 4.0, n / 8.0, 5 * n / 8.0, n / 2.0, z);
    hand.hover();
    hand.drag(5 * n / 8.0, 3 * n / 4.0, 13 * n / 16.0, 3 * n / 4.0, z);
    hand.rest();
    return exchanged(before, sand) / scale / scale / scale;
}

/// A tool that crosses a wall one cell wide at an angle, there and back. Returns the volume that has passed the wall
/// [cell³ at n = 64].
inline double acrossWall(const Ground& ground, int n, sand::ToolKind kind, double degrees) {
    const Case given = walled(ground, n, kind);
    const double scale = n / 64.0, z = 8 * scale;
    sand::Replica sand(sceneOf(given));
    const sand::Replica before = sand;
    Hand hand(sand);
    const double east = 10 * scale * std::cos(degrees / 57.29578), north = 10 * scale * std::sin(degrees / 57.29578);
    const double x = n / 2.0 + 0.3, y = n / 2.0 + 0.2;
    hand.drag(x - east, y - north, x + east, y + north, z);
    hand.drag(x + east, y + north, x - east, y - north, z);
    hand.rest();
    return exchanged(before, sand) / scale / scale / scale;
}

/// Bare rock 60 cells high between two fields of level sand, and a tool whose underside stays below the rock's top.
/// Returns the volume that has passed the rock [cell³ at n = 64].
inline double overRidge(int n, sand::ToolKind kind) {
    const double scale = n / 64.0, z = 8 * scale;
    Case given = caseOf({}, n);
    given.tool = kind;
    given.radius = 4 * scale;
    given.height = [=](double, double) { return 8 * scale; };
    given.rock = [=](double x, double) { return x > n / 2.0 && x < n / 2.0 + 1 ? 60 * scale : 0; };
    sand::Replica sand(sceneOf(given));
    const auto west = [&] {
        std::int64_t sum = 0;
        for (int y = 0; y < n; ++y) {
            for (int x = 0; x < n / 2; ++x) {
                sum += samples::fieldOf(sand).height(x, y);
            }
        }
        return sum;
    };
    const std::int64_t before = west();
    Hand hand(sand);
    hand.drag(n / 8.0, n / 2.0, n / 2.0 - scale, n / 2.0, z);
    hand.hover();
    hand.drag(n / 2.0 - 2 * scale, n / 8.0, n / 2.0 - 2 * scale, 7 * n / 8.0, z);
    hand.rest();
    return std::abs(static_cast<double>(west() - before)) / sand::kUnitsPerCell / scale / scale / scale;
}

enum class Where { middle, rim, hole };

/// A tool is pressed into level sand a radius deep, dragged and held. Its place is in the middle, half outside a closed
/// rim, or over the border of a hole. Returns how far the sand is above its underside [cell at n = 64].
inline double underTool(const Ground& ground, int n, sand::ToolKind kind, Where where) {
    const double scale = n / 64.0;
    Case given = where == Where::hole ? walled(ground, n, kind) : caseOf(ground, n);
    given.tool = kind;
    given.radius = 6 * scale;
    given.height = [=](double, double) { return 20 * scale; };
    sand::Replica sand(sceneOf(given));
    Hand hand(sand);
    const double east = where == Where::middle ? 39.3 : where == Where::rim ? 62.7 : 30.1;
    hand.drag((where == Where::middle ? 22.4
               : where == Where::rim  ? 60.8
                                      : 16.4) *
                  scale,
              28.8 * scale, east * scale, 36.2 * scale, 20 * scale);
    for (int i = 0; i < 100; ++i) {
        hand.hold();
    }
    return overUnderside(sand, sand.probe()) / scale;
}

/// A tool that is held two radii deep while the operator settles the sand. With `atRest`, the sand is at rest before.
struct Held {
    double largest = 0, volume = 0;  // of the sand above the underside [cell], [cell³] at n = 64
    bool still = false;              // whether a step after the settle moved nothing
};
inline Held heldSettle(const Ground& ground, int n, bool atRest) {
    const double scale = n / 64.0;
    Case given = caseOf(ground, n);
    given.height = [=](double, double) { return 20 * scale; };
    given.maxError = 0;  // because a vertex that is removed moves the surface beside it
    given.sweeps = 4;
    sand::Replica sand(sceneOf(given));
    Hand hand(sand);
    const double x = 32.2 * scale, y = 32.3 * scale, z = 20 * scale - given.radius;
    hand.press(x, y, z);
    for (int i = 0; atRest && i < 20000 && !sand.settled(); ++i) {
        hand.hold();
    }
    hand.hold(sand::Edit::settle);
    for (int i = 0; i < 20000 && !sand.settled(); ++i) {
        hand.hold();
    }
    Held result;
    const sand::ProbePoint probe = sand.probe();
    result.largest = overUnderside(sand, probe) / scale;
    const sand::TurnedShape turned(sand.tool());
    for (int row = 0; row < n; ++row) {
        for (int column = 0; column < n; ++column) {
            const sand::Offset offset{std::int64_t{column} * 256 + 128 - probe.x,
                                      std::int64_t{row} * 256 + 128 - probe.y};
            if (turned.covers(offset)) {
                const double under = static_cast<double>(turned.underside(probe.z, offset)) / sand::kUnitsPerCell;
                result.volume += std::max(heightAt(sand, column + 0.5, row + 0.5) - under, 0.0) / scale / scale / scale;
            }
        }
    }
    const auto before = sand.copySand()->encode();
    hand.hold();
    result.still = sand.copySand()->encode() == before;
    return result;
}

}  // namespace borders
