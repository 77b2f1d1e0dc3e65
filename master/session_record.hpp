// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "master/journal/keeper.hpp"
#include "master/journal/resume.hpp"
#include "master/measure/frame_clock.hpp"
#include "master/measure/incidents.hpp"
#include "master/measure/rank_labels.hpp"
#include "master/measure/recovery.hpp"
#include "master/measure/summary.hpp"
#include "master/steps/master_sand.hpp"
#include "scene/model/scene.hpp"

namespace master {

struct RecordOptions {
    bool keepsJournal = true;  // false for a replay, which has a journal already
    JournalOptions journal;
    std::shared_ptr<const ResumedSession> resumed;  // session that is resumed; null for a new one
    std::shared_ptr<SceneCheck> check;  // of the file of the resumed session's scene; null if it is compared
    Failure failure;                    // failure that stopped the resumed session
};

/// Writes the files of a running session: journal, checkpoints, incidents and recoveries. Used by one thread.
class SessionRecord {
public:
    /// Removes the results of an earlier session from `out`. A resumed session keeps its divergence.txt, recoveries and
    /// incidents. Throws as the constructor of JournalKeeper does.
    SessionRecord(std::filesystem::path out, RecordOptions options, const scene::Scene& scene, RankLabels labels);

    /// Returns whether the disk has room for the steps of a frame and for `bytes` of sand that is loaded. Also sets
    /// full().
    [[nodiscard]] bool hasRoom(std::int64_t bytes, const MasterSand& sand);
    /// Returns whether the disk has room for an edit with `bytes` of sand. Leaves full() as it is.
    [[nodiscard]] bool hasRoomForEdit(std::int64_t bytes, const MasterSand& sand);
    /// Returns whether the session takes no steps because the disk has no room.
    [[nodiscard]] bool full() const { return full_; }

    /// Writes the steps of a frame, and returns when they are on disk. `materials` are the materials that the edits of
    /// these steps set. If the disk refuses them and the policy is `required`, writes failure.json and throws
    /// DiskFailure.
    void keep(const journal::JournalFrame& frame, const std::vector<scene::Material>& materials);
    /// Writes pieces of the tick track. They are on disk together with later steps. Throws as keep() does.
    void keepTicks(const std::vector<base::Bytes>& pieces);
    /// Write that a majority has decided which sand is right, and that it has been compared with the journal. Between
    /// the two no checkpoint is made, and the journal gets no end. Throw as keep() does.
    void doubt(const journal::JournalDoubt& doubt);
    void checked(const journal::JournalChecked& checked);
    /// Writes the share of the force that an operator has set, at once if the disk has room. Throws as keep() does.
    void keepForce(double share);
    /// Called when the wall shows frame `frame`. Reports a recovery at the first one, and begins a checkpoint when one
    /// is due.
    void shown(const Swap& swap, std::uint64_t frame, const MasterSand& sand, std::uint32_t epoch);
    /// Writes the journal's orderly end if `agreed`, which means that the ranks agreed to the end.
    void finish(const MasterSand& sand, bool agreed);
    /// Return the checkpoint that is still being written after finish(), and whether an older one is on disk.
    [[nodiscard]] std::optional<UnfinishedCheckpoint> takeUnfinished();
    [[nodiscard]] bool hasCheckpoint() const { return journal_ && journal_->hasCheckpoint(); }

    /// Returns the incidents from before the last restart. The next two functions write all incidents to their file.
    [[nodiscard]] const Incidents& before() const { return incidents_.before(); }
    void keepIncidents(const Incidents& all, std::int64_t nowNs) { incidents_.keep(all, nowNs); }
    void keepLastIncidents(const Incidents& all) { incidents_.keepLast(all); }
    /// Returns how often the sand was stopped because the disk was full, since this process began.
    [[nodiscard]] std::uint64_t stops() const { return journal_ ? journal_->stops() : 0; }

    /// Returns the first file of the journal. Returns an empty path if the session writes no journal, or has given it
    /// up.
    [[nodiscard]] std::filesystem::path journalFile() const;
    /// Computes the sand after the last step of `sand` from the journal. Returns null without a readable journal.
    [[nodiscard]] std::unique_ptr<sand::Replica> sandOfJournal(const MasterSand& sand,
                                                               const base::Executor* executor) const;

    /// Adds the fields journal, journal_policy, journal_state, checkpoints_failed and restarts to the answer `status`
    /// of `ctl status`.
    void describe(nlohmann::json& status) const;
    [[nodiscard]] Summary::Journal summary() const;

private:
    /// Calls `write` with the journal if there is one. If the disk refuses it and the policy is `required`, ends the
    /// session as keep() describes.
    template <class Write>
    void onDisk(const Write& write);
    [[noreturn]] void endForDisk(const DiskFailure& failure) const;
    void reportRecovery(std::uint64_t frame, const MasterSand& sand) const;

    const std::filesystem::path out_;
    const RecordOptions options_;
    const RankLabels labels_;
    IncidentFile incidents_;
    mutable RecoveryCount recoveries_;
    std::optional<JournalKeeper> journal_;
    bool full_ = false;
};

}  // namespace master
