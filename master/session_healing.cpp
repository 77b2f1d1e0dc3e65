// SPDX-License-Identifier: Apache-2.0
// What a session does when ranks differ: who is right, who is healed, and who is given up.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "base/input_error.hpp"
#include "host/event.hpp"
#include "host/print_line.hpp"
#include "lockstep/healing.hpp"
#include "master/disagreement.hpp"
#include "master/journal/resume.hpp"
#include "master/session.hpp"

namespace master {
namespace {

// A bit that flips is an accident; memory that needs help a third time is broken, and will go on being so.
constexpr std::uint64_t kMostHealings = 2;

std::vector<int> ranksOf(const lockstep::Divergence& divergence) {
    std::vector<int> ranks;
    for (const lockstep::Divergence::Odd& odd : divergence.odd) {
        ranks.push_back(odd.rank);
    }
    return ranks;
}

}  // namespace

Incidents Session::incidents() const {
    Incidents all = incidentFile_.before();
    all.divergences = summary_.divergences;  // which began with those before
    all.healed = summary_.healed;
    all.serverDivergences = summary_.serverDivergences;
    const haptic_bridge::LinkCounters link = liveSteps_.counters();
    all.links += link.links;
    all.reconnects += link.reconnects;
    for (std::size_t i = 0; i < all.refused.size(); ++i) {
        all.refusedHere[i] += link.refusedHere[i];
        all.refused[i] += link.refused[i];
    }
    all.stands += journal_ ? journal_->stands() : 0;
    return all;
}

bool Session::reachAgreement(lockstep::Verdict verdict, lockstep::Arrival mine) {
    for (bool again = false; verdict != lockstep::Verdict::equal; again = true) {
        if (verdict == lockstep::Verdict::nonsense) {
            reportNonsense();
            return false;
        }
        summary_.divergences += again ? 0 : 1;
        if (verdict == lockstep::Verdict::otherView) {
            reportOtherViews();
            return false;
        }
        if (!healSand(again)) {
            return false;
        }
        hash_ = mine.stateHash = terrain_.stateHash();
        verdict = barrier_.meet(mine, nextFrame());
    }
    if (!strayLine_.empty()) {
        host::printLine("{}", std::exchange(strayLine_, {}));
    }
    return true;
}

bool Session::healSand(bool again) {
    lockstep::Divergence divergence = *lockstep::findDivergence(barrier_, terrain_, [this] { return sandOfJournal(); });
    const std::vector<int> odd = ranksOf(divergence);
    emitDivergence({frame_, terrain_.stepNumber(), divergence}, static_cast<int>(names_.size()), writtenJournal());
    std::vector<std::string> lines =
        describeDivergence({frame_, terrain_.stepNumber(), divergence}, names_, writtenJournal());
    const std::optional<int> broken = again && !odd.empty() ? odd.front() : brokenAmong(odd);
    lockstep::Remedy remedy{!broken, divergence.source, odd};
    if (broken) {
        rankStatistics_.addOdd(odd);
        lines.push_back(giveUp(*broken, again));
    } else {
        const std::string& from = divergence.journal ? "the journal" : names_[static_cast<std::size_t>(remedy.source)];
        rankStatistics_.addHealed(odd);
        summary_.healed += odd.size();
        for (const int rank : odd) {
            const auto index = static_cast<std::size_t>(rank);
            const auto healed = rankStatistics_.ranks()[index].healed;
            lines.push_back(fmt::format("frame {}: {} takes the sand of {}; healed {} of at most {} times", frame_,
                                        names_[index], from, healed, kMostHealings));
            host::emitEvent("healed", {{"frame", frame_},
                                       {"rank", rank},
                                       {"source", divergence.journal ? "journal" : "rank"},
                                       {"source_rank", divergence.journal ? -1 : remedy.source},
                                       {"times", healed}});
        }
    }
    tell(lines, options_.out / "divergence.txt");
    if (!broken && divergence.journal) {
        // No rank has it: it goes to the others from here.
        terrain_.decodeState(divergence.journal->encodeState());
        remedy.source = lockstep::kMaster;
        std::erase(remedy.odd, lockstep::kMaster);
    }
    const lockstep::Healing healing = lockstep::heal(barrier_, terrain_, remedy);
    if (std::find(odd.begin(), odd.end(), lockstep::kMaster) != odd.end()) {
        // It was not the recording that strayed; unless it does so still.
        strayed_ = false;
        strayLine_.clear();
        compareWithRecording();
    }
    return healing != lockstep::Healing::ended;
}

std::filesystem::path Session::writtenJournal() const {
    // What lies in the folder of a session that writes none is another's, or ends too early.
    return journal_ && journal_->written() ? options_.out / "session.journal" : std::filesystem::path();
}

std::unique_ptr<sand::Replica> Session::sandOfJournal() {
    const std::filesystem::path journal = writtenJournal();
    if (journal.empty()) {
        return nullptr;
    }
    const lockstep::Busy busy(barrier_, "the sand of its journal");
    std::unique_ptr<sand::Replica> sand;
    try {
        sand = std::make_unique<sand::Replica>(restoreSand(journal, terrain_.stepNumber(), options_.sweeps).terrain);
    } catch (const std::exception& error) {  // the ranks wait for an answer, whatever it is
        host::printLine("{}", error.what());
    }
    return sand;
}

std::optional<int> Session::brokenAmong(const std::vector<int>& odd) const {
    for (const int rank : odd) {
        if (rankStatistics_.ranks()[static_cast<std::size_t>(rank)].healed >= kMostHealings) {
            return rank;
        }
    }
    return std::nullopt;
}

std::string Session::giveUp(int rank, bool again) {
    std::string line =
        fmt::format("frame {}: {} {} and is given up as broken; the session ends, and its journal holds every step",
                    frame_, names_[static_cast<std::size_t>(rank)],
                    again ? "holds other sand still, after it was healed," : "needs to be healed a third time");
    (void)writeFailure(failureOf("broken", rank, line), options_.out);
    return line;
}

FailureReport Session::failureOf(const std::string& what, int rank, const std::string& line) const {
    if (rank < 0) {
        return {what, rank, "", "", line};
    }
    const auto index = static_cast<std::size_t>(rank);
    return {what, rank, cluster_.hosts()[index].name, rank == lockstep::kMaster ? "" : wall_.tiles[index - 1].name,
            line};
}

void Session::reportOtherViews() {
    std::vector<int> odd;
    for (std::size_t rank = 1; rank < names_.size(); ++rank) {
        if (barrier_.arrivals()[rank].viewHash != barrier_.arrivals()[lockstep::kMaster].viewHash) {
            odd.push_back(static_cast<int>(rank));
        }
    }
    rankStatistics_.addOdd(odd);
    host::emitEvent("view_divergence", {{"frame", frame_}, {"rank", odd.front()}});
    const std::vector<std::string> lines = lockstep::describeOtherViews(barrier_.arrivals(), names_);
    tell(lines, options_.out / "divergence.txt");
    (void)writeFailure(failureOf("broken", odd.front(), lines.front()), options_.out);
}

void Session::reportNonsense() {
    std::vector<int> odd;
    for (const lockstep::FrameBarrier::Nonsense& one : barrier_.nonsense()) {
        odd.push_back(one.rank);
        host::printLine("{}; it is given up as broken, and the session ends", one.line);
    }
    rankStatistics_.addOdd(odd);
    (void)writeFailure(failureOf("broken", odd.front(), barrier_.nonsense().front().line), options_.out);
}

void Session::startDrills() {
    for (const lockstep::Fault& fault : beginDrills(options_.drills, frame_, options_.out)) {
        liveSteps_.drill(fault);
    }
}

}  // namespace master
