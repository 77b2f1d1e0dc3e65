// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>

#include "lockstep/frame_message.hpp"
#include "lockstep/view_agreement.hpp"
#include "master/check/agreement.hpp"
#include "master/check/compare_track.hpp"
#include "master/check/journal_check.hpp"
#include "master/check/ranks.hpp"
#include "master/measure/incidents.hpp"
#include "master/measure/summary.hpp"
#include "walls/wall.hpp"

namespace master {

/// Checks that a session shows the right sand. In every frame all ranks must agree, and the journal must confirm what a
/// majority of them has decided. Counts every difference. Main thread only.
class SandCheck {
public:
    /// The parts of a session that the check uses. `tiles` is the number of hash tiles, and `firstDifference` that of
    /// CompareTrack.
    struct Parts {
        lockstep::FrameBarrier& barrier;
        Incidents& counted;  // of the session; the check counts in it
        lockstep::RankStatistics& statistics;
        Agreement::Witness witness;
        JournalCheck::Record record;
        std::uint32_t tiles;
        std::uint64_t firstDifference;
    };
    SandCheck(const walls::Wall& wall, const RankLabels& labels, const std::filesystem::path& out, Parts parts);

    /// Counts and reports a majority that the replay outvoted when the session was resumed.
    void reportResumed(const Outvoted& outvoted) { journal_.reportResumed(outvoted); }

    /// Call these in every frame, in this order. applied(): the master has applied all steps up to `step`.
    void applied(std::uint64_t step);
    /// Returns the hash of a view, which is part of an arrival.
    [[nodiscard]] std::uint64_t viewHash(const lockstep::ViewState& view) const { return viewProof_.hash(view); }
    /// Meets the ranks at the barrier of `frame`, and heals sand that differs. Returns whether all ranks agreed. `next`
    /// is the earliest time at which the next frame begins [ns].
    [[nodiscard]] bool agree(const lockstep::FrameMessage& frame, const lockstep::Arrival& mine, MasterSand& sand,
                             StepSource& steps, std::int64_t next);
    /// Counts a haptic server whose sand was other than that of frame `frame`.
    void serverDiffered(std::uint64_t frame);
    /// The wall shows frame `frame` with the sand `sand`. Starts and ends the comparison of a majority's decision with
    /// the journal.
    void shown(std::uint64_t frame, const journal::JournalEnd& sand);

    /// Returns whether a majority's decision has not been compared with the journal yet.
    [[nodiscard]] bool pending() const { return journal_.pending(); }
    /// Returns whether the wall must take no steps, so that the replay of the journal can catch up with it.
    [[nodiscard]] bool holds() const { return journal_.holds(); }
    /// Returns whether the next frame may be the last one. It may not while a decision is pending, for at most 90 s
    /// from the first call on. `step` is the last step that this frame shows.
    [[nodiscard]] bool mayEnd(std::int64_t nowNs, std::uint64_t step);
    /// Called after the last frame. Waits at most `patience` for the replay of the journal.
    void finish(std::uint64_t frame, const journal::JournalEnd& shown, std::chrono::milliseconds patience) {
        journal_.finish(frame, shown, patience);
    }
    /// Returns why the latest decision of a majority could not be compared; an empty text if it was, or if there was
    /// none.
    [[nodiscard]] const std::string& doubt() const { return journal_.doubt(); }

    /// Returns the first frame in which sand differed, or 0.
    [[nodiscard]] std::uint64_t firstDifference() const { return compared_.firstDifference(); }
    /// Fills in how the sand was compared. `unhealed` is the number of ranks that could not be healed.
    void fill(Summary& summary) const;

private:
    Incidents& counted_;
    BarrierRanks ranks_;
    const lockstep::ViewProof viewProof_;
    Agreement agreement_;
    CompareTrack compared_;
    JournalCheck journal_;
    std::uint32_t tiles_;
    std::int64_t endsSince_ = 0;  // [ns], since when the end of the session waits for journal_; 0: it does not wait
    bool agreedToEnd_ = false;    // whether all ranks have agreed on the last frame
};

}  // namespace master
