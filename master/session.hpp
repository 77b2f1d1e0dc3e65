// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "lockstep/frame_barrier.hpp"
#include "lockstep/frame_message.hpp"
#include "master/check/sand_check.hpp"
#include "master/measure/frame_clock.hpp"
#include "master/measure/measurements.hpp"
#include "master/measure/rank_labels.hpp"
#include "master/measure/summary.hpp"
#include "master/operator/dark_outputs.hpp"
#include "master/operator/operator_desk.hpp"
#include "master/pictures/film.hpp"
#include "master/session_options.hpp"
#include "master/session_record.hpp"
#include "master/steps/master_sand.hpp"
#include "master/steps/step_source.hpp"
#include "scene/model/scene.hpp"
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
    /// `scene` and `wall` must outlive the session. `sand` is sandOf() these options and this scene. The session does
    /// not read the scene's heights after that.
    Session(const lockstep::Cluster& cluster, const scene::Scene& scene, const walls::Wall& wall,
            SessionOptions options, MasterSand sand);

    /// Runs all frames, and writes journal, pictures and summary. Collective with showTile() of the render ranks.
    ///
    /// Returns the exit status, which is 0 if all went well. It is 1 if the ranks could not be made to agree, if the
    /// sand differed from the recording, or if the sand's volume is inexact. It is also 1 if the journal does not
    /// confirm the sand, or if the summary could not be written. Throws DiskFailure if the disk refuses the journal
    /// under the policy `required`, and base::InputError if a picture cannot be written.
    int run();
    /// A checkpoint that was still being written at the end, and whether the session can do without it.
    struct LastCheckpoint {
        UnfinishedCheckpoint checkpoint;
        bool dispensable;
    };
    /// Returns the checkpoint that is to be finished when no rank waits any more; nullopt if there is none. Call it
    /// after run().
    [[nodiscard]] std::optional<LastCheckpoint> takeUnfinished();

private:
    /// Shows one frame. Returns whether all ranks agreed. Sets `more` to whether another frame follows.
    [[nodiscard]] bool showFrame(bool& more);
    void reportLeftOut(const ArrivedSteps& steps);
    /// Prints a line about the first press that was refused. `before` is MasterSand::stepsUnplaced() before the frame.
    void reportRefusedPress(std::uint64_t before);
    void waitForFrame();
    [[nodiscard]] ArrivedSteps takeSteps();
    [[nodiscard]] lockstep::FrameMessage compose(const ArrivedSteps& steps);
    void startDrills();
    void keep(const lockstep::FrameMessage& frame, const ArrivedSteps& steps);
    /// Returns whether the journal lacks the hash after the last step, and no step is due.
    [[nodiscard]] bool beginsRest() const;
    /// Returns whether the session shows no steps after the present one.
    [[nodiscard]] bool ends() const;
    /// Returns whether the session takes no steps, because it is paused, the disk is full, or the journal is replayed.
    [[nodiscard]] bool held() const {
        return desk_.paused() || record_.full() || check_.holds() || (check_.pending() && ends());
    }
    /// Returns why held() is true, as far as haptic servers count it. A replay of the journal counts as a slow wall.
    [[nodiscard]] haptic_bridge::Held heldBy() const {
        return desk_.paused()   ? haptic_bridge::Held::pause
               : record_.full() ? haptic_bridge::Held::disk
                                : haptic_bridge::Held::no;
    }
    /// Returns the cost of the last frame, and the work of its steps.
    [[nodiscard]] haptic_bridge::FrameCost cost() const;
    /// Returns the sweeps that the tool waits for.
    [[nodiscard]] std::int32_t sweepsOwed() const;
    /// Meets the ranks at the barrier of `frame`. Returns whether all ranks agreed.
    [[nodiscard]] bool agree(const lockstep::FrameMessage& frame);
    [[nodiscard]] journal::JournalEnd shownSand() const { return {sand_.replica().stepNumber(), sand_.hash()}; }
    /// Returns why the session's sand cannot be trusted at its end; an empty text if it can.
    [[nodiscard]] std::string doubtAbout(const Summary& result) const;
    [[nodiscard]] Incidents incidents() const;  // since the session began, across restarts
    [[nodiscard]] nlohmann::json status() const;
    void printProgress(bool last);
    /// Returns the time after which a line of progress that has not changed is printed again [s].
    [[nodiscard]] double secondsToRepeat() const;
    [[nodiscard]] int writeResults(bool agreed);
    [[nodiscard]] Summary finish(bool agreed);
    [[nodiscard]] Summary summary();  // collective, because each rank sends a report
    void fillHand(Summary& summary) const;

    const scene::Scene& scene_;
    const walls::Wall& wall_;
    const SessionOptions options_;
    const RankLabels labels_;
    const std::vector<lockstep::RankHost> hosts_;        // by rank
    const std::optional<std::int64_t> volumeOfHeights_;  // of the scene, as sand::Start has it
    lockstep::FrameBarrier barrier_;
    std::uint64_t frame_ = 0;
    std::optional<std::uint64_t> keptHashOf_;  // last step after which the journal has the hash
    FrameClock clock_;
    MasterSand sand_;
    Edits edits_;
    std::unique_ptr<StepSource> steps_;
    SessionRecord record_;
    Incidents counted_;  // since the session began; incidents() adds what the link, the disk and check_ have counted
    OperatorDesk desk_;
    Measurements measure_;
    DarkOutputs dark_;
    SandCheck check_;
    std::optional<Film> film_;
    /// Returns whether the film shows the present frame. The frames before its beginning are not shown.
    [[nodiscard]] bool filmsFrame() const { return film_ && frame_ > options_.recording->framesBefore(); }
};

}  // namespace master
