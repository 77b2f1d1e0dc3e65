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
#include "bench/sand/relaxations.hpp"
#include "sand/grid/coarse_level.hpp"
#include "sand/grid/displacement.hpp"
#include "sand/grid/erosion.hpp"
#include "tests/support/sand/strokes.hpp"

namespace bench {
namespace {

constexpr int kStrokeSteps = 40, kHandSamples = 17;  // of the hand in a step
constexpr int kMostStepsToRest = 4000;
constexpr double kFieldSpeed = 9.4 / 512;  // [field per step], of script:gis
constexpr double kHandCircle = 0.2;        // [field], radius of the circle along which the hand moves

/// Coarse levels and fine sweeps of a step.
struct DigLaw {
    std::string name;
    std::vector<std::pair<int, int>> levels;  // side [cell] and sweeps
    int moved, still;                         // [sweep]
    int nearer = 0;                           // by how much the patch is smaller on each side [cell]
};

/// Sand and borders in which a tool digs.
struct DigPlace {
    std::string name = "level";
    int side = 512;       // [cell]
    double middle = 0.5;  // of the circle, from west to east [field]
    sand::Rim rim = sand::Rim::closed;
    double rock = 0;    // depth [cell]; 0: none
    bool wall = false;  // across the circle
    double band = 1e-3;
};

struct DigCase {
    DigPlace place;
    sand::Tool tool;

    [[nodiscard]] int radius() const { return tool.radius / sand::kProbePerCell; }
    [[nodiscard]] int allSweeps() const { return (radius() * radius() + 5) / 6; }
    [[nodiscard]] sand::Rules rules(const sand::HeightField& field) const {
        sand::Rules rules = rulesFor(field, kTalus, place.band);
        rules.rim = place.rim;
        rules.tuning.tool = tool;
        rules.tuning.sweepsPerStep = allSweeps();
        return rules;
    }
    [[nodiscard]] std::unique_ptr<sand::Ground> ground() const {
        if (place.rock <= 0 && !place.wall) {
            return nullptr;
        }
        auto ground = std::make_unique<sand::Ground>(place.side, place.side);
        for (int y = 0; y < place.side; ++y) {
            for (int x = 0; x < place.side && place.rock > 0; ++x) {
                const double depth = place.rock * (1 + 0.5 * std::sin(x / 30.0) * std::cos(y / 23.0));
                ground->setBedrock(x, y, static_cast<std::int32_t>(-depth * sand::kUnitsPerCell));
            }
            if (place.wall) {
                ground->setWall(place.side * 3 / 5, y);
            }
        }
        return ground;
    }
};

/// Field in which a tool digs along a circle, and then is lifted.
class CircleDigger {
public:
    explicit CircleDigger(const DigCase& given)
        : case_(given),
          field_(given.place.side, given.place.side, 1.0),
          rules_(given.rules(field_)),
          ground_(given.ground()),
          erosion_(field_, rules_, {.ground = ground_.get()}),
          displacement_(given.tool) {
        erosion_.sweep(field_, 1);
    }

    void dig(const DigLaw& law) {
        std::vector<sand::ProbePoint> path{at_};
        for (int sample = 0; sample < kHandSamples; ++sample) {
            path.push_back(handAt(steps_ + static_cast<double>(sample) / kHandSamples));
        }
        if (steps_++ == 0) {
            path.front() = path[1];
        }
        path = sand::pathInSubsteps(std::move(path), rules_.substepLength());
        for (std::size_t i = 1; i < path.size(); ++i) {
            erosion_.touch(displacement_.drag(field_, rules_.rim, ground_.get(), path[i - 1], path[i]).cells);
        }
        erosion_.touch(displacement_.cells(field_, path.front()));
        at_ = path.back();
        const sand::grid::Obstacle tool = displacement_.obstacle(field_, at_);
        slide(law, path, &tool);
        erosion_.sweep(field_, law.moved, &tool);
    }
    /// Lifts the tool and sweeps until all sand rests. Returns the number of steps.
    int lift(const DigLaw& law) {
        erosion_.touch(displacement_.cells(field_, at_));
        slide(law, {at_}, nullptr);
        erosion_.sweep(field_, law.moved);
        int steps = 1;
        for (; !erosion_.settled() && steps < kMostStepsToRest; ++steps) {
            erosion_.sweep(field_, law.still);
        }
        return steps;
    }
    [[nodiscard]] const sand::HeightField& field() const { return field_; }

private:
    [[nodiscard]] sand::ProbePoint handAt(double step) const {
        const double side = case_.place.side, turn = step * kFieldSpeed / kHandCircle;
        // Spheres and ellipsoids are 0.8 radii deep. The flat tools and the sole are 0.2 radii deep.
        const bool deep = case_.tool.kind == sand::ToolKind::sphere || case_.tool.kind == sand::ToolKind::ellipsoid;
        return sand::probePoint(side * (case_.place.middle + kHandCircle * std::cos(turn)),
                                side * (0.5 + kHandCircle * std::sin(turn)), case_.radius() * (deep ? 0.2 : 0.8));
    }
    void slide(const DigLaw& law, const std::vector<sand::ProbePoint>& path, const sand::grid::Obstacle* tool) {
        sand::CellRect way;
        for (const sand::ProbePoint& at : path) {
            const int x = at.x >> sand::kProbeBits, y = at.y >> sand::kProbeBits;
            way = way.joinedWith({x, y, x + 1, y + 1});
        }
        const sand::CellRect patch = way.grownBy(displacement_.reachOfCoarsePhase() - law.nearer);
        const sand::grid::CoarseLevel::Site site{field_, rules_, ground_.get(), tool, {}};
        for (const auto& [side, sweeps] : law.levels) {
            erosion_.touch(sand::grid::CoarseLevel(site, patch, side).sweep(sweeps).changed);
        }
    }

    DigCase case_;
    sand::HeightField field_;
    sand::Rules rules_;
    std::unique_ptr<sand::Ground> ground_;
    sand::grid::Erosion erosion_;
    sand::grid::Displacement displacement_;
    sand::ProbePoint at_;
    int steps_ = 0;
};

/// Returns the law of a step with all sweeps and the one that is built. Adds laws with one more level, with a smaller
/// patch, and without coarse cells.
std::vector<DigLaw> lawsOf(const DigCase& given) {
    const sand::SweepPlan plan = given.rules(sand::HeightField(given.place.side, given.place.side, 1.0)).sweepPlan();
    std::vector<DigLaw> laws{{"all sweeps", {}, given.allSweeps(), plan.still}};
    if (plan.hasCoarsePhase()) {
        DigLaw built{"", {}, plan.moved, plan.still};
        for (int side = plan.coarsest; side >= plan.finest; side /= 2) {
            built.levels.emplace_back(side, plan.sweepsOf(side));
        }
        laws.push_back(built);
        DigLaw nearer = built;
        nearer.nearer = given.radius() / 2;
        laws.push_back(nearer);
        built.levels.emplace_back(plan.finest / 2, sand::SweepPlan::kFinerSweeps);
        laws.push_back(built);
        laws.push_back({"capped", {}, plan.still, plan.still});
    }
    for (DigLaw& law : laws) {
        for (const auto& [side, sweeps] : law.levels) {
            law.name += fmt::format("{}{}:{}", law.name.empty() ? "" : " ", side, sweeps);
        }
        law.name += law.nearer > 0 ? " near" : "";
    }
    return laws;
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
    for (const DigLaw& law : lawsOf(given)) {
        progress("{}, N = {}, {} of R = {}, {}", given.place.name, given.place.side, kind, given.radius(), law.name);
        const Dug dug = digBy(law, given);
        full = full ? full : dug;
        csv.row(given.place.name, kind, given.place.side, given.radius(), law.name, law.moved,
                1e3 * quantile(dug.seconds, 0.5), 1e3 * quantile(dug.seconds, 0.99),
                quantile(dug.seconds, 0.5) / quantile(full->seconds, 0.5),
                100 * samples::apart(dug.stroke, full->stroke), 100 * samples::apart(dug.rest, full->rest),
                samples::highest(dug.stroke), samples::highest(dug.stroke) / samples::highest(full->stroke),
                dug.stepsToRest, 1e3 * dug.restSeconds);
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
                    kStrokeSteps, kFieldSpeed));
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
    for (const int side : settings.sizes) {
        for (const int radius : {6, 30, 61, 100, 150, 200, 400}) {
            if (radius * 6 < side && radius * 40 > side) {
                measure({{.side = side}, sphereOf(radius)}, csv);
            }
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
                                  {"open rim", side - 3, 0.25, sand::Rim::open}}) {
        measure({place, sphereOf(61)}, csv);
    }
}

}  // namespace bench
