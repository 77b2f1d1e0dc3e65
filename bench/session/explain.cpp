// SPDX-License-Identifier: Apache-2.0
// Lists the parts that one scene loads and runs, and the parts that it leaves out, with the cost of each on this
// machine.
#include <fstream>
#include <map>
#include <random>
#include <sstream>

#include "bench/report/curves.hpp"
#include "bench/report/timing.hpp"
#include "bench/sand/relaxations.hpp"
#include "sand/grid/erosion.hpp"
#include "sand/grid/tile_hash.hpp"
#include "sand/replica.hpp"
#include "sand/tin/geometry/surface_view.hpp"
#include "scene/load/sand_size.hpp"
#include "scene/load/step_cost.hpp"
#include "scene/model/start_time.hpp"

namespace bench {
namespace {

using sand::kProbePerCell;

/// Returns the size of every library that this process has mapped [byte], by name.
std::map<std::string, std::size_t> mappedLibraries() {
    std::map<std::string, std::size_t> libraries;
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);) {
        std::istringstream words(line);
        std::string range, permissions, offset, device, inode, file;
        words >> range >> permissions >> offset >> device >> inode >> file;
        if (file.find(".so") == std::string::npos) {
            continue;
        }
        const std::size_t dash = range.find('-');
        libraries[std::filesystem::path(file).filename()] +=
            std::stoull(range.substr(dash + 1), nullptr, 16) - std::stoull(range.substr(0, dash), nullptr, 16);
    }
    return libraries;
}

/// The rows of the explanation: kind of part, name, whether this scene uses it, cost, and reason.
class Explanation {
public:
    explicit Explanation(Csv& csv) : csv_(csv) { csv_.columns("kind,part,used,cost,unit,why"); }

    void memory(const char* part, std::size_t bytes, const std::string& why) {
        csv_.row("memory", part, bytes > 0 ? "yes" : "no", bytes, "byte", why);
    }
    void rule(const char* part, bool used, const std::string& why) {
        csv_.row("rule", part, used ? "yes" : "no", "", "", why);
    }
    void step(const char* what, const std::vector<double>& seconds, const std::string& why) {
        csv_.row("step", what, "yes", spreadOf(seconds).median * 1e6, "us", why);
    }
    void library(const std::string& name, std::size_t bytes) {
        csv_.row("library", name, "yes", bytes, "byte", "mapped into this program");
    }

private:
    Csv& csv_;
};

void explainTinMemory(const scene::Scene& scene, Explanation& rows) {
    const sand::Replica replica(scene);
    const sand::tin::Triangles& mesh = std::get<sand::TinData>(replica.surface().data()).view.triangles;
    const std::size_t perVertex = sizeof(sand::tin::LatticePoint) + 2 * sizeof(std::int32_t) + 4 * sizeof(std::int64_t);
    rows.memory("vertices", mesh.places.size() * perVertex,
                fmt::format("{} of them: place, volume, share of the ground, height, hash", mesh.places.size()));
    rows.memory("triangles", mesh.triangles.size() * sizeof(sand::tin::Triangle),
                fmt::format("{} of them: corners, neighbours, constraints", mesh.triangles.size()));
    rows.memory("bedrock and walls", 0, "a TIN has none");
}

void explainMemory(const scene::Scene& scene, Explanation& rows) {
    if (scene.tin != nullptr) {
        explainTinMemory(scene, rows);
        return;
    }
    const sand::grid::Erosion erosion(scene.terrain, scene.rules,
                                      sand::grid::Erosion::Options{.ground = scene.ground.get()});
    const sand::grid::TileHash hash(scene.terrain);
    rows.memory("heights",
                static_cast<std::size_t>(scene.terrain.stride()) * static_cast<std::size_t>(scene.rules.rows + 2) *
                    sizeof(std::int32_t),
                fmt::format("{} x {} cells of 4 bytes and their rim", scene.rules.columns, scene.rules.rows));
    rows.memory("fluxes and blocks", erosion.bytes(),
                fmt::format("a flux per face; flags per block of {0} x {0} cells", sand::grid::Erosion::kDefaultBlock));
    rows.memory("hash tiles", static_cast<std::size_t>(hash.tileCount()) * (sizeof(std::uint64_t) + 1),
                "a hash and a flag per tile of 32 x 32 cells");
    rows.memory("bedrock and walls", scene.ground ? scene.ground->cells().bytes() : 0,
                scene.ground ? "a height of rock per cell" : "the scene has none");
}

/// Lists the memory of each process of a session on the desktop wall, as the check before the start takes it.
void explainProcesses(const scene::SandSize& sand, Explanation& rows) {
    constexpr std::int64_t kFrameBuffers = std::int64_t{12} * 1280 * 720;  // [byte]
    const auto explain = [&rows](const std::string& process, const scene::MemoryFigures& figures) {
        const auto row = [&](const char* when, std::int64_t bytes, const char* why) {
            rows.memory((process + when).c_str(), static_cast<std::size_t>(bytes), why);
        };
        row(" at rest", figures.rest, "at most; with a stroke kept for an undo");
        row(" at the start", figures.peak, "at most; until the sand rests for the first time");
        row(" while all moves", figures.moving, "at most; with a stroke kept and a checkpoint being written");
    };
    explain("haptic server", scene::ProcessMemory::ofServer(sand).figures());
    explain("master", scene::ProcessMemory::ofMaster(sand).figures());
    explain("render rank", scene::ProcessMemory::ofRank(sand, kFrameBuffers).figures());
}

void explainRules(const scene::Scene& scene, Explanation& rows) {
    const sand::Rules& rules = scene.rules;
    const bool grid = scene.tin == nullptr;
    rows.rule("flux over a TIN's edges", !grid, "only with [tin]");
    rows.rule("isotropic flux with inertia", grid && rules.scheme == sand::Scheme::isotropic, "scheme = g");
    rows.rule("layer limiter", scene.ground != nullptr, "only with bedrock or walls");
    rows.rule("non-square cells", rules.aspect != sand::kUnitsPerCell,
              "a law per axis: only where a cell is not square");
    rows.rule("outflow over the rim", rules.rim == sand::Rim::open, "only with rim = open");
    rows.rule("hysteresis band", rules.tuning.startThreshold > rules.tuning.threshold,
              fmt::format("{} and {} units", rules.tuning.threshold, rules.tuning.startThreshold));
    rows.rule("tool as an obstacle", rules.tuning.tool.radius > 0, "only in patches that the engaged tool reaches");
}

std::vector<double> timeSteps(sand::Replica& replica, const std::vector<sand::Step>& steps, std::uint64_t& hash) {
    std::vector<double> seconds;
    for (sand::Step step : steps) {
        step.epoch = 1;
        step.number = replica.stepNumber() + 1;
        seconds.push_back(secondsOf([&] {
            replica.apply(step);
            hash ^= replica.stateHash();
        }));
    }
    return seconds;
}

/// Returns the scene with noise in its sand, so that nearly all sand moves. The noise is as high as the scene's tool,
/// and at least a cell. It is limited to the heights that a TIN's volumes can hold.
scene::Scene stirred(const scene::Scene& scene, std::uint32_t seed) {
    std::mt19937 random(seed);
    scene::Scene result = scene;
    const auto range = static_cast<std::uint32_t>(std::max(scene.rules.tuning.tool.radius / kProbePerCell, 1) * 4) *
                       static_cast<std::uint32_t>(sand::kUnitsPerCell);
    if (scene.tin != nullptr) {
        auto start = *scene.tin;
        const auto most = static_cast<std::int32_t>(
            std::min<double>(sand::kMaxHeight, sand::tin::mostHeight(scene.rules.columns, scene.rules.rows)));
        for (std::int32_t& height : start.heights) {
            const auto noise = static_cast<std::int32_t>(random() % std::min(range, static_cast<std::uint32_t>(most)));
            height = std::min(height, most - noise) + noise;
        }
        result.rules.tin = start.digest();
        result.tin = std::make_shared<const sand::tin::TinStart>(std::move(start));
        return result;
    }
    for (int y = 0; y < scene.rules.rows; ++y) {
        for (int x = 0; x < scene.rules.columns; ++x) {
            const auto noise = static_cast<std::int32_t>(random() % range);
            result.terrain.setHeight(x, y, std::min(scene.terrain.height(x, y), sand::kMaxHeight - noise) + noise);
        }
    }
    return result;
}

void explainSteps(const scene::Scene& scene, const Settings& settings, Explanation& rows) {
    const std::string sweepsPerStep = fmt::format("{} sweeps at most", scene.rules.sweepPlan().still);
    const auto runs = static_cast<std::size_t>(settings.runs);
    std::uint64_t hash = 0;

    progress("the scene comes to rest");
    constexpr std::uint64_t kMostSteps = 100000;
    sand::Replica replica(scene);
    std::vector<double> toRest;
    while (!replica.settled() && replica.stepNumber() < kMostSteps) {
        toRest.push_back(timeSteps(replica, {sand::Step{}}, hash).front());
    }
    rows.step("while the scene comes to rest", toRest, fmt::format("{} steps of {}", toRest.size(), sweepsPerStep));
    rows.step("settled; hovering", timeSteps(replica, std::vector<sand::Step>(runs), hash), "no block is visited");

    progress("small edits and digging");
    const std::int32_t z = static_cast<std::int32_t>(
        replica.surface().height(scene.rules.columns * 128.0, scene.rules.rows * 128.0) / 256);
    const auto at = [&](double share) {
        return sand::ProbePoint{static_cast<std::int32_t>(scene.rules.columns * share * kProbePerCell),
                                scene.rules.rows * kProbePerCell / 2, z};
    };
    std::vector<sand::Step> stroke{{1, 0, true, {at(0.3)}}};
    const auto press = timeSteps(replica, stroke, hash);
    rows.step("one small edit", press,
              fmt::format("the tool presses half of itself in; {} sweeps at most", scene.rules.sweepPlan().moved));
    stroke.clear();
    for (std::size_t i = 0; i < runs; ++i) {
        stroke.push_back({1, 0, true, {at(0.3 + 0.4 * static_cast<double>(i + 1) / static_cast<double>(runs))}});
    }
    rows.step("digging", timeSteps(replica, stroke, hash), fmt::format("two fifths of the field in {} steps", runs));

    progress("everything moving");
    constexpr std::size_t kMoving = 10;  // before much of it rests
    sand::Replica moving(stirred(scene, settings.seed));
    rows.step("everything moving", timeSteps(moving, std::vector<sand::Step>(kMoving), hash),
              fmt::format("{} steps of {}", kMoving, sweepsPerStep));
}

}  // namespace

void explain(const Settings& settings, Csv& csv) {
    scene::SizeCollector sizes;
    const scene::Scene scene = scene::loadScene(settings.scene, sizes.checks());
    for (const scene::RasterStatement& statement : *scene.statements) {
        csv.note(statement.file + ": " + statement.text());
    }
    for (const std::string& warning : scene.warnings) {
        csv.note("warning: " + warning);
    }
    csv.note(fmt::format("scene: {}, {} sweeps per step, tool of {:.3g} cells", scene.name,
                         scene.rules.sweepPlan().still,
                         static_cast<double>(scene.rules.tuning.tool.radius) / kProbePerCell));
    csv.note(fmt::format("step: median CPU time of one thread, hash included, of {} steps unless `why` says otherwise",
                         settings.runs));
    if (const auto cost = scene::stepCostOf(scene)) {
        csv.note(cost->text(scene));
    }
    csv.note(scene::StartTime::of(sizes.of(scene)).text());
    Explanation rows(csv);
    explainMemory(scene, rows);
    explainProcesses(sizes.of(scene), rows);
    explainRules(scene, rows);
    explainSteps(scene, settings, rows);
    for (const auto& [name, bytes] : mappedLibraries()) {
        rows.library(name, bytes);
    }
}

}  // namespace bench
