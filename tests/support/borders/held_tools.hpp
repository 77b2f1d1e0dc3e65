// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tests/support/borders/border_experiments.hpp"

/// Tools that are held in corners, half outside the field, and over walls, while the operator settles the sand.
namespace borders {

/// Place of a tool that is held, in fields with closed rims unless it says open.
enum class HeldAt { inCorner, outsideCorner, outsideRim, outsideOpenRim, overWall, overPocket, overRock };
inline constexpr std::array kHeldAt{HeldAt::inCorner, HeldAt::outsideCorner, HeldAt::outsideRim, HeldAt::outsideOpenRim,
                                    HeldAt::overWall, HeldAt::overPocket,    HeldAt::overRock};
inline std::string nameOf(HeldAt place) {
    constexpr std::array kNames{"in a corner",        "beyond a corner",  "beyond a closed rim",
                                "beyond an open rim", "over a thin wall", "over a pocket",
                                "over rock"};
    return kNames[static_cast<std::size_t>(place)];
}

struct HeldSettle {
    double largest = 0;        // of the sand above the tool's underside [cell at n = 64]
    std::int64_t changed = 0;  // of the volume of all sand with the outflow [volume unit]
    double exchanged = 0;      // volume that has passed a wall [cell³]
    bool atRest = false;       // whether sweeps have found all sand at rest
    bool still = false;        // whether a step after the settle changed nothing
};

/// Returns what is wrong with a settle, or an empty text.
inline std::string whyWrong(const HeldSettle& held) {
    std::string why;
    for (const auto& [wrong, what] : {std::pair{held.changed != 0, "the volume has changed"},
                                      {held.exchanged > 0, "sand has passed a wall"},
                                      {!held.atRest, "sweeps have not found all sand at rest"},
                                      {!held.still, "the next step has changed the sand"}}) {
        why += !wrong ? "" : why.empty() ? what : std::string(", ") + what;
    }
    return why;
}

/// A tool is dragged to its place and pressed a radius deep into uneven sand. The operator settles the sand.
inline HeldSettle settleAround(const Ground& ground, int n, sand::ToolKind kind, HeldAt place) {
    const double scale = n / 64.0;
    const bool walls = place == HeldAt::overWall || place == HeldAt::overPocket;
    Case given = walls ? walled(ground, n, kind) : caseOf(ground, n);
    given.tool = kind;
    given.radius = 6 * scale;
    given.sweeps = 4;
    given.maxError = 0;  // because a vertex that is removed moves the surface beside it
    given.rim = place == HeldAt::outsideOpenRim ? sand::Rim::open : sand::Rim::closed;
    given.height = [=](double x, double y) {
        return scale * (20 + 4 * std::sin(x / scale / 5) * std::cos(y / scale / 6));
    };
    if (place == HeldAt::overRock) {
        given.rock = [=](double x, double) { return x > n / 2.0 && x < n / 2.0 + 2 * scale ? 14 * scale : 0; };
    }
    const auto [x, y] = [&]() -> std::pair<double, double> {
        switch (place) {
            case HeldAt::inCorner:
                return {2.3, 1.8};
            case HeldAt::outsideCorner:
                return {-1.6, -2.1};
            case HeldAt::outsideRim:
            case HeldAt::outsideOpenRim:
                return {64.7, 30.2};
            case HeldAt::overPocket:
                return {48.3, 47.6};
            default:
                return {32.6, 20.4};
        }
    }();
    sand::Replica sand(sceneOf(given));
    const sand::Replica before = sand;
    Hand hand(sand);
    hand.drag((x + 4) * scale, (y + 7) * scale, x * scale, y * scale, 20 * scale);
    hand.hold(sand::Edit::settle);
    for (int i = 0; i < 20000 && !sand.settled(); ++i) {
        hand.hold();
    }
    HeldSettle result;
    result.largest = overUnderside(sand, sand.probe()) / scale;
    result.changed = sand.volume() + sand.outflow() - before.volume();
    result.exchanged = given.rim == sand::Rim::open ? 0 : borders::exchanged(before, sand);
    const auto settled = sand.copySand()->encode();
    hand.hold();
    result.atRest = sand.settled();
    result.still = sand.copySand()->encode() == settled;
    return result;
}

/// Place of a tool beside the east rim of an open table, and whether it is held or lifted while the sand settles. At a
/// height of 20 cells it is above the slope that stays. At 12 cells the slope touches one side of it.
struct SlopeTool {
    sand::ToolKind kind;
    double east, height;  // of its centre [cell at n = 64]
    bool held;
};
struct OpenTable {
    double missing = 0, deepest = 0;  // of the sand against an open table [cell³], [cell] at n = 64
    std::int64_t sweeps = 0;          // until all sand is at rest
    bool atRest = false;
};
/// A tool is pressed into level sand on an open table. The operator settles the sand, which slides over the rim.
inline OpenTable slideFromTool(int n, const SlopeTool& tool) {
    const double scale = n / 64.0, north = 30.2 * scale, x0 = tool.east * scale;
    Case given = caseOf(kTin, n);
    given.tool = tool.kind;
    given.sweeps = 4;
    given.maxError = 0;
    given.rim = sand::Rim::open;
    given.height = [=](double, double) { return 20 * scale; };
    sand::Replica sand(sceneOf(given));
    Hand hand(sand);
    hand.drag(x0 + 4 * scale, north + 7 * scale, x0, north, tool.height * scale);
    if (!tool.held) {
        hand.hover();
    }
    OpenTable result;
    for (int i = 0; i < 1000 && (i == 0 || !sand.settled()); ++i) {
        hand.apply(tool.held, {}, i == 0 ? sand::Edit::settle : sand::Edit::none);
        result.sweeps += sand.lastWork().sweeps;
    }
    const sand::TurnedShape turned(sand.tool());
    for (int y = 18 * n / 64; y < 42 * n / 64; ++y) {
        for (int x = 40 * n / 64; x < n; ++x) {
            const sand::Offset offset{std::int64_t{x} * sand::kProbePerCell + sand::kProbePerCell / 2 - sand.probe().x,
                                      std::int64_t{y} * sand::kProbePerCell + sand::kProbePerCell / 2 - sand.probe().y};
            const double table = kTalus * std::min({n - x - 0.5, y + 0.5, n - y - 0.5});
            // kFree is higher than every table.
            const double under =
                tool.held ? 1.0 * turned.underside(sand.probe().z, offset) / sand::kUnitsPerCell : table;
            const double less = std::min(table, under) - heightAt(sand, x + 0.5, y + 0.5);
            result.missing += std::max(less, 0.0) / scale / scale / scale;
            result.deepest = std::max(result.deepest, less / scale);
        }
    }
    result.atRest = sand.settled();
    return result;
}

}  // namespace borders
