// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "lockstep/frame_barrier.hpp"
#include "lockstep/frame_message.hpp"
#include "lockstep/view_agreement.hpp"
#include "master/agreement.hpp"
#include "master/film.hpp"
#include "master/frame_clock.hpp"
#include "master/master_sand.hpp"
#include "master/measurements.hpp"
#include "master/operator_desk.hpp"
#include "master/rank_labels.hpp"
#include "master/ranks.hpp"
#include "master/session_options.hpp"
#include "master/session_record.hpp"
#include "master/steps/step_source.hpp"
#include "master/summary.hpp"
#include "scene/scene.hpp"
#include "walls/wall.hpp"

namespace master {

/// The frame loop of the master: number, broadcast, journal, apply, agree, swap; 60 times a second if the wall can.
class Session {
public:
    Session(const lockstep::Cluster& cluster, const scene::Scene& scene, const walls::Wall& wall,
            SessionOptions options);

    /// Runs to the end and writes journal, pictures and summary. Returns the exit status: 0, or 1 when replicas
    /// differed, or a replica and the recording. Collective with renderTile() of the render ranks.
    int run();

private:
    using Steps = std::vector<haptic_bridge::TimedStep>;

    /// Shows one frame. Returns whether all ranks agreed; `more` is whether another one follows.
    [[nodiscard]] bool showFrame(bool& more);
    void waitForFrame();
    [[nodiscard]] Steps takeSteps();
    [[nodiscard]] lockstep::FrameMessage compose(const Steps& steps);
    void startDrills();
    void keep(const lockstep::FrameMessage& frame);
    [[nodiscard]] bool held() const { return desk_.paused() || record_.full(); }
    [[nodiscard]] Incidents incidents() const;  // since the session's beginning
    [[nodiscard]] nlohmann::json status() const;
    void sayProgress(bool last);
    [[nodiscard]] Summary finish(bool agreed);
    [[nodiscard]] Summary summary();  // collective: ranks report

    const lockstep::Cluster& cluster_;
    const scene::Scene& scene_;
    const walls::Wall& wall_;
    const SessionOptions options_;
    const RankLabels labels_;
    lockstep::FrameBarrier barrier_;
    BarrierRanks ranks_;
    const lockstep::ViewProof viewProof_;
    std::uint64_t frame_ = 0;
    FrameClock clock_;
    MasterSand sand_;
    std::unique_ptr<StepSource> steps_;
    SessionRecord record_;
    OperatorDesk desk_;
    Measurements measure_;
    Agreement agreement_;
    std::optional<Film> film_;
    std::uint64_t serverDivergences_ = 0;  // since this process began
};

}  // namespace master
