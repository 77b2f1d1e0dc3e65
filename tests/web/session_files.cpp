// SPDX-License-Identifier: Apache-2.0
// Writes sessions for the test of the page's replica: the sample scenes, rock with walls, and every tool and edit.
// usage: session_files FOLDER [browser|pictures|times|hour]. Prints a line for each: FILE PARTS STEPS HASHES HASH.
// `browser` writes those of them that the test in browsers opens. `pictures` writes a few short sessions, whose last
// pictures scripts/figures/web_pictures.mjs compares. `times` and `hour` write the longer sessions of
// scripts/figures/web_times.mjs.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>

#include "sand/grid/dunes.hpp"
#include "sand/surface_factory.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/journal/journal_in_memory.hpp"

namespace {

/// Returns a scene whose picture has every cell, because a page has no levels of detail.
scene::Scene withEveryCell(scene::Scene scene) {
    scene.look.detail = 0;
    return scene;
}

/// A session that is computed as it is written.
class Written {
public:
    /// If `owes`, each third step owes half of its sweeps, and the next one pays them.
    explicit Written(const scene::Scene& scene, bool owes = true)
        : scene_(withEveryCell(scene)), sand_(scene_), journal_(scene_), owes_(owes) {}

    /// Adds a frame with `count` steps.
    void frame(int count, const std::function<sand::Step(std::uint64_t)>& make) {
        journal::JournalFrame frame{++frame_, sand_.stateHash(), {}};
        ++hashes_;
        for (int i = 0; i < count; ++i) {
            frame.steps.push_back(make(sand_.stepNumber() + 1));
            sand::Step& step = frame.steps.back();
            step.epoch = 1;
            const std::int32_t most = sand_.mostSweeps(step);
            step.sweeps = owes_ && step.number % 3 == 0 ? (most + 1) / 2 : most;
            sand_.apply(step);
            leftOut_ += sand_.leftOut().empty() ? 0 : 1;
        }
        journal_.add(frame);
    }
    void resume() {
        journal_.add(journal::JournalResumed{frame_, here(), 0, "a test"});
        ++hashes_;
    }
    void beginPart() { journal_.beginPart(here()); }
    /// Writes the journal. Throws if a step was left out: the session would test little.
    void end(const std::filesystem::path& file) {
        if (leftOut_ > 0) {
            throw std::logic_error(fmt::format("{}: {} steps were left out", file.string(), leftOut_));
        }
        journal_.add(here());
        ++hashes_;
        for (std::size_t part = 0; part < journal_.parts().size(); ++part) {
            std::ofstream stream(part == 0 ? file.string() : fmt::format("{}.{}", file.string(), part + 1),
                                 std::ios::binary);
            const base::Bytes& bytes = journal_.parts()[part];
            stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        }
        fmt::print("{} {} {} {} {:016x}\n", file.filename().string(), journal_.parts().size(), sand_.stepNumber(),
                   hashes_, sand_.stateHash());
    }
    [[nodiscard]] sand::Replica& sand() { return sand_; }
    [[nodiscard]] const scene::Scene& scene() const { return scene_; }

private:
    [[nodiscard]] journal::JournalEnd here() { return {sand_.stepNumber(), sand_.stateHash()}; }

    scene::Scene scene_;
    sand::Replica sand_;
    test::JournalInMemory journal_;
    std::uint64_t frame_ = 0, hashes_ = 0;
    bool owes_;
    int leftOut_ = 0;
};

/// A hand that draws loops through the middle of the field, half a radius deep. It lifts the tool every two seconds.
sand::Step loops(Written& session, std::uint64_t number) {
    sand::Step step{.number = number, .engaged = number % 120 < 100, .path = {}};
    const sand::Rules& rules = session.sand().rules();
    if (session.sand().holdsTool()) {
        step.engaged = session.sand().engaged();  // the tool stays as it is while sweeps are owed
        return step;
    }
    const auto heights = sand::startHeights(session.scene());
    for (int i = 1; i <= 4; ++i) {
        const double t = (static_cast<double>(number) + 0.25 * i) / 60;
        const double x = rules.columns * (0.5 + 0.3 * std::cos(1.1 * t)),
                     y = rules.rows * (0.5 + 0.3 * std::sin(1.7 * t));
        sand::ProbePoint point{sand::probeCoordinate(x), sand::probeCoordinate(y), 0};
        point.z = static_cast<std::int32_t>(heights(point.x, point.y) / sand::kUnitsPerCell * sand::kProbePerCell) +
                  rules.tuning.tool.radius / 2;
        step.path.push_back(point);
    }
    return step;
}

/// Adds one of every edit in turn.
void edit(Written& session, sand::Step& step, base::Bytes& saved) {
    switch (step.number % 60) {
        case 15:
            step.edit = sand::Edit::settle;
            break;
        case 25:
            saved = session.sand().copySand()->encode();
            step.edit = sand::Edit::undo;
            break;
        case 40:
            step.edit = sand::Edit::loaded(saved);
            break;
        case 50: {
            sand::Tuning tuning = session.sand().rules().tuning;
            tuning.tool.radius = tuning.tool.radius * 3 / 4;
            step.edit = sand::Edit::tuned(tuning);
            break;
        }
        case 55:
            step.edit = sand::Edit::reset;
            break;
        default:
            return;
    }
    step.edit.number = step.number;
}

void sampleScene(const std::string& name, const std::filesystem::path& folder, int frames = 45) {
    Written session(scene::loadScene("scenes/" + name + ".toml"));
    for (int frame = 0; frame < frames; ++frame) {
        session.frame(2, [&](std::uint64_t number) { return loops(session, number); });
    }
    session.end(folder / (name + ".journal"));
}

void everyEdit(const std::string& name, const scene::Scene& scene, const std::filesystem::path& folder) {
    Written session(scene);
    base::Bytes saved;
    for (int frame = 0; frame < 60; ++frame) {
        session.frame(1 + frame % 2, [&](std::uint64_t number) {
            sand::Step step = loops(session, number);
            edit(session, step, saved);
            return step;
        });
        if (frame == 20 || frame == 40) {
            session.beginPart();
        }
        if (frame == 30) {
            session.resume();
        }
    }
    session.end(folder / (name + ".journal"));
}

/// Returns rock that is bare in places, walls, a band, long cells and an open rim.
scene::Scene rockyScene(double toolCells) {
    scene::Scene scene = samples::flatScene(97, 61, toolCells);
    sand::grid::makeDunes({.bed = 2, .height = 6, .length = 30, .seed = 5}, scene.terrain);
    auto ground = std::make_shared<sand::Ground>(scene.terrain.columns(), scene.terrain.rows());
    for (int y = 0; y < scene.terrain.rows(); ++y) {
        for (int x = 0; x < scene.terrain.columns(); ++x) {
            if (x > 30 && x < 42 && y > 20 && y < 25) {
                ground->setWall(x, y);
            } else {
                ground->setBedrock(x, y, std::min(scene.terrain.height(x, y), (x - 20) * sand::kUnitsPerCell / 8));
            }
        }
    }
    scene.ground = ground;
    scene.rules.ground = ground->digest();
    scene.rules.aspect = 3 * sand::kUnitsPerCell / 4;
    scene.rules.tuning.startThreshold = sand::kUnitsPerCell + sand::kUnitsPerCell / 10;
    scene.rules.rim = sand::Rim::open;
    return scene;
}

/// Rocky sand with every tool.
void everyTool(const std::filesystem::path& folder, int frames = 200) {
    const scene::Scene scene = rockyScene(6);
    Written session(scene, false);  // the hand never waits
    std::mt19937 random(73);
    for (int frame = 0; frame < frames; ++frame) {
        session.frame(1, [&](std::uint64_t number) { return samples::wildStep(number, scene.rules, random); });
    }
    session.end(folder / "every_tool.journal");
}

/// Rocky sand with a tool that has a coarse phase. It is lifted, and becomes a foot.
void coarsePhases(const std::filesystem::path& folder) {
    scene::Scene scene = rockyScene(30);
    scene.rules.tuning.sweepsPerStep = 150;
    sand::Tuning foot = scene.rules.tuning;
    foot.tool.kind = sand::ToolKind::footprint;
    foot.tool.halfWidth = foot.tool.radius / 2;
    Written session(scene);
    int phases = 0;
    for (int frame = 0; frame < 65; ++frame) {
        session.frame(2, [&](std::uint64_t number) {
            sand::Step step = loops(session, number);
            if (number == 60) {
                step.edit = sand::Edit::tuned(foot);
                step.edit.number = 1;
            }
            phases += session.sand().hasCoarsePhase(step) ? 1 : 0;
            return step;
        });
    }
    if (phases < 50) {
        throw std::logic_error(fmt::format("{} coarse phases show little", phases));
    }
    session.end(folder / "coarse_phases.journal");
}

/// A short session of a kind of tool, turned and mirrored. The tool is in the sand at the end.
void shape(const std::string& name, sand::ToolKind kind, double humidity, const std::filesystem::path& folder,
           int frames = 20) {
    scene::Scene scene = samples::flatScene(160, 120, 14);
    sand::grid::makeDunes({.bed = 4, .height = 8, .length = 50, .seed = 3}, scene.terrain);
    sand::Tool& tool = scene.rules.tuning.tool;
    tool.kind = kind;
    tool.halfWidth = sand::isRound(kind) ? 0 : static_cast<std::int32_t>(tool.radius * sand::usualWidth(kind));
    tool.heading = sand::headingOf(25, kind == sand::ToolKind::footprint).value();
    scene.material.humidity = humidity;
    Written session(scene);
    for (int frame = 0; frame < frames; ++frame) {
        session.frame(2, [&](std::uint64_t number) { return loops(session, number); });
    }
    session.end(folder / (name + ".journal"));
}

/// Sessions of one grid, one TIN and three tools.
void forPictures(const std::filesystem::path& folder) {
    constexpr int kFrames = 3;
    everyTool(folder, kFrames);
    sampleScene("gis_tin", folder, kFrames);
    for (const sand::ToolKind kind : {sand::ToolKind::sphere, sand::ToolKind::rectangle, sand::ToolKind::footprint}) {
        shape(fmt::format("tool_{}", base::nameOf(kind)), kind, 0, folder, kFrames);
    }
}

/// A session of `steps` steps without edits. `radius` replaces the scene's, if it is not 0 [cell].
void longSession(const std::string& name, const std::string& file, double radius, int steps, int stepsPerFrame,
                 const std::filesystem::path& folder) {
    scene::Scene scene = scene::loadScene("scenes/" + name + ".toml");
    if (radius > 0) {
        scene.rules.tuning.tool.radius = static_cast<std::int32_t>(radius * sand::kProbePerCell);
    }
    Written session(scene, false);
    for (int frame = 0; frame < steps / stepsPerFrame; ++frame) {
        session.frame(stepsPerFrame, [&](std::uint64_t number) { return loops(session, number); });
    }
    session.end(folder / (file + ".journal"));
}

}  // namespace

int main(int count, char** arguments) {
    const std::string what = count == 3 ? arguments[2] : "";
    if (count < 2 || count > 3 ||
        (count == 3 && what != "browser" && what != "pictures" && what != "times" && what != "hour")) {
        fmt::print(stderr, "usage: session_files FOLDER [browser|pictures|times|hour]\n");
        return 2;
    }
    const std::filesystem::path folder = arguments[1];
    if (what == "browser") {
        sampleScene("gis_tin", folder);
        everyTool(folder);
        return 0;
    }
    if (what == "pictures") {
        forPictures(folder);
        return 0;
    }
    if (what == "times") {
        longSession("writing", "small_tool", 2.56, 1800, 4, folder);
        longSession("writing", "large_tool", 12, 1800, 4, folder);
        longSession("dunes", "dunes", 0, 600, 4, folder);
        longSession("gis_tin", "gis_tin", 0, 600, 4, folder);
        return 0;
    }
    if (what == "hour") {
        longSession("writing", "hour", 2.56, 216000, 8, folder);
        return 0;
    }
    for (const char* const name : {"writing", "dunes", "gis_tin", "footprints"}) {
        sampleScene(name, folder);
    }
    everyEdit("edits_of_a_grid", scene::loadScene("scenes/stroke.toml"), folder);
    everyEdit("edits_of_a_tin", scene::loadScene("scenes/gis_tin.toml"), folder);
    everyTool(folder);
    coarsePhases(folder);
    for (const auto& [kind, name] : sand::valuesOf(sand::ToolKind{})) {
        shape(fmt::format("tool_{}", name), kind, 0, folder);
    }
    shape("wet", sand::ToolKind::sphere, 0.6, folder);
    return 0;
}
