// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "base/input_error.hpp"
#include "haptic_bridge/link/greetings.hpp"
#include "host/build_id.hpp"
#include "host/command_line.hpp"
#include "host/phase_progress.hpp"
#include "host/print_line.hpp"
#include "host/rank_output.hpp"
#include "host/version.hpp"
#include "host/worker_pool.hpp"
#include "journal/format.hpp"
#include "lockstep/clock_sync.hpp"
#include "lockstep/cluster.hpp"
#include "lockstep/session_message.hpp"
#include "lockstep/watchdog.hpp"
#include "master/measure/failure_report.hpp"
#include "master/measure/rank_labels.hpp"
#include "master/operator/input_watch.hpp"
#include "master/operator/verbs.hpp"
#include "master/program_options.hpp"
#include "master/session.hpp"
#include "master/start_up.hpp"
#include "master/world.hpp"
#include "sand/model/rules.hpp"
#include "sand/replica.hpp"
#include "walls/wall.hpp"

namespace {

/// Makes the watchdog of the start and the end write failure.json. `wall` is null until it is known.
void setLastWords(const lockstep::Cluster& cluster, const master::ProgramOptions& options, const walls::Wall* wall) {
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

using LastCheckpoint = std::optional<master::Session::LastCheckpoint>;

/// Returns a function that prints the progress of a phase of the start; see host::PhaseProgress.
std::function<void(double)> printed(std::string phase, std::string what) {
    return [progress = host::PhaseProgress(std::move(phase), std::move(what), [](const std::string& line) {
                host::printLine("{}", line);
            })](double share) mutable { progress.done(share); };
}

/// Makes the master's sand while the ranks make theirs. Returns the error if it fails: the ranks then still report
/// whether they are ready.
std::exception_ptr makeSand(const lockstep::Cluster& cluster, master::ProgramOptions& options, master::World& world,
                            std::optional<master::MasterSand>& sand) {
    std::exception_ptr failed;
    const bool resumes = world.stopped.has_value();
    base::Bytes state;
    try {
        if (resumes) {
            state = master::resumeSand(cluster, world, options);
        }
    } catch (...) {
        failed = std::current_exception();
    }
    if (resumes) {
        (void)lockstep::broadcastState(cluster, state, printed("broadcast_sand", "sends the sand to the ranks"));
    }
    try {
        if (failed == nullptr) {
            sand.emplace(master::sandOf(options.session, world.scene));
        }
    } catch (...) {
        failed = std::current_exception();
    }
    return failed;
}

/// `last` gets a checkpoint that was still being written at the end.
int runSession(const lockstep::Cluster& cluster, master::ProgramOptions& options, LastCheckpoint& last) {
    std::optional<master::World> world;
    std::optional<master::MasterSand> sand;
    std::optional<host::WorkerPool> pool;
    bool sessionOpen = false;
    setLastWords(cluster, options, nullptr);
    std::optional<master::InputWatch> inputWatch;
    if (options.session.desk.readInput) {
        inputWatch.emplace(STDIN_FILENO, master::endForLackOfInput);
        options.session.firstFrameShown = [&inputWatch] { inputWatch.reset(); };
    }
    try {
        pool.emplace(options.sandThreads);
        options.session.executor = pool->lend();
        world.emplace(master::loadWorld(cluster, options));
        setLastWords(cluster, options, &world->wall);
        (void)lockstep::broadcastSession(cluster, &world->message,
                                         printed("broadcast", "sends the scene to the ranks"));
        sessionOpen = true;
        const std::exception_ptr failed = makeSand(cluster, options, *world, sand);
        const auto ranks = lockstep::gatherReadiness(cluster, {lockstep::hostName(), host::buildId(), "", "", {}, 0},
                                                     printed("ranks", "the ranks make their sand"));
        if (failed) {
            std::rethrow_exception(failed);
        }
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
            (void)lockstep::broadcastSession(cluster, nullptr);
        }
        throw;
    }
    (void)lockstep::agreeToGoOn(cluster, true);
    (void)lockstep::clockAheadOfMaster(cluster);
    try {
        master::Session session(cluster, world->scene, world->wall, options.session, std::move(*sand));
        world->scene.dropHeights();
        const int status = session.run();
        last = session.takeUnfinished();
        return status;
    } catch (const std::exception& error) {
        // The ranks are in the middle of a frame and cannot be asked to end.
        const bool input = dynamic_cast<const base::InputError*>(&error) != nullptr;
        host::printLine("{}", error.what());
        cluster.abort(input ? base::kExitBadInput : 1);
    }
}

/// Runs the session from the start of MPI to its end.
int runJob(host::CommandLine& line, int argc, char** argv, master::ProgramOptions& options, LastCheckpoint& last) {
    // Open MPI starts before the options are checked, because mpirun counts a process that ends without it as crashed.
    lockstep::Cluster cluster(&argc, &argv);
    bool parsed = false;
    const int status = host::runMain(line, argc, argv, [&] {
        parsed = true;
        return runSession(cluster, options, last);
    });
    if (!parsed) {
        (void)lockstep::broadcastSession(cluster, nullptr);
    }
    return status;
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
    master::ProgramOptions options;
    options.addTo(line);
    line.words("verbs", master::listedVerbs<master::OperatorDesk>());
    if (line.answersHelp(argc, argv)) {
        return 0;
    }
    lockstep::endWithParent();
    host::sendRankLog();
    LastCheckpoint last;
    const int status = runJob(line, argc, argv, options, last);
    // The ranks have ended, so that no limit of theirs ends a checkpoint that takes long.
    const bool finished = !last || master::finishUnlessSignalled(last->checkpoint, last->dispensable);
    if (status == 0) {
        host::removeRankLog();
    }
    if (!finished) {
        std::fflush(nullptr);
        std::_Exit(status);  // the destructor would wait for the thread
    }
    return status;
}
