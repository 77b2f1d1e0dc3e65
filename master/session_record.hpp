// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "master/frame_clock.hpp"
#include "master/incidents.hpp"
#include "master/journal/keeper.hpp"
#include "master/journal/resume.hpp"
#include "master/master_sand.hpp"
#include "master/rank_labels.hpp"
#include "master/recovery.hpp"
#include "master/summary.hpp"
#include "scene/scene.hpp"

namespace master {

struct RecordOptions {
    bool keepsJournal = true;  // a replay has one already
    JournalOptions journal;
    std::shared_ptr<const ResumedSession> resumed;  // goes on where that one stopped
    Failure failure;                                // that made it stop
};

/// Keeps the files that a session writes while it runs: journal, checkpoints, incidents and recoveries. One thread.
class SessionRecord {
public:
    /// Removes what an earlier session has left in `out`, unless this one goes on with it. Throws as JournalKeeper.
    SessionRecord(std::filesystem::path out, RecordOptions options, const scene::Scene& scene, RankLabels labels);

    /// Returns whether the disk has room for the steps of a frame, and for `bytes` of sand that is loaded. Remembers
    /// the answer for full().
    [[nodiscard]] bool hasRoom(std::int64_t bytes, const MasterSand& sand);
    /// Whether no steps are taken, because the disk has no room.
    [[nodiscard]] bool full() const { return full_; }

    /// Returns when the steps of a frame are on disk. `materials` are those that their edits make the session's. Throws
    /// DiskFailure when the disk refuses, if the policy is `required`; failure.json says so then.
    void keep(const JournalFrame& frame, const std::vector<scene::Material>& materials);
    /// Keeps pieces of the tick track: on disk with later steps. Throws as keep().
    void keepTicks(const std::vector<base::Bytes>& pieces);
    /// Tells that the wall shows this frame: reports a recovery, and begins a checkpoint when one is due.
    void shown(const Swap& swap, std::uint64_t frame, const MasterSand& sand, std::uint32_t epoch);
    /// Ends the journal in an orderly way, unless ranks still differ.
    void finish(const MasterSand& sand, bool agreed);

    /// Incidents of the session before it stopped and went on; and the file that gets all of them.
    [[nodiscard]] const Incidents& before() const { return incidents_.before(); }
    void keepIncidents(const Incidents& all, std::int64_t nowNs) { incidents_.keep(all, nowNs); }
    void keepLastIncidents(const Incidents& all) { incidents_.keepLast(all); }
    /// How often the sand stood for want of room, since this process began.
    [[nodiscard]] std::uint64_t stands() const { return journal_ ? journal_->stands() : 0; }

    /// Returns the first file of the journal; empty if the session writes none, or has given it up.
    [[nodiscard]] std::filesystem::path journalFile() const;
    /// Computes from the journal the sand after the last step of `sand`. Returns null without a readable journal.
    [[nodiscard]] std::unique_ptr<sand::Replica> sandOfJournal(const MasterSand& sand,
                                                               const sand::grid::Erosion::Options& sweeps) const;

    /// Adds journal, journal_policy and journal_state to what `ctl status` answers.
    void describe(nlohmann::json& status) const;
    [[nodiscard]] Summary::Journal summary() const;

private:
    [[noreturn]] void endForDisk(const DiskFailure& failure) const;
    void tellRecovery(std::uint64_t frame, const MasterSand& sand) const;

    const std::filesystem::path out_;
    const RecordOptions options_;
    const RankLabels labels_;
    IncidentFile incidents_;
    std::optional<JournalKeeper> journal_;
    bool full_ = false;
};

}  // namespace master
