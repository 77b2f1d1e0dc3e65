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

/// Frame loop of the master.
///
/// In each frame the master takes the steps that are due and sends them to all ranks. While the render ranks draw, it
/// writes the steps to the journal and applies them to its own sand. It then waits until all ranks agree, so that the
/// render ranks may swap. A slow disk delays the swap, as a slow rank does. Frames follow the wall's refresh rate,
/// usually 60 Hz. Main thread only.
class Session {
public:
    /// `cluster`, `scene` and `wall` must outlive the session.
    Session(const lockstep::Cluster& cluster, const scene::Scene& scene, const walls::Wall& wall,
            SessionOptions options);

    /// Runs all frames, and writes journal, pictures and summary. Collective with showTile() of the render ranks.
    ///
    /// Returns the exit status, which is 0 if all went well. It is 1 if the ranks could not be made to agree or if the
    /// sand differed from the recording. It is also 1 if the summary could not be written. Throws DiskFailure if the
    /// disk refuses the journal under the policy `required`, and base::InputError if a picture cannot be written.
    int run();

private:
    using Steps = std::vector<haptic_bridge::TimedStep>;

    /// Shows one frame. Returns whether all ranks agreed. Sets `more` to whether another frame follows.
    [[nodiscard]] bool showFrame(bool& more);
    void tellLeftOut();
    void waitForFrame();
    [[nodiscard]] Steps takeSteps();
    [[nodiscard]] lockstep::FrameMessage compose(const Steps& steps);
    void startDrills();
    void keep(const lockstep::FrameMessage& frame);
    /// Returns whether the session takes no steps, because it is paused or the disk is full.
    [[nodiscard]] bool held() const { return desk_.paused() || record_.full(); }
    [[nodiscard]] Incidents incidents() const;  // since the session began, across restarts
    [[nodiscard]] nlohmann::json status() const;
    void sayProgress(bool last);
    [[nodiscard]] Summary finish(bool agreed);
    [[nodiscard]] Summary summary();  // collective, because each rank sends a report

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
    std::uint64_t serverDivergences_ = 0;  // since this process started
    std::uint64_t stepsLeftOut_ = 0;       // since this process started
};

}  // namespace master
