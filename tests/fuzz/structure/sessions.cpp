// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/structure/sessions.hpp"

#include <algorithm>
#include <memory>
#include <string>

#include "sand/grid/dunes.hpp"
#include "sand/tin/refine/start_maker.hpp"
#include "tests/support/sand/laws.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace structure {
namespace {

using sand::Edit;
using sand::Replica;
using sand::Step;

scene::Scene gridOf(int columns, int rows, sand::Rim rim) {
    scene::Scene scene = samples::flatScene(columns, rows, 2);
    scene.rules.rim = rim;
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            scene.terrain.setHeight(x, y, (x * 7 + y * 5) % 11 * sand::kUnitsPerCell / 2);
        }
    }
    return scene;
}

scene::Scene groundOf(sand::Rim rim) {
    scene::Scene scene = gridOf(11, 7, rim);
    auto ground = std::make_shared<sand::Ground>(11, 7);
    for (int x = 2; x < 9; ++x) {
        ground->setWall(x, 2);
        ground->setBedrock(x, 4, scene.terrain.height(x, 4) - x * sand::kUnitsPerCell / 8);
    }
    ground->setWall(0, 6);
    scene.rules.ground = ground->digest();
    scene.ground = std::move(ground);
    scene.rules.tuning.startThreshold = sand::kUnitsPerCell * 5 / 4;
    return scene;
}

scene::Scene tinOf(sand::Rim rim) {
    scene::Scene scene = samples::flatScene(8, 6, 2);
    scene.rules.rim = rim;
    sand::grid::makeDunes({.bed = 2, .height = 3, .length = 6, .seed = 7}, scene.terrain);
    auto start =
        sand::tin::follow(scene.terrain, nullptr, {.spacing = 400, .maxError = 40000, .mostVertices = 60}).start;
    scene.beginAs(std::move(start));
    return scene;
}

Session play(scene::Scene scene, std::uint64_t number) {
    Session session{std::move(scene), {}, {}};
    Replica sand(session.scene);
    Chance chance(1, number);
    for (int i = 0; i < 24; ++i) {
        Step step = shortStep(sand, chance);
        step.number = sand.stepNumber() + 1;
        sand.apply(step);
        session.steps.push_back(step);
        if (i % 3 == 0) {
            session.states.push_back(sand);
        }
    }
    return session;
}

bool restores(const Step& step) {
    return step.edit.kind == Edit::reset || step.edit.kind == Edit::undo || step.edit.kind == Edit::load;
}

}  // namespace

const std::vector<Session>& sessions() {
    static const std::vector<Session> kSessions = [] {
        using sand::Rim;
        std::vector<Session> all;
        for (const scene::Scene& scene :
             {gridOf(9, 8, Rim::closed), gridOf(9, 8, Rim::open), groundOf(Rim::closed), groundOf(Rim::open),
              gridOf(12, 1, Rim::closed), gridOf(1, 1, Rim::open), tinOf(Rim::closed), tinOf(Rim::open)}) {
            all.push_back(play(scene, all.size()));
        }
        return all;
    }();
    return kSessions;
}

Step shortStep(const Replica& sand, Chance& chance) {
    const sand::Rules& rules = sand.rules();
    Step step = samples::wildStep(0, rules, chance.engine());
    switch (chance.below(32)) {
        case 0:
            step.edit = Edit::undo;
            break;
        case 1:
            step.edit = Edit::reset;
            break;
        case 2:
            step.edit = Edit::loaded(sand.copySand()->encode());
            break;
        case 3:
            step.edit = Edit::settle;
            break;
        default:
            break;
    }
    step.engaged = sand.holdsTool() ? sand.engaged() : step.engaged;
    if (sand.holdsTool()) {
        step.path.clear();
        step.heading.reset();
    }
    step.edit.tuning.sweepsPerStep = std::min(step.edit.tuning.sweepsPerStep, 40);
    step.sweeps = std::min(1 + static_cast<std::int32_t>(chance.below(6)), sand.mostSweeps(step));
    return step;
}

void applyAndCheck(Replica& sand, Step step) {
    step.number = sand.stepNumber() + 1;
    const std::int64_t before = sand.volume() + sand.outflow();
    sand.apply(step);
    require(sand.leftOut().find("skipped") == std::string::npos, sand.leftOut());
    require(restores(step) || sand.volume() + sand.outflow() == before, "the volume of the sand has changed");
    require(sand.lastWork().substeps <= sand::kMostSubsteps, "a step has more sub-steps than a step may");
    require(sand.lastWork().sweeps <= sand::kMostSweeps, "a step has more sweeps than a step may");
    if (sand.rules().tin == 0) {
        const samples::Extremes found = samples::extremesOf(samples::fieldOf(sand));
        require(found.lowest >= -sand::kMaxHeight && found.highest <= sand::kMaxHeight, "a height is out of range");
    }
}

}  // namespace structure
