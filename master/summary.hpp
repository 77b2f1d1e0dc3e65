// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "haptic_bridge/client/client.hpp"
#include "lockstep/rank_statistics.hpp"
#include "lockstep/session_message.hpp"
#include "lockstep/statistics.hpp"
#include "scene/raster_statement.hpp"
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
};

/// The results of a session, which summary.json contains.
struct Summary {
    std::string scene, wall;
    std::optional<std::vector<scene::RasterStatement>> terrain;  // of the scene's files; nullopt if unknown
    std::uint64_t frames = 0, steps = 0;
    std::uint64_t edits = 0;  // steps with an operator's edit
    int ranks = 0;
    std::uint64_t stateHash = 0;
    std::uint64_t divergences = 0;        // frames in which the ranks' sand differed
    std::uint64_t healed = 0;             // times that a rank was healed
    std::uint64_t outvoted = 0;           // times that the journal outvoted a majority of the ranks
    std::uint64_t serverDivergences = 0;  // frames in which the haptic server's sand differed
    std::uint64_t stepsLeftOut = 0;       // steps with a sand::Replica::leftOut()
    std::int64_t volumeInitial = 0, volumeFinal = 0, volumeOutflow = 0;  // [unit · cell]
    std::string pace = "realtime";                                       // "realtime", "fast" or "replay"
    double refreshHz = 0;                                                // frames per second that were asked for
    double seconds = 0;                                                  // from the first swap to the last
    double pausedSeconds = 0, fullDiskSeconds = 0;  // of frames without steps because of a pause, or of a full disk
    lockstep::Statistics frameMs;                   // from swap to swap
    std::uint64_t lateFrames = 0;                   // frames that took more than 1.5 periods
    lockstep::Statistics skewUs;                    // spread of the swap times of one frame
    lockstep::Statistics broadcastBytes;            // length of the frame message
    Latency latency;
    std::optional<haptic_bridge::Report> haptic;
    haptic_bridge::LinkCounters link;
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
        std::optional<std::uint64_t> firstDifference;  // first frame of the session in which sand differed
    } compared;
    struct Hand {
        std::string asked = "none";              // "server" or "pointer" if the command line asked for one
        std::uint64_t frames = 0;                // since the last restart, with a hand (StepSource::handed())
        bool atEnd = false;                      // the last frame had a hand
        std::optional<std::string> lastRefusal;  // StepSource::lastRefusal()
    } hand;
    struct Journal {
        std::string policy = "off", state = "off";
        bool whole = false;                 // holds every step that was shown, and an orderly end
        std::uint64_t parts = 0;            // written so far
        lockstep::Statistics checkpointMs;  // [ms], delay of the frame loop by each checkpoint
        std::uint64_t checkpointsFailed = 0;
        std::uint64_t checkpointsBeyond = 0;  // of later steps than the journal's end, which has lost steps
        std::uint64_t stands = 0;             // times that the sand was stopped because the disk was full
        double stoodSeconds = 0;
    } journal;
    std::vector<std::string> recoveries;  // of the session, each a JSON object

    /// Returns whether no sand was lost or made since the scene's start.
    [[nodiscard]] bool exact() const { return volumeFinal + volumeOutflow == volumeInitial; }
    [[nodiscard]] double framesPerSecond() const;
};

/// Returns the rank that keeps the wall waiting, as summary.json and `ctl status` contain it; null if no rank stands
/// out.
[[nodiscard]] nlohmann::ordered_json slowestRank(const std::optional<lockstep::Drag>& drag,
                                                 const std::vector<std::string>& rankNames);

/// Writes summary.json. Throws base::InputError if it cannot be written.
void writeSummary(const Summary& summary, const std::filesystem::path& file);

/// Returns the summary as a text of one screen, which is printed.
[[nodiscard]] std::string describe(const Summary& summary);

}  // namespace master
