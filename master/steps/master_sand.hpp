// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/names.hpp"
#include "lockstep/fault.hpp"
#include "lockstep/sand_time.hpp"
#include "master/steps/step_source.hpp"
#include "sand/replica.hpp"
#include "scene/model/undo_history.hpp"

namespace master {

/// A part of a step that had no effect, although the journal holds it. See sand::Replica::leftOut().
struct LeftOut {
    std::uint64_t step = 0;
    std::string what;
    bool refused = false;  // sand::Replica::refusedStep()
};

/// The end of a settle by sweeps.
enum class SettleEnd : std::uint8_t {
    rest,  // all sand came to rest
    hand,  // an engaged tool moved
    edit   // another edit took its place, or its step was skipped
};
constexpr auto valuesOf(SettleEnd) {
    using enum SettleEnd;
    return std::array{base::Named{rest, "rest"}, base::Named{hand, "hand"}, base::Named{edit, "edit"}};
}

/// A settle by sweeps that has ended.
struct EndedSettle {
    std::uint64_t begun = 0;  // step that began it; 0: a settle of the session that was resumed
    SettleEnd by = SettleEnd::rest;
    friend bool operator==(const EndedSettle&, const EndedSettle&) = default;
};

/// The master's own replica of the sand, its state hash, and the faults that drills inject into it. Used by one thread.
class MasterSand {
public:
    /// `faults` are the faults of all ranks. `edits` is the number of edits that a resumed session had.
    explicit MasterSand(sand::Replica replica, const std::vector<lockstep::Fault>& faults = {},
                        std::uint64_t edits = 0);

    [[nodiscard]] const sand::Replica& replica() const { return replica_; }
    /// Returns the replica so that it can be healed. Call rehash() after that.
    [[nodiscard]] sand::Replica& replica() { return replica_; }
    /// Returns the hash of the state that the wall shows once all ranks have agreed.
    [[nodiscard]] std::uint64_t hash() const { return hash_; }
    void rehash() { hash_ = replica_.stateHash(); }

    /// Begins a history of the steps from now on, so that operators can undo and redo them. `material` is the present
    /// one.
    void keepHistory(const scene::Material& material) { history_.emplace(replica_, material); }
    /// Return the history, or null without keepHistory().
    [[nodiscard]] scene::UndoHistory* history() { return history_ ? &*history_ : nullptr; }
    [[nodiscard]] const scene::UndoHistory* history() const { return history_ ? &*history_ : nullptr; }

    /// Injects the master's faults of frame `frame`, applies `steps`, and hashes `auditTiles` hash tiles again from
    /// memory. Calls `source`.reached() before the first step and after each step.
    void apply(std::uint64_t frame, const ArrivedSteps& steps, std::uint32_t auditTiles, StepSource& source);
    /// Returns how many hash tiles to hash again in the next frame, so that all tiles are hashed in each second at any
    /// frame rate. `sinceSwap` is the time since the last swap [s].
    [[nodiscard]] std::uint32_t auditTiles(double sinceSwap) const;
    /// Returns the number of all hash tiles, which the last frame of a session hashes again.
    [[nodiscard]] std::uint32_t allTiles() const {
        return static_cast<std::uint32_t>(replica_.hashTiles().tileCount());
    }

    /// Returns the work of the last apply(), and the time that it took here.
    [[nodiscard]] const sand::StepWork& work() const { return work_; }
    [[nodiscard]] const lockstep::SandTime& time() const { return time_; }

    /// Returns what the steps since the last call have left out.
    [[nodiscard]] std::vector<LeftOut> takeLeftOut() { return std::exchange(leftOut_, {}); }
    /// Returns the settles by sweeps that have ended in the last apply(), also those that ended in their own step.
    [[nodiscard]] const std::vector<EndedSettle>& endedSettles() const { return endedSettles_; }
    /// Returns how the settle of step `begun` has ended in the last apply(); nullopt if it has not.
    [[nodiscard]] std::optional<SettleEnd> endOfSettle(std::uint64_t begun) const;
    /// Returns the step whose settle continues in the next step, with the 0 of EndedSettle; nullopt if none does.
    [[nodiscard]] std::optional<std::uint64_t> settlingSince() const { return settlingSince_; }
    /// Returns the number of steps with a press that was refused (sand::Replica::refusedPress()), since the last start.
    [[nodiscard]] std::uint64_t stepsUnplaced() const { return stepsUnplaced_; }
    /// Returns the number of the first of these steps, or 0.
    [[nodiscard]] std::uint64_t firstStepUnplaced() const { return firstStepUnplaced_; }
    /// Returns the number of steps with an edit since the session began.
    [[nodiscard]] std::uint64_t edits() const { return edits_; }

private:
    /// Notes what `step`, which was applied last, has done to settles. `begins` is sand::Replica::settlesBySweeps()
    /// from before the step.
    void noteSettle(const sand::Step& step, bool begins);

    sand::Replica replica_;
    std::optional<scene::UndoHistory> history_;
    const lockstep::FaultsOfRank faults_;
    std::uint64_t hash_ = 0;
    std::uint64_t edits_ = 0, stepsUnplaced_ = 0, firstStepUnplaced_ = 0;
    std::vector<LeftOut> leftOut_;
    std::optional<std::uint64_t> settlingSince_;
    std::vector<EndedSettle> endedSettles_;
    sand::StepWork work_;
    lockstep::SandTime time_;
};

}  // namespace master
