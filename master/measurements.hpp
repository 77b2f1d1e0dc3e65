// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "lockstep/arrival.hpp"
#include "lockstep/rank_statistics.hpp"
#include "lockstep/wall_figures.hpp"
#include "master/frame_clock.hpp"
#include "master/incidents.hpp"
#include "master/summary.hpp"

namespace master {

/// Measures a session, frame by frame: for summary.json, `ctl status`, the statistics on the wall, and the line of
/// progress. One thread.
class Measurements {
public:
    /// `ranks` counts the master. Times count from the frame after `from` on.
    Measurements(std::size_t ranks, std::uint64_t from, double period /* [s], of a frame */, Pace pace);

    /// A frame that all ranks have agreed on.
    struct Frame {
        std::uint64_t number = 0;
        std::size_t bytes = 0;       // of its message
        std::int64_t broadcast = 0;  // when the ranks had the message [ns]
        Swap swap;
    };
    /// `arrivals` are those at its barrier. `clockOffset` is how far the haptic server's clock is ahead [ns].
    void add(const Frame& frame, const std::vector<haptic_bridge::TimedStep>& steps,
             const std::vector<lockstep::Arrival>& arrivals, std::int64_t clockOffset);

    /// Prints the line of progress and emits the event, once a second, and when `last` is set.
    void sayProgress(std::uint64_t frame, std::uint64_t step, const std::string& of, const char* hand, bool last,
                     std::int64_t nowNs);

    [[nodiscard]] lockstep::RankStatistics& ranks() { return ranks_; }
    /// Returns what the statistics on the wall say, of frames before this one.
    [[nodiscard]] lockstep::WallFigures figures(const Incidents& incidents) const;
    /// Adds fps and slowest to what `ctl status` answers. `names` are those of the ranks.
    void describe(nlohmann::json& status, const std::vector<std::string>& names) const;
    /// Fills in what was measured.
    void fill(Summary& summary) const;

private:
    void addSwaps(const Frame& frame, const std::vector<lockstep::Arrival>& arrivals);
    void addLatency(const Frame& frame, const std::vector<haptic_bridge::TimedStep>& steps,
                    const std::vector<lockstep::Arrival>& arrivals, std::int64_t clockOffset);

    const std::uint64_t from_;
    const double period_;
    const Pace pace_;
    lockstep::RankStatistics ranks_;
    lockstep::Statistics frameMs_, skewUs_, broadcastBytes_;
    Latency latency_;
    std::uint64_t lateFrames_ = 0;
    double lastFrameMs_ = 0, lastSkewUs_ = 0;
    double fps_ = 0;                 // over the last second or so
    std::int64_t lastProgress_ = 0;  // [ns]
    std::uint64_t lastProgressFrame_ = 0;
};

}  // namespace master
