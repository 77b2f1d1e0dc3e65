// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "haptic_bridge/client/client.hpp"
#include "haptic_bridge/hand/pace.hpp"
#include "lockstep/arrival.hpp"
#include "lockstep/rank_statistics.hpp"
#include "lockstep/wall_figures.hpp"
#include "master/measure/frame_clock.hpp"
#include "master/measure/incidents.hpp"
#include "master/measure/summary.hpp"
#include "master/steps/slow_motion.hpp"

namespace master {

/// Measures a session, frame by frame, for summary.json, `ctl status`, the statistics on the wall, and the line of
/// progress. Used by one thread.
class Measurements {
public:
    /// `ranks` is the number of ranks, including the master. Times count only after frame `from`. `period` is the time
    /// between two frames at the wall's refresh rate.
    Measurements(std::size_t ranks, std::uint64_t from, double period /* [s] */, haptic_bridge::Pace pace,
                 int stepsPerSecond);

    /// A frame that all ranks have agreed on.
    struct Frame {
        std::uint64_t number = 0;
        std::size_t bytes = 0;       // [byte], length of the frame message
        std::int64_t broadcast = 0;  // [ns], when the frame message had been sent
        Swap swap;
        haptic_bridge::Held held = haptic_bridge::Held::no;  // why the frame took no steps
        bool rests = false;                                  // no step was due, because sand and hand were at rest
    };
    /// Adds a frame with its steps. `arrivals` are the arrivals at the frame's barrier. `clockOffset` is server's clock
    /// − master's clock [ns].
    void add(const Frame& frame, const ArrivedSteps& steps, const std::vector<lockstep::Arrival>& arrivals,
             std::int64_t clockOffset);

    /// Adds whether a frame has a hand that moves the tool.
    void addHand(bool handed) {
        handed_ = handed;
        framesWithHand_ += handed ? 1 : 0;
    }

    /// Whom the lines of progress are for: an operator reads all figures each second. A person at a desktop reads a
    /// line only if the number of frames per second has changed by more than a tenth.
    enum class Reader : std::uint8_t { operates, digs };
    /// A line of progress.
    struct Progress {
        std::uint64_t frame = 0, step = 0;
        std::string of{};    // behind the step, such as "/240"
        std::string hand{};  // StepSource::hand()
        bool last = false;   // the session ends with this frame
        double repeat = 1;   // [s], after which a line with the same step and hand is printed again
    };
    /// Prints the line of progress and emits the event `progress`, at most once per second. The last frame always has
    /// an event, and a line for an operator.
    void printProgress(const Progress& now, std::int64_t nowNs, Reader reader = Reader::operates);

    [[nodiscard]] lockstep::RankStatistics& ranks() { return ranks_; }
    /// Returns the figures that the wall shows as statistics. They cover the frames before the present one.
    /// `sweepsOwed` is the number of sweeps that the tool waits for.
    [[nodiscard]] lockstep::WallFigures figures(const Incidents& incidents, std::int32_t sweepsOwed) const;
    /// Returns by how much the tool is slower than the hand; nullopt if that is not known, or under the fast pace,
    /// whose hand waits for the sand.
    [[nodiscard]] std::optional<double> slowMotion() const;
    /// Adds the fields fps, slow_motion and slowest to the answer `status` of `ctl status`. `names` are the names of
    /// the ranks in messages.
    void describe(nlohmann::json& status, const std::vector<std::string>& names) const;
    /// Fills in the measured fields of `summary`.
    void fill(Summary& summary) const;

private:
    [[nodiscard]] bool progressIsDue(const Progress& now, std::int64_t nowNs) const;
    void printFrameRate(bool last);
    void addSwaps(const Frame& frame, const std::vector<lockstep::Arrival>& arrivals);
    void addLatency(const Frame& frame, const ArrivedSteps& steps, const std::vector<lockstep::Arrival>& arrivals,
                    std::int64_t clockOffset);

    const std::uint64_t from_;
    const double period_;
    const haptic_bridge::Pace pace_;
    lockstep::RankStatistics ranks_;
    lockstep::Statistics frameMs_, skewUs_, broadcastBytes_;
    Latency latency_;
    SlowMotion slowMotion_;
    std::uint64_t lateFrames_ = 0, framesWithHand_ = 0;
    bool handed_ = false;  // whether the last frame had a hand
    double pausedSeconds_ = 0, fullDiskSeconds_ = 0, restSeconds_ = 0;
    double lastFrameMs_ = 0, lastSkewUs_ = 0;
    double fps_ = 0;              // over about the last second
    std::int64_t countedNs_ = 0;  // [ns], when frames were last counted for fps_
    std::uint64_t countedFrame_ = 0;
    std::int64_t progressNs_ = 0;  // [ns], of the last event
    Progress progress_;            // of the last event
    double printedFps_ = 0;        // in the last line for a person who digs
};

}  // namespace master
