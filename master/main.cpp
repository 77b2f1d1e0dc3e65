// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <limits>
#include <string_view>

#include "base/input_error.hpp"
#include "haptic_bridge/link/link_options.hpp"
#include "host/build_id.hpp"
#include "host/command_line.hpp"
#include "host/event.hpp"
#include "host/print_line.hpp"
#include "host/rank_output.hpp"
#include "host/regular_file.hpp"
#include "host/version.hpp"
#include "host/worker_pool.hpp"
#include "lockstep/clock_sync.hpp"
#include "lockstep/session_message.hpp"
#include "lockstep/watchdog.hpp"
#include "master/injection.hpp"
#include "master/journal/journal.hpp"
#include "master/session.hpp"
#include "master/start_up.hpp"
#include "scene/load/scene_file.hpp"
#include "walls/desk_windows.hpp"
#include "walls/wall.hpp"

namespace {

struct Options {
    std::string scene, replay, wall, haptic = "none", out;
    int framesPerSecond = 30;   // of a replay
    std::string stereo, track;  // empty: as in the wall file
    std::string desk;           // empty: the wall is not shown on a desktop
    std::string pattern = "none";
    std::vector<std::string> layers;
    std::vector<std::string> injections;
    std::vector<std::string> places;
    bool noPictures = false;
    bool noReport = false;
    master::SessionOptions session;
    bool resume = false;
    std::int64_t partMegabytes = master::kPartBytes >> 20;
    haptic_bridge::LinkOptions link;
    int sandThreads = 1;
};

/// Contents of the files that the user named, and the message with them for all ranks.
struct World {
    scene::Scene scene;
    walls::Wall wall;
    lockstep::SessionMessage message;
};

/// Finds the place where the session in --out stopped, if there is one.
void resume(const lockstep::Cluster& cluster, Options& options) {
    const std::filesystem::path journal = std::filesystem::path(options.out) / "session.journal";
    if (options.session.record.journal.policy == master::JournalPolicy::off) {
        throw base::InputError("--resume needs the journal of the session; leave out --journal off");
    }
    if (std::error_code none; std::filesystem::exists(journal, none)) {
        master::requireMemoryOfJournal(cluster.hosts(), journal);
    }
    std::optional<master::ResumedSession> resumed = master::readSession(journal, options.scene);
    if (!resumed) {
        host::printLine("{}: nothing to resume; the session begins", journal.string());
        return;
    }
    if (resumed->cutBytes > 0) {
        host::printLine("{}: the last {} bytes are an incomplete write and are cut off", journal.string(),
                        resumed->cutBytes);
    }
    host::emitEvent("resumed", {{"step", resumed->step},
                                {"frame", resumed->frame},
                                {"checkpoint_step", resumed->checkpointStep},
                                {"replayed_steps", resumed->replayedSteps},
                                {"cut_bytes", resumed->cutBytes}});
    host::printLine("{}: continues after step {}, frame {}, from {} and {} later steps", journal.string(),
                    resumed->step, resumed->frame,
                    resumed->checkpointStep == 0 ? std::string("the scene")
                                                 : fmt::format("the checkpoint of step {}", resumed->checkpointStep),
                    resumed->replayedSteps);
    options.session.record.resumed = std::make_shared<const master::ResumedSession>(std::move(*resumed));
}

/// Returns the scene of --scene, of the journal that is replayed, or of the session that is resumed.
scene::Scene loadScene(const lockstep::Cluster& cluster, Options& options) {
    options.session.record.journal.partBytes = options.partMegabytes << 20;
    if (options.resume) {
        resume(cluster, options);
        if (options.session.record.resumed) {
            options.scene = options.scene.empty() ? options.out : options.scene;  // for error messages
            return options.session.record.resumed->scene;
        }
    }
    if (options.replay.empty()) {
        if (options.scene.empty()) {
            throw base::InputError("name a --scene, or a journal to --replay");
        }
        const std::vector<lockstep::RankHost>& hosts = cluster.hosts();
        const std::string& file = options.scene;
        scene::Scene scene = scene::loadScene(
            file, {.raster = [&](int columns, int rows) { master::requireMemoryOfRaster(hosts, columns, rows, file); },
                   .field = [&](const sand::FieldSize& size) { master::requireMemory(hosts, size, file); }});
        for (const scene::RasterStatement& statement : *scene.statements) {
            host::printLine("{}: {}", statement.file, statement.text());
        }
        for (const std::string& warning : scene.warnings) {
            host::printLine("{}: warning: {}", options.scene, warning);
        }
        return scene;
    }
    options.replay = master::journalAt(options.replay).string();
    if (std::filesystem::exists(std::filesystem::path(options.out) / "session.journal")) {
        throw base::InputError(
            fmt::format("{}: holds a session, whose results would be lost; choose another --out", options.out));
    }
    master::requireMemoryOfJournal(cluster.hosts(), options.replay);
    master::SessionOptions& session = options.session;
    session.recording = std::make_shared<const journal::Recording>(master::readJournal(options.replay), options.replay,
                                                                   options.framesPerSecond);
    if (!session.recording->shortcoming().empty()) {
        host::printLine("{}", session.recording->shortcoming());
    }
    session.refreshHz = options.framesPerSecond;
    return session.recording->scene();
}

/// Returns the name of the scene for the titles of windows: that of its file, or of the folder of its journal.
std::string sceneName(const Options& options) {
    const std::filesystem::path scene(options.scene);
    return !scene.empty() ? scene.stem().string()
                          : std::filesystem::path(options.replay).parent_path().filename().string();
}

World loadWorld(const lockstep::Cluster& cluster, Options& options) {
    lockstep::requireStartUpLimit();
    cluster.mayTakeLong(true);  // until broadcastSession()
    master::requireFolder(options.out);
    World world{loadScene(cluster, options), walls::loadWallAs(options.wall, options.stereo), {}};
    if (!options.desk.empty()) {
        world.wall = walls::placedOnDesk(world.wall, walls::DeskArea::parse(options.desk, "--desk"), options.wall);
    }
    master::requireMemory(cluster.hosts(), world.scene, options.scene + options.replay);
    if (world.wall.ranks() != cluster.renderRanks()) {
        throw base::InputError(fmt::format(
            "{}: {} tiles need {} render ranks, but the job has {}: mpirun -n 1 "
            "sandwall-master ... : -n {} sandwall-render-node",
            options.wall, world.wall.ranks(), world.wall.ranks(), cluster.renderRanks(), world.wall.ranks()));
    }
    std::vector<master::RankMachine> places;
    std::transform(options.places.begin(), options.places.end(), std::back_inserter(places),
                   master::RankMachine::parse);
    master::requirePlaces(cluster.hosts(), world.wall, places);
    try {
        host::makeFolders(options.out);
    } catch (const std::filesystem::filesystem_error& error) {
        throw base::InputError(
            fmt::format("{}: cannot be made ({}); choose another --out", options.out, error.code().message()));
    }
    if (options.session.film) {
        options.session.pace = haptic_bridge::Pace::fast;
        (void)master::Film(world.wall, options.session.filmEye, options.out);  // throws before anything is drawn
    }
    if (options.haptic != "none") {
        if (options.session.pointer) {
            throw base::InputError("--pointer: with --haptic there are two hands; leave one of them out");
        }
        options.session.server = haptic_bridge::Address::parse(options.haptic, "--haptic");
        options.session.security = options.link.forClient(haptic_bridge::Role::move);
        haptic_bridge::requireSecret(*options.session.server, options.session.security, "--haptic");
    }
    options.session.pictures = !options.noPictures;
    options.session.report = !options.noReport;
    options.session.out = options.out;
    options.session.desk.pointer = options.session.pointer;
    options.session.desk.film = options.session.film;
    options.session.desk.pattern = lockstep::parsePattern(options.pattern);
    options.session.desk.layers.set(lockstep::Overlay::hillShade, world.scene.look.hillShade);
    for (const std::string& layer : options.layers) {
        options.session.desk.layers.set(lockstep::parseOverlay(layer), true);
    }
    if (!options.track.empty()) {
        options.session.desk.tracker = tracking::Source::parse(options.track, "--track");
    } else if (!world.wall.tracking.empty()) {
        options.session.desk.tracker = tracking::Source::parse(world.wall.tracking, options.wall + ": source",
                                                               std::filesystem::path(options.wall).parent_path());
    }
    world.message = {world.scene.encode(),
                     world.wall.encode(),
                     options.session.frameTimeout,
                     {},
                     options.session.pointer,
                     sceneName(options),
                     options.session.record.resumed ? options.session.record.resumed->state : base::Bytes()};
    const master::FaultTargets targets{world.wall.ranks(), world.scene.rules.columns, world.scene.rules.rows,
                                       options.session.server.has_value()};
    for (const std::string& text : options.injections) {
        options.session.drills.push_back({text, master::parseFault(text, targets)});
    }
    options.session.drills = master::withoutDone(std::move(options.session.drills), options.session.out,
                                                 options.session.record.resumed != nullptr);
    for (const master::Drill& drill : options.session.drills) {
        world.message.faults.push_back(drill.fault);
    }
    return world;
}

/// Makes the watchdog of the start and the end write failure.json. `wall` is null until it is known.
void setLastWords(const lockstep::Cluster& cluster, const Options& options, const walls::Wall* wall) {
    master::RankLabels labels;
    if (wall != nullptr) {
        labels = master::RankLabels::of(cluster, *wall);
    } else {
        for (const lockstep::RankHost& host : cluster.hosts()) {
            labels.hosts.push_back(host.name);
        }
        labels.tiles.resize(labels.hosts.size());
    }
    cluster.setLastWords(labels.names, [labels, out = options.out](int rank, const std::string& line) {
        (void)master::writeFailure(labels.failure("hung", rank, line), out);
    });
}

int runSession(const lockstep::Cluster& cluster, Options& options) {
    std::optional<World> world;
    bool sessionOpen = false;
    setLastWords(cluster, options, nullptr);
    try {
        world.emplace(loadWorld(cluster, options));
        setLastWords(cluster, options, &world->wall);
        (void)lockstep::broadcastSession(cluster, world->message);
        sessionOpen = true;
        const auto ranks = lockstep::gatherReadiness(cluster, {lockstep::hostName(), host::buildId(), "", "", {}, 0});
        master::requireReady(ranks, master::RankLabels::of(cluster, world->wall).names);
        master::requireTiles(ranks, world->wall);
        for (const lockstep::Readiness& rank : ranks) {
            options.session.settlingFrames =
                std::max<std::uint64_t>(options.session.settlingFrames, rank.framesToIgnore);
        }
    } catch (...) {
        // After every error, the ranks still wait for an answer. They end quietly if it is no.
        if (sessionOpen) {
            (void)lockstep::agreeToGoOn(cluster, false);
        } else {
            (void)lockstep::broadcastSession(cluster, std::nullopt);
        }
        throw;
    }
    (void)lockstep::agreeToGoOn(cluster, true);
    (void)lockstep::clockAheadOfMaster(cluster);
    try {
        const host::WorkerPool pool(options.sandThreads);
        options.session.executor = pool.lend();
        return master::Session(cluster, world->scene, world->wall, options.session).run();
    } catch (const std::exception& error) {
        // The ranks are in the middle of a frame and cannot be asked to end.
        const bool input = dynamic_cast<const base::InputError*>(&error) != nullptr;
        host::printLine("{}", error.what());
        cluster.abort(input ? base::kExitBadInput : 1);
    }
}

void describeSession(host::CommandLine& line, Options& options) {
    master::SessionOptions& session = options.session;
    line.option("--scene", options.scene, "scene file").metavar("FILE");
    line.option("--wall", options.wall, "wall file").metavar("FILE").required();
    line.option("--out", options.out, "folder for journal, pictures and summary").metavar("FOLDER").required();
    line.option("--haptic", options.haptic, "address of the haptic server, or none").metavar("HOST:PORT").showDefault();
    options.link.addTo(line, false);
    line.flag("--pointer", session.pointer, "the hand is the pointer of the ranks' windows (docs/pointer.md)");
    line.choice(
            "--pace", session.pace,
            "fast: as fast as the machine can, and a recorded hand waits for the wall; not for driver: and spacenav")
        .offeredBy({"run"});
    const host::Option steps = line.option("--steps", session.steps,
                                           "end after exactly this many shown steps, with those that only pay sweeps")
                                   .metavar("N")
                                   .positive();
    steps.offeredBy({"run"});
    line.option("--frames", session.frames, "end after this many frames")
        .metavar("N")
        .positive()
        .excludes(steps)
        .offeredBy({"run"});
    line.option("--warm-up", session.settlingFrames, "number of first frames whose times do not count")
        .metavar("FRAMES")
        .range(0, 1000000)
        .offeredBy({"run"});
    line.option("--frame-timeout", session.frameTimeout, "seconds a frame may take before the job ends")
        .metavar("SECONDS")
        .range(2.0, 3600.0)
        .showDefault()
        .offeredBy({"run", "film"});
    host::addSandThreads(line, options.sandThreads).offeredBy({"run", "film"});
    line.flag("--no-pictures", options.noPictures, "write no pictures at the end").offeredBy({"run"});
    line.flag("--no-report", options.noReport, "print no figures at the end, because another program prints them");
    line.flag("--control-stdin", session.desk.readInput,
              "read commands from standard input (docs/operator.md); its end stops the session");
    line.option("--place", options.places,
                "RANK,RANK=HOST=MACHINE: machine on which these ranks must run, from the launcher (docs/hosts.md)");
    line.option("--inject", options.injections, "drill, such as slow:rank=5,ms=30; docs/operator.md")
        .metavar("KIND:KEY=N,…")
        .offeredBy({"run"});
}

void describeView(host::CommandLine& line, Options& options) {
    line.option("--refresh", options.session.refreshHz, "frames per second, in place of the wall file's")
        .metavar("HZ")
        .range(1.0, 1000.0)
        .offeredBy({"run"});
    line.option("--stereo", options.stereo, "stereo mode, in place of the wall file's; docs/wall_files.md")
        .metavar("MODE")
        .offeredBy({"run", "film"});
    line.option("--desk", options.desk,
                "area of this desktop on which the whole wall is shown with one eye, in windows; docs/pointer.md")
        .metavar("WIDTHxHEIGHT+X+Y")
        .excludes(line.named("--stereo"))
        .offeredBy({"run"});
    line.option("--track", options.track,
                "tracker of the head: trace:FILE.csv, opentrack:PORT, dtrack:PORT or none; docs/head_tracking.md")
        .metavar("SOURCE")
        .offeredBy({"run", "film"});
    line.option("--pattern", options.pattern, "a test pattern instead of the sand; docs/test_patterns.md")
        .metavar("NAME")
        .offeredBy({"run"});
    line.option("--show", options.layers,
                "layer beside the sand: wireframe, hill-shade, force, statistics or help; docs/operator.md")
        .metavar("LAYER")
        .offeredBy({"run"});
}

void describeResume(host::CommandLine& line, Options& options) {
    const host::Option resume = line.flag("--resume", options.resume, "continue the session in --out, if there is one");
    resume.excludes(line.named("--replay"));
    master::Failure& failure = options.session.record.failure;
    line.option("--failed-at", failure.noticed, "Unix time at which the failure of the session was noticed")
        .notNegative()
        .needs(resume);
    line.choice("--journal", options.session.record.journal.policy,
                "required: show only steps that are on disk; best-effort: continue without a journal; docs/journal.md")
        .offeredBy({"run"});
    line.option("--checkpoint", options.session.record.journal.checkpointSeconds,
                "time between two checkpoints, 0 for none; docs/journal.md")
        .metavar("SECONDS")
        .range(0.0, 86400.0)
        .offeredBy({"run"});
    line.option("--journal-part", options.partMegabytes, "MiB after which the journal continues in another file")
        .range(1, 1 << 20);
    line.option("--force-share", options.session.forceShare,
                "0 to 1: share of its force that the hand feels, as an operator sets it; wins over the journal")
        .range(0.0, 1.0)
        .excludes(line.named("--replay"));
    line.option("--failure", failure.what, "text about the failure; written to the journal and to recoveries.jsonl")
        .needs(resume);
    line.option("--failed-rank", failure.rank, "rank that failed; leave it out if no rank failed").needs(resume);
    line.option("--failed-how", failure.how, "how it failed: a signal's name, 'status N', hung, broken or disk")
        .needs(resume);
}

void describeReplay(host::CommandLine& line, Options& options) {
    const host::Option replay =
        line.option("--replay", options.replay, "journal of a session, or its folder, shown again instead of a scene");
    for (const char* other : {"--scene", "--haptic", "--pointer", "--refresh"}) {
        replay.excludes(line.named(other));
    }
    line.option("--fps", options.framesPerSecond, "frames per second of the replay")
        .metavar("N")
        .range(1, 240)
        .showDefault()
        .needs(replay)
        .offeredBy({"film"});
    const host::Option film =
        line.flag("--film", options.session.film, "write every frame of a replay as a picture of the whole wall");
    film.needs(replay);
    line.choice("--eye", options.session.filmEye, "the eye that the film shows, in any stereo mode")
        .needs(film)
        .offeredBy({"film"});
}

}  // namespace

int main(int argc, char** argv) {
    if (host::answersVersion(argc, argv, "sandwall-master",
                             {{"algorithm", sand::kAlgorithmVersion},
                              {"protocol", haptic_bridge::kProtocolVersion},
                              {"journal", journal::kJournalVersion},
                              {"state", sand::kStateVersion}})) {
        return 0;
    }
    host::CommandLine line("Rank 0 of a wall: bridges the haptic server to all ranks, paces frames, keeps the journal.",
                           "sandwall-master");
    Options options;
    describeSession(line, options);
    describeView(line, options);
    describeReplay(line, options);
    describeResume(line, options);
    line.words("verbs", master::verbsOfSession());
    if (line.answersHelp(argc, argv)) {
        return 0;
    }
    lockstep::endWithParent();
    host::sendRankLog();
    // Open MPI starts before the options are checked, because mpirun counts a process that ends without it as crashed.
    lockstep::Cluster cluster(&argc, &argv);
    bool parsed = false;
    const int status = host::runMain(line, argc, argv, [&] {
        parsed = true;
        return runSession(cluster, options);
    });
    if (!parsed) {
        (void)lockstep::broadcastSession(cluster, std::nullopt);
    }
    if (status == 0) {
        host::removeRankLog();
    }
    return status;
}
