// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "haptic_bridge/link/report.hpp"
#include "host/event.hpp"
#include "lockstep/rank_statistics.hpp"
#include "lockstep/session_message.hpp"
#include "lockstep/statistics.hpp"
#include "master/measure/incidents.hpp"
#include "master/measure/summary_parts.hpp"
#include "master/operator/dark_outputs.hpp"
#include "scene/model/raster_statement.hpp"
#include "tracking/head_tracker.hpp"

namespace master {

/// Version of the format of summary.json. It changes when a field changes its name or meaning, but not when a field is
/// added.
inline constexpr int kSummaryVersion = 1;

/// Times of a step's way from the hand to the wall, leg by leg [ms], on the master's clock.
struct Latency {
    lockstep::Statistics toMaster;  // read from the device -> received over TCP
    lockstep::Statistics queued;    // -> broadcast
    lockstep::Statistics drawn;     // -> drawn by the slowest rank
    lockstep::Statistics swapped;   // -> agreed and swapped
    lockstep::Statistics wholeWay;  // the whole way, from probe to swap
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("latency_ms", Distribution{it.wholeWay});
        visit("latency_legs_ms/to_master", Distribution{it.toMaster});
        visit("latency_legs_ms/queued", Distribution{it.queued});
        visit("latency_legs_ms/drawn", Distribution{it.drawn});
        visit("latency_legs_ms/swapped", Distribution{it.swapped});
    }
};

/// The results of a session. fields() lists the keys of summary.json, and docs/schemas describes them.
struct Summary {
    std::string scene, wall;
    std::optional<std::vector<scene::RasterStatement>> terrain;  // of the scene's files; nullopt if unknown
    std::uint64_t frames = 0, steps = 0;
    std::uint64_t edits = 0;  // steps with an operator's edit
    int ranks = 0;
    std::uint64_t stateHash = 0;
    std::int32_t sweepsOwed = 0;  // at the end, that the tool waits for
    std::optional<RefusedPressPart> refusedPress;
    Incidents incidents;
    std::int64_t volumeInitial = 0, volumeFinal = 0, volumeOutflow = 0;  // [unit · cell]
    std::string pace = "realtime";                                       // "realtime", "fast" or "replay"
    double refreshHz = 0;                                                // frames per second that were asked for
    double seconds = 0;                                                  // from the first swap to the last
    double pausedSeconds = 0, fullDiskSeconds = 0;  // of frames without steps because of a pause, or of a full disk
    double restSeconds = 0;                         // of frames without steps because sand and hand were at rest
    lockstep::Statistics frameMs;                   // from swap to swap
    std::uint64_t lateFrames = 0;                   // frames that took more than 1.5 periods
    lockstep::Statistics skewUs;                    // spread of the swap times of one frame
    lockstep::Statistics broadcastBytes;            // length of the frame message
    Latency latency;
    std::optional<haptic_bridge::Report> haptic;
    struct HandOvers {
        std::uint64_t bySteps = 0, byState = 0;  // LinkCounters::catchUps and ::snapshots
        template <class Self, class Visit>
        static void fields(Self& it, Visit& visit) {
            visit("by_steps", it.bySteps);
            visit("by_state", it.byState);
        }
    } handOvers;
    std::optional<tracking::Counters> tracking;  // nullopt if the head is not tracked
    std::vector<lockstep::RankReport> ranksReports;
    std::vector<std::string> tileNames;                          // in order of rank, from 1
    std::vector<lockstep::RankStatistics::Rank> rankStatistics;  // in order of rank, the master's first
    std::vector<std::string> rankNames;                          // names in messages, the master's first
    std::optional<lockstep::Drag> drag;  // rank that kept the wall waiting; nullopt if no rank stands out
    std::int64_t masterResidentBytes = 0;
    std::uint64_t framesBefore = 0, stepsBefore = 0;  // of `frames` and `steps`, those before the last restart
    std::uint64_t unhealed = 0;  // ranks or servers whose sand differed, and that have not got the right sand since
    /// Tells how far the sand of all ranks has been compared, see CompareTrack.
    struct Compared {
        bool atEnd = false;               // the last frame has compared the whole sand, and all ranks agreed
        std::optional<bool> serverAtEnd;  // StepSource::serverAtEnd()
        std::uint64_t lastWhole = 0;      // frame up to which the whole sand has been compared
        template <class Self, class Visit>
        static void fields(Self& it, Visit& visit) {
            visit("at_end", it.atEnd);
            visit("server_at_end", it.serverAtEnd);
            visit("last_whole", it.lastWhole);
        }
    } compared;
    struct Hand {
        std::string asked = "none";              // "server" or "pointer" if the command line asked for one
        std::uint64_t frames = 0;                // since the last restart, with a hand (StepSource::handed())
        bool atEnd = false;                      // the last frame had a hand
        std::optional<double> slowMotion;        // Measurements::slowMotion()
        std::optional<std::string> lastRefusal;  // StepSource::lastRefusal()
        template <class Self, class Visit>
        static void fields(Self& it, Visit& visit) {
            visit("asked", it.asked);
            visit("frames_with_hand", it.frames);
            visit("linked_at_end", it.atEnd);
            visit("slow_motion", it.slowMotion);
            visit("last_refusal", it.lastRefusal);
        }
    } hand;
    struct Journal {
        std::string policy = "off", state = "off";
        bool whole = false;                 // holds every step that was shown, and an orderly end
        std::uint64_t parts = 0;            // written so far
        lockstep::Statistics checkpointMs;  // [ms], delay of the frame loop by each checkpoint
        std::uint64_t checkpointsFailed = 0;
        std::uint64_t checkpointsBeyond = 0;  // of later steps than the journal's end, which has lost steps
        double stoppedSeconds = 0;            // [s], for which the sand was stopped because the disk was full
        template <class Self, class Visit>
        static void fields(Self& it, Visit& visit) {
            visit("policy", it.policy);
            visit("state", it.state);
            visit("whole", it.whole);
            visit("parts", it.parts);
            visit("checkpoints", it.checkpointMs.count());
            visit("checkpoints_failed", it.checkpointsFailed);
            visit("checkpoints_beyond", it.checkpointsBeyond);
            visit("checkpoint_copy_ms", Spread{it.checkpointMs});
            visit("full_disk/seconds", it.stoppedSeconds);
        }
    } journal;
    std::vector<DarkOutput> dark;        // outputs that no monitor showed for some time
    std::vector<host::Json> recoveries;  // of the session, each an object

    /// Returns whether no sand was lost or made since the scene's start.
    [[nodiscard]] bool exact() const { return volumeFinal + volumeOutflow == volumeInitial; }
    [[nodiscard]] double framesPerSecond() const;

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("version", kSummaryVersion);
        visit("scene", it.scene);
        visit("terrain", it.terrain);
        visit("wall", it.wall);
        visit("frames", it.frames);
        visit("steps", it.steps);
        visit("frames_before", it.framesBefore);
        visit("steps_before", it.stepsBefore);
        visit("pace", it.pace);
        visit("refresh_hz", it.refreshHz);
        visit("ranks", it.ranks);
        visit("state_hash", hashText(it.stateHash));
        visit("sweeps_owed", it.sweepsOwed);
        visit("refused_press", it.refusedPress);
        Incidents::counters(it.incidents, visit);
        visit("master_healed", it.rankStatistics.empty() ? 0 : it.rankStatistics.front().healed);
        visit("unhealed", it.unhealed);
        visit("compared", it.compared);
        visit("compared/frames_since", it.frames - it.compared.lastWhole);
        visit("compared/first_difference", it.incidents.firstFrame());
        visit("volume_initial", it.volumeInitial);
        visit("volume_final", it.volumeFinal);
        visit("edits", it.edits);
        visit("volume_outflow", it.volumeOutflow);
        visit("seconds", it.seconds);
        visit("fps", it.framesPerSecond());
        visit("frame_ms", Spread{it.frameMs});
        visit("frame_ms/count", it.frameMs.count());
        visit("frame_ms/mean", it.frameMs.mean());
        visit("late_frames", it.lateFrames);
        visit("held_seconds/pause", it.pausedSeconds);
        visit("held_seconds/disk", it.fullDiskSeconds);
        visit("held_seconds/rest", it.restSeconds);
        visit("skew_us", Spread{it.skewUs});
        Latency::fields(it.latency, visit);
        visit("haptic_period_us/p50", it.period(&haptic_bridge::Report::hapticPeriodUsP50));
        visit("haptic_period_us/p99", it.period(&haptic_bridge::Report::hapticPeriodUsP99));
        visit("haptic_period_us/max", it.period(&haptic_bridge::Report::hapticPeriodUsMax));
        visit("slowest", slowestRank(it.drag, it.rankNames));
        visit("broadcast_bytes", Spread{it.broadcastBytes});
        visit("hand", it.hand);
        visit("hand/links", it.incidents.links);
        visit("haptic/reconnects", it.incidents.reconnects);
        visit("haptic/hand_overs", it.handOvers);
        using haptic_bridge::RefusalCode;
        visit("haptic/refused_by_server", base::byName<RefusalCode>(it.incidents.refusedHere));
        visit("haptic/refused/servers", base::byName<RefusalCode>(it.incidents.refused));
        const haptic_bridge::Report report = it.haptic.value_or(haptic_bridge::Report{});
        visit("haptic/refused/connections", base::byName<RefusalCode>(report.refused));
        if (it.haptic) {
            visit("haptic", ReportPart{report});
        }
        if (it.tracking) {
            visit("head_tracking", *it.tracking);
        }
        visit("master_memory_bytes", it.masterResidentBytes);
        visit("journal", it.journal);
        visit("journal/full_disk/times", it.incidents.stops);
        visit("dark", it.dark);
        visit("recoveries", it.recoveries);
        visit("per_rank", it.rankParts());
    }

private:
    /// Returns a value of the force loop's period; nullopt if the loop did not run in real time, and so has no period.
    [[nodiscard]] std::optional<double> period(double haptic_bridge::Report::*value) const;
    [[nodiscard]] std::vector<RankPart> rankParts() const;
};

/// Writes summary.json. Throws base::InputError if it cannot be written.
void writeSummary(const Summary& summary, const std::filesystem::path& file);

/// Returns the summary as a text of one screen, which is printed.
[[nodiscard]] std::string describe(const Summary& summary);

}  // namespace master
