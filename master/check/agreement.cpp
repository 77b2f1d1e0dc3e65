// SPDX-License-Identifier: Apache-2.0
#include "master/check/agreement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "host/event.hpp"
#include "host/print_line.hpp"
#include "lockstep/view_agreement.hpp"
#include "master/check/disagreement.hpp"

namespace master {
namespace {

std::vector<int> ranksOf(const lockstep::Divergence& divergence) {
    std::vector<int> ranks;
    for (const lockstep::Divergence::Odd& odd : divergence.odd) {
        ranks.push_back(odd.rank);
    }
    return ranks;
}

}  // namespace

Agreement::Agreement(Ranks& ranks, RankLabels labels, std::filesystem::path out, Incidents& incidents,
                     lockstep::RankStatistics& statistics, Witness witness)
    : ranks_(ranks),
      labels_(std::move(labels)),
      out_(std::move(out)),
      incidents_(incidents),
      statistics_(statistics),
      witness_(std::move(witness)),
      strikes_(labels_.names.size()) {}

bool Agreement::reach(lockstep::Arrival mine, MasterSand& sand, StepSource& steps, std::int64_t next) {
    if (overruling_) {
        // The master arrives with the journal's hash. All ranks then have other sand, and are healed.
        mine.stateHash = overruling_->stateHash();
        mine.movement = overruling_->movementDigest();
    }
    lockstep::Verdict verdict = ranks_.meet(mine, next);
    for (bool again = false; verdict != lockstep::Verdict::equal; again = true) {
        if (verdict == lockstep::Verdict::nonsense) {
            reportNonsense();
            return false;
        }
        incidents_.divergences += again ? 0 : 1;
        if (verdict == lockstep::Verdict::otherView) {
            reportOtherViews(mine.frame);
            return false;
        }
        if (!healSand(mine.frame, sand, steps, again)) {
            return false;
        }
        sand.rehash();
        mine.stateHash = sand.hash();
        mine.movement = sand.replica().movementDigest();
        verdict = ranks_.meet(mine, next);
    }
    overruling_.reset();  // unused if an edit has restored the right sand meanwhile
    if (const std::string line = steps.takeStrayLine(); !line.empty()) {
        host::printLine("{}", line);
    }
    return true;
}

bool Agreement::healSand(std::uint64_t frame, MasterSand& sand, StepSource& steps, bool again) {
    const bool overrules = overruling_ != nullptr;
    const lockstep::Arbiter arbiter{[this] { return overruling_ ? std::move(overruling_) : witness_.sand(); },
                                    overrules};
    const lockstep::Divergence divergence = ranks_.findDivergence(sand.replica(), arbiter);
    const std::vector<int> odd = ranksOf(divergence);
    const DivergedFrame diverged{frame, sand.replica().stepNumber(), divergence};
    emitDivergence(diverged, static_cast<int>(labels_.names.size()), witness_.journal());
    std::vector<std::string> lines = describeDivergence(diverged, labels_.names, witness_.journal());
    const std::optional<int> broken = again && !odd.empty() ? std::optional(odd.front())
                                      : overrules           ? std::nullopt
                                                            : brokenAmong(odd);
    lockstep::Remedy remedy{!broken, divergence.source, odd};
    if (broken) {
        statistics_.addOdd(odd);
        unhealed_ += odd.size();
        lines.push_back(giveUp(frame, *broken, again));
    } else {
        const std::vector<std::string> healed = countHealed(frame, divergence, odd);
        lines.insert(lines.end(), healed.begin(), healed.end());
    }
    report(lines, out_ / "divergence.txt");
    if (!broken && divergence.journal) {
        // No rank has the right sand, so the master takes it from the journal and sends it to the others.
        sand.replica().decodeState(divergence.journal->encodeState());
        remedy.source = lockstep::kMaster;
        std::erase(remedy.odd, lockstep::kMaster);
    }
    const lockstep::Healing healing = ranks_.heal(sand.replica(), remedy);
    if (healing != lockstep::Healing::ended && !odd.empty() &&
        divergence.judge == lockstep::Divergence::Judge::majority) {
        // Now, because the master's own sand may have been the wrong one, with another step number.
        decision_ = {{sand.replica().stepNumber(), divergence.rightHash}, sand.replica().movementDigest()};
    }
    if (std::find(odd.begin(), odd.end(), lockstep::kMaster) != odd.end()) {
        steps.healed(sand.replica());
    }
    return healing != lockstep::Healing::ended;
}

std::vector<std::string> Agreement::countHealed(std::uint64_t frame, const lockstep::Divergence& divergence,
                                                const std::vector<int>& odd) {
    const std::string& from =
        divergence.journal ? "the journal" : labels_.names[static_cast<std::size_t>(divergence.source)];
    statistics_.addHealed(odd);
    countStrikes(divergence, odd);
    incidents_.healed += odd.size();
    std::vector<std::string> lines;
    for (const int rank : odd) {
        const auto index = static_cast<std::size_t>(rank);
        const std::uint64_t times = strikes_[index];
        lines.push_back(fmt::format("frame {}: {} takes the sand of {}; {} of at most {} healings count against it",
                                    frame, labels_.names[index], from, times, kMostHealings));
        host::emitEvent("healed", {{"frame", frame},
                                   {"rank", rank},
                                   {"source", divergence.journal ? "journal" : "rank"},
                                   {"source_rank", divergence.journal ? -1 : divergence.source},
                                   {"times", times}});
    }
    return lines;
}

/// Counts the healing of each rank against it. If the journal outvotes a majority, the ranks that this majority had
/// healed were right, and the other ranks were wrong.
void Agreement::countStrikes(const lockstep::Divergence& divergence, const std::vector<int>& odd) {
    for (const int rank : odd) {
        std::uint64_t& strikes = strikes_[static_cast<std::size_t>(rank)];
        const bool wasRight = divergence.outvoted && std::count(healedInDoubt_.begin(), healedInDoubt_.end(), rank) > 0;
        if (wasRight) {
            strikes -= std::min<std::uint64_t>(strikes, 1);
        } else {
            ++strikes;
        }
    }
    if (divergence.outvoted) {
        healedInDoubt_.clear();
    } else if (divergence.judge == lockstep::Divergence::Judge::majority && healedInDoubt_.empty()) {
        healedInDoubt_ = odd;
    }
}

std::optional<int> Agreement::brokenAmong(const std::vector<int>& odd) const {
    for (const int rank : odd) {
        if (strikes_[static_cast<std::size_t>(rank)] >= kMostHealings) {
            return rank;
        }
    }
    return std::nullopt;
}

std::string Agreement::giveUp(std::uint64_t frame, int rank, bool again) const {
    std::string line =
        fmt::format("frame {}: {} {} and counts as broken; the session ends, and its journal holds every step", frame,
                    labels_.names[static_cast<std::size_t>(rank)],
                    again ? "still differs after it was healed" : "needs to be healed a third time");
    (void)writeFailure(labels_.failure("broken", rank, line), out_);
    return line;
}

void Agreement::reportOtherViews(std::uint64_t frame) {
    const std::vector<lockstep::Arrival>& arrivals = ranks_.arrivals();
    std::vector<int> odd;
    for (std::size_t rank = 1; rank < arrivals.size(); ++rank) {
        if (arrivals[rank].viewHash != arrivals[lockstep::kMaster].viewHash) {
            odd.push_back(static_cast<int>(rank));
        }
    }
    statistics_.addOdd(odd);
    unhealed_ += odd.size();
    host::emitEvent("view_divergence", {{"frame", frame}, {"rank", odd.front()}});
    const std::vector<std::string> lines = lockstep::describeOtherViews(arrivals, labels_.names);
    report(lines, out_ / "divergence.txt");
    (void)writeFailure(labels_.failure("broken", odd.front(), lines.front()), out_);
}

void Agreement::reportNonsense() {
    std::vector<int> odd;
    for (const lockstep::FrameBarrier::Nonsense& one : ranks_.nonsense()) {
        odd.push_back(one.rank);
        host::printLine("{}; the rank counts as broken, and the session ends", one.line);
    }
    statistics_.addOdd(odd);
    (void)writeFailure(labels_.failure("broken", odd.front(), ranks_.nonsense().front().line), out_);
}

}  // namespace master
