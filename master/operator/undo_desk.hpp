// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "master/operator/asker.hpp"
#include "master/operator/background_jobs.hpp"
#include "master/steps/master_sand.hpp"

namespace master {

/// Returns "undo" or "redo".
[[nodiscard]] std::string_view nameOf(sand::History::Move move);

/// The undos and redos that operators have asked for. It makes one after the other, because each one starts from the
/// sand that the one before has restored. Main thread only.
///
/// The newest stroke is undone by one edit. Any other undo or redo loads sand. The main thread copies this sand over
/// some frames, and a thread compresses it. A change of the material is undone by two edits.
class UndoDesk {
public:
    static constexpr std::size_t kMostWaiting = sand::History::kMost;

    struct Asked {
        sand::History::Move move = sand::History::Move::undo;
        Asker asker;
    };
    /// The parts of the operator's desk that this one uses.
    struct Desk {
        MasterSand& sand;
        BackgroundJobs& jobs;
        std::int64_t mostBytes;  // of sand in a step (sand::StepLimits)
        /// Asks for an edit that undoes or redoes, and returns its number. Throws base::InputError if it refuses.
        std::function<std::uint64_t(sand::Edit edit, const scene::UndoHistory::Return& wanted, const Asker& asker)>
            askEdit;
        std::function<void(const std::string& why, const Askers& askers)> refuse;
    };
    explicit UndoDesk(Desk desk) : desk_(std::move(desk)) {}

    /// Throws base::InputError if there is nothing to undo or redo, if the edit is refused, or if too many wait.
    void ask(const Asked& asked);
    /// Continues what was asked for. Call it in each frame.
    void proceed();
    /// Takes the result of a job of kind BackgroundJobs::Kind::undo.
    void take(BackgroundJobs::Done done);
    /// Returns what the edit `number` has ended, or nullopt. Call it for each edit that the wall shows.
    [[nodiscard]] std::optional<Asked> takeEnded(std::uint64_t number);
    /// Returns whether the step of the edit that takeEnded() has just returned has undone or redone something.
    [[nodiscard]] bool changedAnything() const { return versionBefore_ != entries().version(); }
    [[nodiscard]] const sand::History& entries() const { return desk_.sand.history()->entries(); }

private:
    struct Running {
        Asked asked;
        scene::UndoHistory::Return wanted;
        bool inJob = false;
        std::uint64_t number = 0;  // of the last edit; 0 before it was asked for
    };
    void begin(const Asked& asked);  // throws as ask()
    void copyMore();
    void startJob();
    void end(const std::string& why);

    const Desk desk_;
    std::deque<Asked> waiting_;
    std::optional<Running> running_;
    std::uint64_t versionBefore_ = 0;
};

}  // namespace master
