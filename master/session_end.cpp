// SPDX-License-Identifier: Apache-2.0
// The end of a session: its last words to the haptic server and to the journal, and its results.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string>

#include "base/input_error.hpp"
#include "host/print_line.hpp"
#include "lockstep/session_message.hpp"
#include "master/measure/failure_report.hpp"
#include "master/measure/recovery.hpp"
#include "master/pictures/wall_pictures.hpp"
#include "master/session.hpp"
#include "sand/surface_factory.hpp"

namespace master {

/// Ends the session, writes its results, and returns its exit status. `agreed`: the ranks agreed to the end.
int Session::writeResults(bool agreed) {
    {
        const lockstep::Busy busy(barrier_, "the files that it writes");
        desk_.close();
    }
    const Summary result = finish(agreed);
    int status = agreed && !steps_->strayed() ? 0 : 1;
    if (const std::string doubt = agreed ? doubtAbout(result) : std::string(); !doubt.empty()) {
        host::printLine("{}", doubt);
        (void)writeFailure({"sand", -1, "", "", doubt}, options_.out);
        status = 1;
    }
    try {
        writeSummary(result, options_.out / "summary.json");
    } catch (const base::InputError& error) {  // the ranks still have pictures to send
        host::printLine("{}", error.what());
        (void)writeFailure({"summary", -1, "", "", error.what()}, options_.out);
        status = 1;
    }
    if (agreed && filmsFrame()) {
        film_->take(barrier_);
    } else if (agreed && options_.pictures && !film_) {
        writeWallPictures(barrier_, desk_.shownWall(), options_.out);
    }
    if (options_.report) {
        fmt::print("{}", describe(result));
    }
    barrier_.watchdog().arm();  // until the destructor of the barrier, because the members after it wait for the disk
    return status;
}

std::optional<Session::LastCheckpoint> Session::takeUnfinished() {
    std::optional<UnfinishedCheckpoint> unfinished = record_.takeUnfinished();
    return unfinished ? std::optional<LastCheckpoint>({std::move(*unfinished), record_.hasCheckpoint()}) : std::nullopt;
}

/// Ends the link and the journal, and returns the results. `agreed`: the ranks agreed to the end.
Summary Session::finish(bool agreed) {
    const lockstep::Watched watched(barrier_.watchdog());
    steps_->stop();
    if (steps_->serverAtEnd() == false) {
        check_.serverDiffered(frame_);
    }
    try {
        record_.keepTicks(steps_->ticks());  // the last ticks arrive at the end of the link
    } catch (const DiskFailure& failure) {   // the ranks still have reports and pictures to send
        host::printLine("{}", failure.what());
    }
    if (agreed) {
        // A third, because the ranks wait for the master meanwhile, and their own limit must not end the job. A person
        // who has stopped the session waits, too.
        constexpr double kMostPatience = 20e3;  // [ms]
        const double patience = std::min(kMostPatience, options_.frameTimeout * 1e3 / 3);
        check_.finish(frame_, shownSand(), std::chrono::milliseconds(static_cast<std::int64_t>(patience)));
    }
    record_.keepLastIncidents(incidents());
    record_.finish(sand_, agreed);
    return summary();
}

Summary Session::summary() {
    const sand::Replica& sand = sand_.replica();
    Summary summary;
    summary.scene = scene_.name;
    summary.terrain = scene_.statements;
    summary.wall = wall_.name;
    summary.frames = frame_;
    summary.steps = sand.stepNumber();
    summary.edits = sand_.edits();
    summary.ranks = wall_.ranks();
    summary.stateHash = sand_.hash();
    summary.sweepsOwed = sweepsOwed();
    if (sand.firstRefusedPress()) {
        summary.refusedPress = refusedPressOf(sand);
    }
    summary.incidents = incidents();
    // Computes the initial volume from the scene, because the sand of a resumed session may already have lost volume.
    summary.volumeInitial = volumeOfHeights_ ? *volumeOfHeights_ : sand::volumeOf(scene_);
    summary.volumeFinal = sand.volume();
    summary.volumeOutflow = sand.outflow();
    summary.seconds = clock_.seconds();
    measure_.fill(summary);
    summary.dark = dark_.history();
    summary.haptic = steps_->report();
    const haptic_bridge::LinkCounters link = steps_->counters();
    summary.handOvers = {link.catchUps, link.snapshots};
    if (const ResumedSession* resumed = options_.record.resumed.get()) {
        summary.framesBefore = resumed->frame;
        summary.stepsBefore = resumed->step;
    }
    summary.pace = options_.recording ? "replay" : base::nameOf(options_.pace);
    summary.refreshHz = 1 / clock_.period();
    check_.fill(summary);
    summary.unhealed += (steps_->serverUnhealed() ? 1 : 0) + (steps_->strayed() ? 1 : 0);
    summary.compared.serverAtEnd = steps_->serverAtEnd();
    fillHand(summary);
    if (const tracking::TrackedViewer& viewer = desk_.views().viewer(); viewer.tracked()) {
        summary.tracking = viewer.counters();
    }
    summary.ranksReports = lockstep::gatherReports(barrier_, {});
    for (const walls::Tile& tile : wall_.tiles) {
        summary.tileNames.push_back(tile.name);
    }
    summary.rankNames = labels_.names;
    summary.masterResidentBytes = lockstep::residentBytes();
    summary.journal = record_.summary();
    for (std::string& recovery : recoveriesOf(options_.out)) {
        summary.recoveries.push_back({std::move(recovery)});
    }
    return summary;
}

void Session::fillHand(Summary& summary) const {
    summary.hand.asked = options_.recording ? "none"
                         : options_.server  ? "server"
                         : options_.pointer ? "pointer"
                                            : "none";
    if (const std::string why = steps_->lastRefusal(); !why.empty()) {
        summary.hand.lastRefusal = why;
    }
}

std::string Session::doubtAbout(const Summary& result) const {
    if (!check_.doubt().empty()) {
        return fmt::format(
            "the session ends with sand that its journal does not confirm, because {}; sandwall-replay {} computes the "
            "right sand, and --resume continues with it",
            check_.doubt(), record_.journalFile().string());
    }
    return result.exact()
               ? std::string()
               : fmt::format("the session ends with a wrong volume: {} + outflow {} is not {}, as at the start",
                             result.volumeFinal, result.volumeOutflow, result.volumeInitial);
}

}  // namespace master
