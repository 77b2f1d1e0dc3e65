// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lockstep/rank_statistics.hpp"
#include "master/master_sand.hpp"
#include "master/rank_labels.hpp"
#include "master/ranks.hpp"

namespace master {

/// Makes all ranks agree before a frame is shown. Decides which ranks are right when they differ, heals the others, and
/// gives up a rank that is broken. One thread.
class Agreement {
public:
    /// Gives the journal's first file, or an empty path without a journal; and the journal's sand after the last step,
    /// or null.
    struct Witness {
        std::function<std::filesystem::path()> journal;
        std::function<std::unique_ptr<sand::Replica>()> sand;
    };

    /// `statistics` counts what each rank did; `out` gets divergence.txt and failure.json.
    Agreement(Ranks& ranks, RankLabels labels, std::filesystem::path out, lockstep::RankStatistics& statistics,
              Witness witness);

    /// A rank whose sand has to be healed more often is given up: a bit that flips is an accident, and memory that
    /// needs help a third time is broken, and will go on being so.
    static constexpr std::uint64_t kMostHealings = 2;

    /// Meets the ranks with `mine`, and heals sand that differs until all have the same. Returns false when the session
    /// has to end; why has been told then. `next` is when the next frame begins at the earliest [ns].
    [[nodiscard]] bool reach(lockstep::Arrival mine, MasterSand& sand, StepSource& steps, std::int64_t next);

    /// Frames on which ranks differed, and times that one was healed, since this process began.
    [[nodiscard]] std::uint64_t divergences() const { return divergences_; }
    [[nodiscard]] std::uint64_t healed() const { return healed_; }

private:
    [[nodiscard]] bool healSand(std::uint64_t frame, MasterSand& sand, StepSource& steps, bool again);
    [[nodiscard]] std::optional<int> brokenAmong(const std::vector<int>& odd) const;
    [[nodiscard]] std::string giveUp(std::uint64_t frame, int rank, bool again) const;
    [[nodiscard]] std::vector<std::string> countHealed(std::uint64_t frame, const lockstep::Divergence& divergence,
                                                       const std::vector<int>& odd);
    void reportOtherViews(std::uint64_t frame);
    void reportNonsense();

    Ranks& ranks_;
    const RankLabels labels_;
    const std::filesystem::path out_;
    lockstep::RankStatistics& statistics_;
    const Witness witness_;
    std::uint64_t divergences_ = 0, healed_ = 0;
};

}  // namespace master
