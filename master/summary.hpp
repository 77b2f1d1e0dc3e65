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
#include "tracking/head_tracker.hpp"

namespace master {

/// Of the format of summary.json. Changes when a field changes its name or meaning, not when one is added.
inline constexpr int kSummaryVersion = 1;

/// The way of a step from the hand to the wall, leg by leg [ms], in the master's clock.
struct Latency {
    lockstep::Statistics toMaster;  // read from the device -> received over TCP
    lockstep::Statistics queued;    // -> broadcast
    lockstep::Statistics drawn;     // -> drawn by the slowest rank
    lockstep::Statistics swapped;   // -> agreed and swapped
    lockstep::Statistics wholeWay;  // all of it: probe to swap
};

/// What a session has measured; summary.json in numbers.
struct Summary {
    std::string scene, wall;
    std::uint64_t frames = 0, steps = 0;
    std::uint64_t edits = 0;  // steps in which an operator asked something of the sand
    int ranks = 0;
    std::uint64_t stateHash = 0;
    std::uint64_t divergences = 0;        // frames on which the ranks' sand differed
    std::uint64_t healed = 0;             // times that a rank took the right sand from another
    std::uint64_t serverDivergences = 0;  // frames on which the haptic server's did
    std::int64_t volumeInitial = 0, volumeFinal = 0, volumeOutflow = 0;  // [unit · cell]
    double seconds = 0;                                                  // from the first frame to the last
    lockstep::Statistics frameMs;                                        // from swap to swap
    std::uint64_t lateFrames = 0;                                        // of those, by half a period or more
    lockstep::Statistics skewUs;                                         // spread of the swap times of one frame
    lockstep::Statistics broadcastBytes;                                 // of the frame message
    Latency latency;
    std::optional<haptic_bridge::Report> haptic;
    haptic_bridge::LinkCounters link;
    std::optional<tracking::Counters> tracking;  // of the head, where it is tracked
    std::vector<lockstep::RankReport> ranksReports;
    std::vector<std::string> tileNames;                          // by rank, from 1
    std::vector<lockstep::RankStatistics::Rank> rankStatistics;  // by rank, the master's first
    std::vector<std::string> rankNames;                          // as well, as messages speak of them
    std::optional<lockstep::Drag> drag;                          // who kept the wall waiting, if anyone
    std::int64_t masterResidentBytes = 0;
    std::uint64_t framesBefore = 0;  // of `frames`, before the session stopped and went on
    struct Journal {
        std::string policy = "off", state = "off";
        std::uint64_t parts = 0;            // written so far
        lockstep::Statistics checkpointMs;  // that each checkpoint kept the master from the next frame
        std::uint64_t checkpointsFailed = 0;
        std::uint64_t checkpointsBeyond = 0;  // left behind the end of a journal that has lost steps
        std::uint64_t stands = 0;             // times that the sand stood for want of room on the disk
        double stoodSeconds = 0;
    } journal;
    std::vector<std::string> recoveries;  // of the session, an object of JSON each
};

/// Who keeps the wall waiting, as summary.json and `ctl status` have it: null where no rank stands out.
[[nodiscard]] nlohmann::ordered_json slowestRank(const std::optional<lockstep::Drag>& drag,
                                                 const std::vector<std::string>& rankNames);

/// Writes summary.json. Throws base::InputError when it cannot.
void writeSummary(const Summary& summary, const std::filesystem::path& file);

/// The same for a person, a screenful.
[[nodiscard]] std::string describe(const Summary& summary);

}  // namespace master
