// SPDX-License-Identifier: Apache-2.0
// Measures the sand that runs past a tool that is held on a slope, beside a wall in the tool's place.
#include <cmath>

#include "bench/report/curves.hpp"
#include "bench/report/timing.hpp"
#include "tests/support/borders/border_experiments.hpp"

namespace bench {
namespace {

constexpr int kStepsPerSecond = 60, kHeldSweeps = 16;
constexpr int kSlidingSeconds = 4;                             // in which the sand that the press has thrown up slides
constexpr double kHeldRadius = 6;                              // [cell]
constexpr std::array kHeldSeconds{1, 2, 3, 5, 8, 15, 30, 60};  // of the hand's time
constexpr std::array kHeldSlopes{0.3, 0.5, 0.62, 0.67};        // the talus is 0.6745

/// An obstacle on the slope.
struct Holder {
    const char* sand;
    borders::Ground ground;
    sand::ToolKind tool;
    bool wall = false;  // in the place of the tool, after its press
};

borders::Case slopeOf(const Holder& holder, int side, double slope) {
    borders::Case given = borders::caseOf(holder.ground, side);
    given.tool = holder.tool;
    given.radius = kHeldRadius;
    given.sweeps = kHeldSweeps;
    given.height = [=](double x, double) { return 5 + slope * x; };
    return given;
}

/// Returns the scene of the sand that a press has left, with walls below the tool.
borders::Case walledIn(const sand::Replica& pressed, borders::Case given, int side) {
    const std::vector<double> heights = borders::heightsOf(pressed);
    const sand::TurnedShape shape(pressed.tool());
    const sand::ProbePoint at = pressed.probe();
    given.height = [=](double x, double y) {
        const int column = std::clamp(static_cast<int>(x), 0, side - 1),
                  row = std::clamp(static_cast<int>(y), 0, side - 1);
        return heights[static_cast<std::size_t>(row * side + column)];
    };
    given.wall = [=](int x, int y) {
        return shape.covers({std::int64_t{x} * 256 + 128 - at.x, std::int64_t{y} * 256 + 128 - at.y});
    };
    return given;
}

void measure(const Holder& holder, int side, double slope, Csv& csv) {
    const borders::Case given = slopeOf(holder, side, slope);
    sand::Replica sand(borders::sceneOf(given));
    borders::Hand hand(sand);
    hand.rest();
    const double middle = side / 2.0;
    hand.press(middle, middle, borders::heightAt(sand, middle, middle));
    if (holder.wall) {
        sand = sand::Replica(borders::sceneOf(walledIn(sand, given, side)));
    }
    borders::Hand holding(sand);
    const auto step = [&] { holder.wall ? holding.hover() : hand.hold(); };
    const std::vector<double> pressed = borders::heightsOf(sand);
    for (int i = 0; i < kSlidingSeconds * kStepsPerSecond; ++i) {
        step();
    }
    const std::vector<double> slid = borders::heightsOf(sand);
    double seconds = 0;
    int done = 0;
    for (const int until : kHeldSeconds) {
        seconds += secondsOf([&] {
            for (; done < until * kStepsPerSecond; ++done) {
                step();
            }
        });
        csv.row(holder.sand, holder.wall ? "wall" : base::nameOf(holder.tool), side, slope, until, 1e3 * seconds,
                borders::moved(pressed, slid), borders::moved(slid, borders::heightsOf(sand)), sand.settled() ? 1 : 0);
    }
}

}  // namespace

void heldTools(const Settings& settings, Csv& csv) {
    using enum sand::ToolKind;
    csv.note(fmt::format(
        "a tool of {} cells is pressed into a slope until its centre is at the height of the sand, and held; "
        "talus {:.4f}, {} sweeps a step, {} steps a second",
        kHeldRadius, borders::kTalus, kHeldSweeps, kStepsPerSecond));
    csv.note("wall: cells without ground in the place of a circle, after its press");
    csv.note(
        fmt::format("seconds: time that the hand has held the tool, from {} s after the press on", kSlidingSeconds));
    csv.note("ms: CPU time of the steps of these seconds");
    csv.note(fmt::format("slid, past: half the sum of |change of a height| in the first {} s, and in `seconds` [cell³]",
                         kSlidingSeconds));
    csv.columns("sand,tool,N,slope,seconds,ms,slid,past,at_rest");
    const std::vector<Holder> holders{{"grid", borders::kGrid, circle, true}, {"grid", borders::kGrid, circle},
                                      {"grid", borders::kGrid, sphere},       {"grid", borders::kGrid, ellipsoid},
                                      {"grid", borders::kGrid, footprint},    {"TIN", borders::kCoarse, circle, true},
                                      {"TIN", borders::kCoarse, circle},      {"TIN", borders::kCoarse, sphere},
                                      {"TIN", borders::kCoarse, ellipsoid},   {"fine TIN", borders::kTin, circle, true},
                                      {"fine TIN", borders::kTin, circle},    {"fine TIN", borders::kTin, sphere},
                                      {"fine TIN", borders::kTin, ellipsoid}};
    for (const int side : settings.sizes) {
        for (const Holder& holder : holders) {
            for (const double slope : kHeldSlopes) {
                progress("N = {}, {}, {}, slope {}", side, holder.sand, base::nameOf(holder.tool), slope);
                measure(holder, side, slope, csv);
            }
        }
    }
}

}  // namespace bench
