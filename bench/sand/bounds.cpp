// SPDX-License-Identifier: Apache-2.0
// Measures the most expensive steps that a peer with the role `move` can ask for.
#include <cmath>
#include <functional>

#include "bench/report/curves.hpp"
#include "bench/report/timing.hpp"
#include "tests/support/borders/border_experiments.hpp"

namespace bench {
namespace {

constexpr int kTinSide = 128;            // [cell]; a larger TIN takes minutes to make
constexpr double kLevelOfBounds = 20;    // [cell]
constexpr double kHighest = 4096;        // [cell], as of sand::kMaxHeight
constexpr int kStepsOfSettle = 100'000;  // at most

/// Returns a path of as many sub-steps as the tool may have, at most. It goes to and fro across the field, so that each
/// sub-step takes sand.
std::vector<sand::ProbePoint> longestPath(int side, double z, std::int64_t most) {
    std::vector<sand::ProbePoint> path;
    double x = 4, y = side / 2.0;
    for (int i = 0; i + 1 < static_cast<int>(sand::kMaxPathPoints); ++i) {
        const double east = i % 2 == 0 ? side - 4 : 4, north = 8 + (side - 16) * (i * 37 % 63) / 63.0;
        const auto way = static_cast<std::int64_t>(std::max(std::abs(east - x), std::abs(north - y))) + 2;
        if (way > most) {
            break;
        }
        most -= way;
        x = east;
        y = north;
        path.push_back(borders::probeAt(x, y, z));
    }
    return path;
}

void measurePath(bool tin, int side, double radius, Csv& csv) {
    borders::Case given = borders::caseOf({.tin = tin}, side);
    given.radius = radius;
    given.sweeps = 1;
    given.height = [](double, double) { return kLevelOfBounds; };
    sand::Replica sand(borders::sceneOf(given));
    borders::Hand hand(sand);
    const double z = kLevelOfBounds - radius / 3;
    hand.press(4, side / 2.0, z);
    const std::int64_t most = sand.rules().mostSubsteps();
    const std::vector<sand::ProbePoint> path = longestPath(side, z, most);
    if (path.empty()) {  // the tool may not cross the field in a step
        return;
    }
    const double seconds = secondsOf([&] { hand.apply(true, path); });
    csv.row("path", tin ? "TIN" : "grid", side, radius, sand.lastWork().substeps, most, 1e3 * seconds, 0);
}

void measureSettle(const char* name, bool tin, int side, const std::function<double(double, double)>& height,
                   Csv& csv) {
    borders::Case given = borders::caseOf({.tin = tin}, side);
    given.sweeps = 4;
    given.maxError = 0;
    given.rim = tin ? sand::Rim::open : sand::Rim::closed;
    given.height = height;
    sand::Replica sand(borders::sceneOf(given));
    borders::Hand hand(sand);
    const double first = secondsOf([&] { hand.hover(sand::Edit::settle); });
    double longest = 0;
    int steps = 0;
    for (; sand.settling() && steps < kStepsOfSettle; ++steps) {
        longest = std::max(longest, secondsOf([&] { hand.hover(); }));
    }
    csv.row(fmt::format("settle of {}", name), tin ? "TIN" : "grid", side, 0, steps, kStepsOfSettle, 1e3 * first,
            1e3 * longest);
}

}  // namespace

void bounds(const Settings& settings, Csv& csv) {
    csv.note(
        "path: up to 63 ways across level sand with a sphere that is in it; work: its sub-steps, of at most `most`");
    csv.note(
        "settle of 512 x 512 cells, or of a TIN with one point per cell and an open rim; work: steps after the first, "
        "of at most "
        "`most`");
    csv.note("ms: CPU time of the step; ms_later: of the longest step of those after it");
    csv.columns("what,sand,N,R,work,most,ms,ms_later");
    for (const int side : settings.sizes) {
        for (const double radius : {0.5, 2.0, 12.0, 60.0}) {
            progress("path on a grid, N = {}, R = {}", side, radius);
            measurePath(false, side, radius, csv);
        }
    }
    for (const double radius : {2.0, 12.0, 60.0}) {
        progress("path on a TIN, R = {}", radius);
        measurePath(true, kTinSide, radius, csv);
    }
    constexpr int kSide = 512;
    const auto chequered = [](double x, double y, int cells, double high) {
        return (static_cast<int>(x) / cells + static_cast<int>(y) / cells) % 2 == 0 ? -high : high;
    };
    measureSettle(
        "halves", false, kSide, [](double x, double) { return x < kSide / 2.0 ? kHighest : -kHighest; }, csv);
    measureSettle(
        "cells by turns", false, kSide, [&](double x, double y) { return chequered(x, y, 1, kHighest); }, csv);
    measureSettle(
        "squares by turns", false, kSide, [&](double x, double y) { return chequered(x, y, 64, 4000); }, csv);
    measureSettle(
        "cone", false, kSide,
        [](double x, double y) { return 20 + 400 * std::exp(-std::hypot(x - 256, y - 256) / 60); }, csv);
    measureSettle(
        "level sand", true, 96, [](double, double) { return 30.0; }, csv);
}

}  // namespace bench
