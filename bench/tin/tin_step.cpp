// SPDX-License-Identifier: Apache-2.0
// Measures the steps of a session on a TIN: a tool is put into the sand, dragged and lifted, and the sand slides on.
#include <array>
#include <cmath>
#include <map>
#include <random>

#include "bench/report/curves.hpp"
#include "bench/report/timing.hpp"
#include "sand/replica.hpp"
#include "sand/tin/surface.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/sand/tin_piles.hpp"

namespace bench {
namespace {

constexpr double kToolCells = 13;   // [cell]; about 1000 vertices are below the tool and in the ring beside it
constexpr double kPressed = 2;      // [cell]
constexpr int kSamplesOfHand = 16;  // per step
constexpr double kPerStep = 1.5;    // [cell]
constexpr int kRunSteps = 30;       // imprints per run, and steps of its drag
constexpr int kStepsAfter = 4;      // steps after an imprint in which sand slides
constexpr int kSweepsPerStep = 64;
constexpr std::int32_t kSlope = 65536;         // [unit per cell], 45 degrees
constexpr std::int32_t kBand = kSlope / 1000;  // the default of scenes
constexpr std::int32_t kMaxError = 65536 / 8;  // [unit]
constexpr std::int32_t kMostVertices = 1 << 19;

/// Times by kind of step and part [s].
using Times = std::map<std::pair<std::string, std::string>, std::vector<double>>;

scene::Scene levelScene(int side, bool refines, std::uint32_t seed) {
    sand::tin::TinStart start = tin_piles::levelStart(side, seed);
    start.settings.spacing = refines ? sand::kProbePerCell : 0;
    start.settings.maxError = refines ? kMaxError : 0;
    start.settings.mostVertices = kMostVertices;
    scene::Scene scene;
    scene.rules.columns = scene.rules.rows = side;
    scene.rules.tuning.threshold = kSlope;
    scene.rules.tuning.startThreshold = kSlope + kBand;
    scene.rules.tuning.sweepsPerStep = kSweepsPerStep;
    scene.rules.tuning.tool.kind = sand::ToolKind::circle;
    scene.rules.tuning.tool.radius = static_cast<std::int32_t>(kToolCells * sand::kProbePerCell);
    scene.tin = std::make_shared<const sand::tin::TinStart>(std::move(start));
    return scene;
}

sand::ProbePoint handOver(double x, double y /* [cell] */) {
    const auto probe = [](double cells) { return static_cast<std::int32_t>(std::floor(cells * sand::kProbePerCell)); };
    return {probe(x), probe(y), probe(kToolCells - kPressed)};
}

struct Action {
    std::string kind;
    sand::Step step;
};

/// Returns imprints far from one another, each followed by a lift, and one long drag.
std::vector<Action> actionsOf(int side, std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto somewhere = [&] { return 2 * kToolCells + tin_piles::chance(random) * (side - 4 * kToolCells); };
    std::vector<Action> actions;
    const auto add = [&actions](const char* kind, bool engaged, std::vector<sand::ProbePoint> path) {
        const sand::Step step{1, actions.size() + 1, engaged, std::move(path)};
        actions.push_back({kind, step});
    };
    for (int i = 0; i < kRunSteps; ++i) {
        const double x = somewhere();
        add("imprint", true, {handOver(x, somewhere())});
        add("lift", false, {});
        for (int after = 0; after < kStepsAfter; ++after) {
            add("after", false, {});
        }
    }
    double x = 2 * kToolCells;
    add("imprint", true, {handOver(x, side / 2.0)});
    for (int i = 0; i < kRunSteps; ++i, x += kPerStep) {
        std::vector<sand::ProbePoint> path;
        for (int sample = 1; sample <= kSamplesOfHand; ++sample) {
            path.push_back(handOver(x + kPerStep * sample / kSamplesOfHand, side / 2.0));
        }
        add("drag", true, std::move(path));
    }
    return actions;
}

/// Measures whole steps as on a rank: the step, its hash, and the list of changes for drawing.
void measureWhole(const scene::Scene& scene, const std::vector<Action>& actions, Times& times) {
    sand::Replica replica(scene);
    replica.apply({1, 1, false, {}});  // all sand moves in the first step
    static_cast<void>(replica.stateHash());
    static_cast<void>(replica.takeChange());
    for (Action action : actions) {
        ++action.step.number;
        times[{action.kind, "step"}].push_back(secondsOf([&] {
            replica.apply(action.step);
            static_cast<void>(replica.stateHash());
            static_cast<void>(replica.takeChange());
        }));
    }
}

/// Measures the parts of a step: the calls of the surface in the order of Replica::apply().
void measureParts(const scene::Scene& scene, const std::vector<Action>& actions, Times& times) {
    sand::tin::TinSurface surface(scene.rules, scene.tin);
    const sand::Tool& tool = scene.rules.tuning.tool;
    sand::ProbePoint probe;
    surface.sweep(sand::SweepPart::all(kSweepsPerStep), nullptr, probe);
    bool touched = false;
    for (const auto& [kind, step] : actions) {
        const auto part = [&, &to = kind](const char* name, const auto& work) {
            times[{to, name}].push_back(secondsOf(work));
        };
        if (step.engaged && !touched) {
            part("keep", [&] { surface.keep(); });
        }
        if (step.engaged) {
            std::vector<sand::ProbePoint> path{touched ? probe : step.path.front()};
            path.insert(path.end(), step.path.begin(), step.path.end());
            part("tool", [&] { surface.drag(tool, path); });
        }
        if (touched) {
            part("release", [&] { surface.release(tool, probe); });
        }
        if (touched && !step.engaged) {
            part("leave", [&] { surface.leave(tool); });
        }
        probe = step.path.empty() ? probe : step.path.back();
        touched = step.engaged;
        part("sweeps", [&] { surface.sweep(sand::SweepPart::all(kSweepsPerStep), touched ? &tool : nullptr, probe); });
        part("hash", [&] { static_cast<void>(surface.hash()); });
        part("change", [&] { static_cast<void>(surface.takeChange()); });
    }
}

/// Measures the two parts of an imprint, the change of the mesh and the remap. Takes each imprint out again.
void measureImprints(const scene::Scene& scene, const std::vector<Action>& actions, Times& times) {
    sand::tin::TinSurface surface(scene.rules, scene.tin);
    sand::tin::VertexSand layer = sand::tin::Snapshot(surface.layer(), {}).layer();
    const auto outline = sand::tin::Outline::of(scene.rules.tuning.tool);
    for (const auto& [kind, step] : actions) {
        if (kind != "imprint") {
            continue;
        }
        sand::tin::Imprint there;
        double mesh = 0;
        const auto put = [&, at = step.path.front()](sand::tin::Mesh& edited) {
            const auto where = placed(outline, at.x, at.y, edited.triangles());
            mesh = secondsOf([&] { there.putInto(edited, where, kMostVertices); });
        };
        const double change = secondsOf([&] { layer.edit(put); });
        times[{kind, "mesh"}].push_back(mesh);
        times[{kind, "remap"}].push_back(change - mesh);
        layer.edit([&](sand::tin::Mesh& edited) { there.takeOutOf(edited); });
        static_cast<void>(layer.takeChange());
    }
}

int verticesBelowAndBeside(const scene::Scene& scene, const sand::ProbePoint& probe) {
    const sand::TurnedShape tool(scene.rules.tuning.tool);
    const auto& places = scene.tin->places;
    return static_cast<int>(std::count_if(places.begin(), places.end(), [&](const sand::tin::LatticePoint& place) {
        const sand::Offset offset{std::int64_t{place.x} - probe.x, std::int64_t{place.y} - probe.y};
        return tool.covers(offset) || tool.takes(offset);
    }));
}

}  // namespace

void tinStep(const Settings& settings, Csv& csv) {
    csv.note(
        fmt::format("a round tool of 32 points and radius {} cells, {} cells deep, in level sand; {} sweeps; ms of",
                    kToolCells, kPressed, kSweepsPerStep));
    csv.note(
        "CPU time. imprint: the tool at a new place, where a stroke begins; drag: moved on by 1.5 cells; lift: taken");
    csv.note(
        "out; after: only sweeps. step: the whole step with hash and list of changes, measured separately. mesh, "
        "remap:");
    csv.note("parts of tool, measured separately and without refinement; keep: for an undo; sweeps: with coarsening");
    csv.columns("what,refined,N,vertices,near,part,steps,ms_median,ms_p99,ms_max");
    for (const int side : settings.sizes) {
        for (const bool refines : {false, true}) {
            Times times;
            std::size_t vertices = 0;
            int near = 0;
            for (int run = 0; run < settings.runs; ++run) {
                progress("N = {}, run {}", side, run);
                const std::uint32_t seed = settings.seed + static_cast<std::uint32_t>(run);
                const scene::Scene scene = levelScene(side, refines, seed);
                const std::vector<Action> actions = actionsOf(side, seed);
                vertices = scene.tin->places.size();
                near = verticesBelowAndBeside(scene, actions.front().step.path.front());
                measureWhole(scene, actions, times);
                measureParts(scene, actions, times);
                measureImprints(scene, actions, times);
            }
            for (const auto& [name, seconds] : times) {
                csv.row(name.first, refines ? "yes" : "no", side, vertices, near, name.second, seconds.size(),
                        1e3 * quantile(seconds, 0.5), 1e3 * quantile(seconds, 0.99), 1e3 * quantile(seconds, 1));
            }
        }
    }
}

}  // namespace bench
