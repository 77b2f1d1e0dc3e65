// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lockstep/rank_statistics.hpp"
#include "master/check/decision.hpp"
#include "master/check/ranks.hpp"
#include "master/journal/keeper.hpp"
#include "master/measure/incidents.hpp"
#include "master/measure/rank_labels.hpp"
#include "master/steps/master_sand.hpp"

namespace master {

/// Makes all ranks agree before a frame is shown. If ranks differ, decides which ranks are right, heals the others, and
/// ends the session if a rank is broken. Used by one thread.
class Agreement {
public:
    /// Functions that return the journal's first file, or an empty path without a journal, and the journal's sand after
    /// the last step, or null.
    struct Witness {
        std::function<std::filesystem::path()> journal;
        std::function<std::unique_ptr<sand::Replica>()> sand;
    };

    /// `incidents` counts divergences and healings. `statistics` counts the frames in which each rank agreed, differed
    /// or was healed. `out` gets divergence.txt and failure.json.
    Agreement(Ranks& ranks, RankLabels labels, std::filesystem::path out, Incidents& incidents,
              lockstep::RankStatistics& statistics, Witness witness);

    /// A rank that needs to be healed more often counts as broken. One flipped bit is an accident, but memory that
    /// needs to be healed a third time is broken and stays so.
    static constexpr std::uint64_t kMostHealings = 2;

    /// Meets the ranks at the barrier with the arrival `mine`, and heals sand that differs until all ranks agree.
    /// `next` is the earliest time at which the next frame begins [ns]. Returns false if the session must end. The
    /// reason has then been printed.
    [[nodiscard]] bool reach(lockstep::Arrival mine, MasterSand& sand, StepSource& steps, std::int64_t next);

    /// Makes the next reach() give `right` to all ranks, although a majority of them has other sand.
    void overrule(std::unique_ptr<sand::Replica> right) { overruling_ = std::move(right); }
    /// Returns the sand that a majority has decided on since the last call; nullopt if none has.
    [[nodiscard]] std::optional<Decision> takeDecision() { return std::exchange(decision_, std::nullopt); }
    /// Called when the journal has confirmed all decisions so far. A later overrule() then does not concern them.
    void confirmed() { healedInDoubt_.clear(); }

    /// Returns how many ranks have ended the session because their sand or view differed and could not be healed.
    [[nodiscard]] std::uint64_t unhealed() const { return unhealed_; }

private:
    [[nodiscard]] bool healSand(std::uint64_t frame, MasterSand& sand, StepSource& steps, bool again);
    [[nodiscard]] std::optional<int> brokenAmong(const std::vector<int>& odd) const;
    [[nodiscard]] std::string giveUp(std::uint64_t frame, int rank, bool again) const;
    [[nodiscard]] std::vector<std::string> countHealed(std::uint64_t frame, const lockstep::Divergence& divergence,
                                                       const std::vector<int>& odd);
    void countStrikes(const lockstep::Divergence& divergence, const std::vector<int>& odd);
    void reportOtherViews(std::uint64_t frame);
    void reportNonsense();

    Ranks& ranks_;
    const RankLabels labels_;
    const std::filesystem::path out_;
    Incidents& incidents_;
    lockstep::RankStatistics& statistics_;
    const Witness witness_;
    std::unique_ptr<sand::Replica> overruling_;  // the journal's sand, which all ranks must take; usually null
    std::optional<Decision> decision_;
    std::vector<int> healedInDoubt_;      // ranks that a majority has healed whose decision is not confirmed
    std::vector<std::uint64_t> strikes_;  // by rank: healings that count against it
    std::uint64_t unhealed_ = 0;
};

}  // namespace master
