// SPDX-License-Identifier: Apache-2.0
// Measures how large tools dig: the time of a step, and how far the sand is from that of all sweeps.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/report/curves.hpp"
#include "bench/report/timing.hpp"
#include "bench/sand/circle_digger.hpp"
#include "tests/support/sand/strokes.hpp"

namespace bench {
namespace {

constexpr int kStrokeSteps = 40;
constexpr int kLargestWithAllSweeps = 200;  // [cell]

/// Returns the name of a law: its levels and sweeps, such as "8:27 4:16".
std::string nameOf(const DigLaw& law) {
    std::string name;
    for (const auto& [side, sweeps] : law.levels) {
        name += fmt::format("{}{}:{}", name.empty() ? "" : " ", side, sweeps);
    }
    return name + (law.nearer > 0 ? " near" : "");
}

/// Returns the law of a step with all sweeps and the one that is built. Adds laws with one more level, with a smaller
/// patch, and without coarse cells. If a stroke would take hours with all sweeps, returns only the law that is built.
std::vector<DigLaw> lawsOf(const DigCase& given) {
    const sand::SweepPlan plan = given.rules(sand::HeightField(given.place.side, given.place.side, 1.0)).sweepPlan();
    const DigLaw all{"all sweeps", {}, given.allSweeps(), plan.still};
    if (!plan.hasCoarsePhase()) {
        return {all};
    }
    DigLaw built{"", {}, plan.moved, plan.still};
    for (int side = plan.coarsest; side >= plan.finest; side /= 2) {
        built.levels.emplace_back(side, plan.sweepsOf(side));
    }
    DigLaw nearer = built, finer = built;
    nearer.nearer = given.radius() / 2;
    finer.levels.emplace_back(plan.finest / 2, sand::SweepPlan::kFinerSweeps);
    for (DigLaw* const law : {&built, &nearer, &finer}) {
        law->name = nameOf(*law);
    }
    if (given.radius() > kLargestWithAllSweeps) {
        return {built};
    }
    if (finer.levels.back().first == 1) {
        return {all, built, nearer, {"capped", {}, plan.still, plan.still}};
    }
    return {all, built, nearer, finer, {"capped", {}, plan.still, plan.still}};
}

struct Dug {
    sand::HeightField stroke, rest;
    std::vector<double> seconds;  // of each step [s]
    double restSeconds = 0;
    int stepsToRest = 0;
};

Dug digBy(const DigLaw& law, const DigCase& given) {
    CircleDigger digger(given);
    std::vector<double> seconds;
    seconds.reserve(kStrokeSteps);
    for (int i = 0; i < kStrokeSteps; ++i) {
        seconds.push_back(secondsOf([&] { digger.dig(law); }));
    }
    Dug dug{digger.field(), digger.field(), seconds};
    dug.restSeconds = secondsOf([&] { dug.stepsToRest = digger.lift(law); });
    dug.rest = digger.field();
    return dug;
}

void measure(const DigCase& given, Csv& csv) {
    const std::string_view kind = base::nameOf(given.tool.kind);
    std::optional<Dug> full;
    const bool comparable = given.radius() <= kLargestWithAllSweeps;
    for (const DigLaw& law : lawsOf(given)) {
        progress("{}, N = {}, {} of R = {}, {}", given.place.name, given.place.side, kind, given.radius(), law.name);
        const Dug dug = digBy(law, given);
        full = full ? full : dug;
        const auto compared = [&](double value) { return comparable ? fmt::format("{:.6g}", value) : std::string(); };
        csv.row(given.place.name, kind, given.place.side, given.radius(), law.name, law.moved,
                1e3 * quantile(dug.seconds, 0.5), 1e3 * quantile(dug.seconds, 0.99),
                compared(quantile(dug.seconds, 0.5) / quantile(full->seconds, 0.5)),
                compared(100 * samples::apart(dug.stroke, full->stroke)),
                compared(100 * samples::apart(dug.rest, full->rest)), samples::highest(dug.stroke),
                compared(samples::highest(dug.stroke) / samples::highest(full->stroke)), dug.stepsToRest,
                1e3 * dug.restSeconds);
    }
}

sand::Tool toolOf(sand::ToolKind kind, int radius) {
    const std::int32_t length = radius * sand::kProbePerCell;
    return {kind, length, sand::isRound(kind) ? 0 : static_cast<std::int32_t>(length * sand::usualWidth(kind)), {}};
}

}  // namespace

void largeTools(const Settings& settings, Csv& csv) {
    csv.note(
        fmt::format("a hand digs along a circle for {} steps, {:.4f} of the field a step, and lifts the tool; sphere "
                    "and ellipsoid 0.8 radii deep, the other tools 0.2; talus 34 degrees",
                    kStrokeSteps, CircleDigger::kFieldSpeed));
    csv.note(
        "law: coarse levels, each with the side of its cells and its sweeps; all sweeps: R²/6 sweeps of the field; "
        "near: with a patch that is half a radius smaller on each side; capped: without coarse cells, in each step as "
        "many sweeps as the built law has without a movement");
    csv.note("ms: CPU time of one thread per step, without the hash; ratio: of the p50 to that of all sweeps");
    csv.note(
        "behind, at_end: sum of |height - height with all sweeps| over the sum of its |height|, at the end of the "
        "stroke and at rest [%]");
    csv.note(
        "highest: highest sand over the level at the end of the stroke [cell]; of_full: divided by that of all sweeps");
    csv.note("steps_to_rest, rest_ms: after lifting, without coarse phase except in the first of these steps");
    csv.columns("place,tool,N,R,law,sweeps,ms_p50,ms_p99,ratio,behind,at_end,highest,of_full,steps_to_rest,rest_ms");
    using enum sand::ToolKind;
    const auto sphereOf = [](int radius) { return toolOf(sphere, radius); };
    for (const auto& [side, radius] :
         {std::pair(512, 6), {512, 30}, {512, 61}, {512, 100}, {1024, 150}, {2048, 200}, {4096, 200}, {2048, 400}}) {
        if (std::ranges::find(settings.sizes, side) != settings.sizes.end()) {
            measure({{.side = side}, sphereOf(radius)}, csv);
        }
    }
    const int side = settings.sizes.front();
    for (const sand::ToolKind kind : {circle, rectangle, ellipse, ellipsoid, footprint}) {
        measure({{.side = side}, toolOf(kind, 61)}, csv);
    }
    for (const DigPlace& place : {DigPlace{"closed rim", side, 0.25},
                                  {"open rim", side, 0.25, sand::Rim::open},
                                  {"rock", side, 0.5, sand::Rim::closed, 20},
                                  {"thin layers", side, 0.5, sand::Rim::closed, 3},
                                  {"wall", side, 0.5, sand::Rim::closed, 0, true},
                                  {"band 0.2", side, 0.5, sand::Rim::closed, 0, false, 0.2},
                                  {"closed rim", side - 3, 0.25},
                                  {"open rim", side - 3, 0.25, sand::Rim::open},
                                  {"closed rim", 2 * side - 23, 0.12}}) {
        measure({place, sphereOf(61)}, csv);
    }
}

}  // namespace bench
