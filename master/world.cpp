// SPDX-License-Identifier: Apache-2.0
#include "master/world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/input_error.hpp"
#include "host/event.hpp"
#include "host/phase_progress.hpp"
#include "host/print_line.hpp"
#include "host/regular_file.hpp"
#include "lockstep/overlays.hpp"
#include "lockstep/watchdog.hpp"
#include "master/drills/injection.hpp"
#include "master/journal/journal.hpp"
#include "master/start_up.hpp"
#include "scene/load/sand_size.hpp"
#include "scene/load/scene_file.hpp"
#include "scene/load/step_cost.hpp"
#include "walls/desk_windows.hpp"
#include "walls/wall_units.hpp"

namespace master {
namespace {

constexpr double kAllRead = 0.99;  // part of a raster's heights after which the rest is short

/// Returns a function that prints the progress of some work and tells it to the ranks of `cluster`, which wait for it.
/// Work that begins again, with a smaller part, counts as progress. `phase` and `what` are as of host::PhaseProgress.
/// `work` names the work as in Cluster::progress().
std::function<void(double)> told(const lockstep::Cluster& cluster, std::string phase, std::string what,
                                 const char* work) {
    return [&cluster, work, phase = std::move(phase), what = std::move(what), last = 0.0,
            progress = std::optional<host::PhaseProgress>()](double share) mutable {
        if (!progress) {  // the phase begins
            progress.emplace(phase, what, [](const std::string& line) { host::printLine("{}", line); });
        }
        progress->done(share);
        if (share < last || share >= 1) {
            cluster.progressEnds();  // work follows that cannot tell its progress
        }
        last = share;
        if (share < 1) {
            cluster.progress(work, share);
        }
    };
}

/// Tells where the session continues.
void sayResumed(const ResumedSession& resumed) {
    if (resumed.cutBytes > 0) {
        host::printLine("{}: the last {} bytes are an incomplete write and are cut off", resumed.place.journal,
                        resumed.cutBytes);
    }
    host::emitEvent("resumed", {{"step", resumed.step},
                                {"frame", resumed.frame},
                                {"checkpoint_step", resumed.checkpointStep},
                                {"replayed_steps", resumed.replayedSteps},
                                {"cut_bytes", resumed.cutBytes}});
    host::printLine("{}: continues after step {}, frame {}, from {} and {} later steps", resumed.place.journal,
                    resumed.step, resumed.frame,
                    resumed.checkpointStep == 0 ? std::string("the scene")
                                                : fmt::format("the checkpoint of step {}", resumed.checkpointStep),
                    resumed.replayedSteps);
}

/// Opens the session in --out, if there is one.
std::optional<StoppedSession> openStopped(const MemoryUse& use, const ProgramOptions& options) {
    const std::filesystem::path journal = std::filesystem::path(options.out) / "session.journal";
    if (options.session.record.journal.policy == JournalPolicy::off) {
        throw base::InputError("--resume needs the journal of the session; leave out --journal off");
    }
    std::optional<StoppedSession> stopped = openSession(
        journal, options.scene, [&](const journal::JournalReader& reader) { requireMemoryOfJournal(use, reader); });
    if (!stopped) {
        host::printLine("{}: nothing to resume; the session begins", journal.string());
    }
    return stopped;
}

/// Returns the scene of the file `file`. Tells the ranks of `cluster` the progress.
scene::Scene readScene(const lockstep::Cluster& cluster, const MemoryUse& use, const std::string& file) {
    scene::SizeCollector sizes;
    const auto require = [&](const scene::FieldToMake& field) {
        requireMemory(use, sizes.with(field), file);
        requireMasterFits(use, sizes.with(field), file);
    };
    host::PhaseProgress progress("read", "reads the scene",
                                 [](const std::string& line) { host::printLine("{}", line); });
    const auto tell = [&](double share) {
        progress.done(share);
        if (share < kAllRead) {
            cluster.progress("the reading of its scene", share);
        } else {
            cluster.progressEnds();  // a mesh that is made of the raster cannot tell its progress
        }
    };
    scene::Scene scene = scene::loadScene(file, {.raster =
                                                     [&](const scene::RasterSize& size) {
                                                         requireMemoryOfRaster(use.hosts, size, file);
                                                         sizes.addRaster(size);
                                                     },
                                                 .field = require,
                                                 .fieldAtMost = require,
                                                 .progress = tell});
    cluster.progressEnds();
    for (const scene::RasterStatement& statement : *scene.statements) {
        host::printLine("{}: {}", statement.file, statement.text());
    }
    for (const std::string& warning : scene.warnings) {
        host::printLine("{}: warning: {}", file, warning);
    }
    const std::optional<scene::StepCost> cost = scene::costOfALargeTool(scene);
    if (const std::string slow = cost ? cost->longFrameText(file) : std::string(); !slow.empty()) {
        host::printLine("{}", slow);
    }
    return scene;
}

/// Opens the journal of --replay, and returns its scene.
scene::Scene openRecording(const MemoryUse& use, ProgramOptions& options) {
    options.replay = journalAt(options.replay).string();
    if (std::filesystem::exists(std::filesystem::path(options.out) / "session.journal")) {
        throw base::InputError(
            fmt::format("{}: holds a session, whose results would be lost; choose another --out", options.out));
    }
    requireMemoryOfJournal(use, openJournal(options.replay));
    SessionOptions& session = options.session;
    session.recording = std::make_shared<const journal::Recording>(readJournal(options.replay), options.replay,
                                                                   options.framesPerSecond, options.span);
    if (!session.recording->shortcoming().empty()) {
        host::printLine("{}", session.recording->shortcoming());
    }
    session.refreshHz = options.framesPerSecond;
    return session.recording->scene();
}

/// Returns the scene of --scene, of the journal that is replayed, or of the session `stopped` that is resumed.
scene::Scene loadScene(const lockstep::Cluster& cluster, const MemoryUse& use, ProgramOptions& options,
                       std::optional<StoppedSession>& stopped) {
    options.session.record.journal.partBytes = options.partMegabytes << 20;
    if (stopped) {
        options.scene = options.scene.empty() ? options.out : options.scene;  // for error messages
        return std::exchange(stopped->scene, scene::Scene());                 // not kept twice
    }
    if (!options.replay.empty()) {
        return openRecording(use, options);
    }
    if (options.scene.empty()) {
        throw base::InputError("name a --scene, or a journal to --replay");
    }
    return readScene(cluster, use, options.scene);
}

/// Returns the name of the scene for the titles of windows: its own, or that of its file, or of the folder of its
/// journal. The file of terrain that became a scene, and the folder of a resumed session, have other names.
std::string sceneName(const ProgramOptions& options, const scene::Scene& loaded) {
    if (!loaded.name.empty()) {
        return loaded.name;
    }
    const std::filesystem::path scene(options.scene);
    return !scene.empty() ? scene.stem().string()
                          : std::filesystem::path(options.replay).parent_path().filename().string();
}

walls::Wall loadWall(const ProgramOptions& options) {
    walls::Wall wall = walls::loadWallAs(options.wall, options.stereo);
    return options.desk.empty()
               ? wall
               : walls::placedOnDesk(wall, walls::DeskArea::parse(options.desk, "--desk"), options.wall);
}

/// Throws base::InputError if the wall needs other ranks than the job has, or ranks on other machines.
void requireRanks(const lockstep::Cluster& cluster, const walls::Wall& wall, const ProgramOptions& options) {
    if (wall.ranks() != cluster.renderRanks()) {
        throw base::InputError(
            fmt::format("{}: {} tiles need {} render ranks, but the job has {}: mpirun -n 1 "
                        "sandwall-master ... : -n {} sandwall-render-node",
                        options.wall, wall.ranks(), wall.ranks(), cluster.renderRanks(), wall.ranks()));
    }
    std::vector<RankMachine> places;
    std::transform(options.places.begin(), options.places.end(), std::back_inserter(places), RankMachine::parse);
    requirePlaces(cluster.hosts(), wall, places);
}

void makeOut(const std::string& out) {
    try {
        host::makeFolders(out);
    } catch (const std::filesystem::filesystem_error& error) {
        throw base::InputError(
            fmt::format("{}: cannot be made ({}); choose another --out", out, error.code().message()));
    }
}

void chooseFilm(ProgramOptions& options, const walls::Wall& wall) {
    if (options.session.film) {
        options.session.pace = haptic_bridge::Pace::fast;
        (void)Film(wall, options.session.filmEye, options.out);  // throws before anything is drawn
    }
}

void chooseHand(ProgramOptions& options) {
    if (options.haptic == "none") {
        return;
    }
    if (options.session.pointer) {
        throw base::InputError("--pointer: with --haptic there are two hands; leave one of them out");
    }
    options.session.server = haptic_bridge::Address::parse(options.haptic, "--haptic");
    options.session.security = options.link.forClient(haptic_bridge::Role::move);
    haptic_bridge::requireSecret(*options.session.server, options.session.security, "--haptic");
}

void chooseView(ProgramOptions& options, const World& world) {
    DeskOptions& desk = options.session.desk;
    desk.pointer = options.session.pointer;
    desk.film = options.session.film;
    if (!options.view.empty()) {
        desk.view = walls::Orbit::parse(options.view, "--view");
    }
    desk.visibleTool = desk.visibleTool && !world.stopped;  // a person may have chosen another
    desk.pattern = lockstep::parsePattern(options.pattern);
    desk.layers.set(lockstep::Overlay::hillShade, world.scene.look.hillShade);
    for (const std::string& layer : options.layers) {
        desk.layers.set(lockstep::parseOverlay(layer), true);
    }
    if (!options.track.empty()) {
        desk.tracker = tracking::Source::parse(options.track, "--track");
    } else if (!world.wall.tracking.empty()) {
        desk.tracker = tracking::Source::parse(world.wall.tracking, options.wall + ": source",
                                               std::filesystem::path(options.wall).parent_path());
    }
}

/// Returns the drills of --inject that are still to happen.
std::vector<Drill> drillsOf(const ProgramOptions& options, const World& world) {
    const FaultTargets targets{world.wall.ranks(), world.scene.rules.columns, world.scene.rules.rows,
                               options.session.server.has_value(), world.scene.recordsMovement()};
    std::vector<Drill> drills;
    for (const std::string& text : options.injections) {
        drills.push_back({text, parseFault(text, targets)});
    }
    return withoutDone(std::move(drills), options.out, world.stopped.has_value());
}

}  // namespace

World loadWorld(const lockstep::Cluster& cluster, ProgramOptions& options) {
    lockstep::requireStartUpLimit();
    cluster.mayTakeLong(true);  // until broadcastSession()
    requireFolder(options.out);
    walls::Wall wall = loadWall(options);
    const JournalOptions& journal = options.session.record.journal;
    const MemoryUse use{cluster.hosts(), wall, journal.policy != JournalPolicy::off && journal.checkpointSeconds > 0};
    std::optional<StoppedSession> stopped = options.resume ? openStopped(use, options) : std::nullopt;
    scene::Scene scene = loadScene(cluster, use, options, stopped);
    requireMemory(use, scene, options.scene + options.replay);
    World world{std::move(scene), std::move(wall), {}, std::move(stopped)};
    if (world.scene.packed == nullptr) {  // the scene of a resumed session is still packed
        world.scene.pack();
    }
    requireRanks(cluster, world.wall, options);
    makeOut(options.out);
    SessionOptions& session = options.session;
    session.pictures = !options.noPictures;
    session.report = !options.noReport;
    session.out = options.out;
    chooseFilm(options, world.wall);
    chooseHand(options);
    chooseView(options, world);
    session.drills = drillsOf(options, world);
    world.message = {world.scene.encode(),     world.wall.encode(),
                     session.frameTimeout,     {},
                     session.pointer,          sceneName(options, world.scene),
                     world.stopped.has_value()};
    for (const Drill& drill : session.drills) {
        world.message.faults.push_back(drill.fault);
    }
    for (const std::string& warning : walls::unitWarnings(world.wall)) {
        host::printLine("{}: warning: {}", options.wall, warning);
    }
    return world;
}

base::Bytes resumeSand(const lockstep::Cluster& cluster, World& world, ProgramOptions& options) {
    const StoppedSession stopped = std::move(world.stopped.value());
    cluster.mayTakeLong(true);  // until broadcastState()
    ResumedState resumed =
        resumeSession(stopped, world.scene,
                      {.read = told(cluster, "read_journal", "reads the journal", "the reading of its journal"),
                       .replayed = told(cluster, "replay", "replays the journal", "the replay of its journal")},
                      options.session.executor);
    cluster.progressEnds();
    if (stopped.check->isShort()) {
        stopped.check->require(told(cluster, "read", "reads the scene", "the reading of its scene"));
        cluster.progressEnds();
    } else {
        options.session.record.check = stopped.check;
    }
    sayResumed(resumed.session);
    options.session.record.resumed = std::make_shared<const ResumedSession>(std::move(resumed.session));
    return std::move(resumed.state);
}

}  // namespace master
