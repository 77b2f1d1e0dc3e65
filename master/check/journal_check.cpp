// SPDX-License-Identifier: Apache-2.0
#include "master/check/journal_check.hpp"

#include <fmt/format.h>

#include <limits>
#include <thread>
#include <utility>

#include "host/event.hpp"
#include "master/check/disagreement.hpp"

namespace master {

JournalCheck::JournalCheck(Record record, std::filesystem::path out, Incidents& incidents)
    : record_(std::move(record)), out_(std::move(out)), incidents_(incidents) {}

void JournalCheck::begin(std::uint64_t frame, const Decision& decision) {
    const journal::JournalEnd& sand = decision.sand;
    if (record_.journal().empty()) {
        return;
    }
    record_.doubt({frame, sand});
    if (wrong_) {
        return;  // the ranks take the journal's sand soon, whatever they decide now
    }
    majority_ = {frame, sand};
    movement_ = decision.movement;
    if (replay_) {
        replay_->continueTo(sand.step);  // if the sand is right now, it was right at the decision before
        return;
    }
    tries_ = 0;
    doubt_.clear();  // if this sand is confirmed, so are all decisions before
    start();
    report(frame, "begun", sand.hash,
           fmt::format("frame {}: the journal is replayed to step {}, to confirm the majority", frame, sand.step));
}

void JournalCheck::start() {
    ++tries_;
    const std::uint64_t step = majority_.sand.step;
    replay_ = std::make_unique<BackgroundReplay>(record_.journal(), step, newestCheckpointFor(step));
}

std::unique_ptr<sand::Replica> JournalCheck::rightSand(std::uint64_t step) {
    if (!replay_ || !wrong_) {
        return nullptr;
    }
    const BackgroundReplay::Progress progress = replay_->progress();
    if (!progress.proven) {
        return nullptr;
    }
    if (progress.step == step) {
        taking_ = true;
        auto sand = replay_->take();
        replay_.reset();
        return sand;
    }
    // The wall waits if the rest is short, or if the replay is not faster than the wall.
    const std::uint64_t way = step - progress.step;
    holds_ = holds_ || way <= kShortWay || 2 * way > way_;
    way_ = way;
    replay_->continueTo(step);
    return nullptr;
}

void JournalCheck::look(std::uint64_t frame, const journal::JournalEnd& shown) {
    if (!replay_) {
        return;
    }
    const BackgroundReplay::Progress progress = replay_->progress();
    if (!progress.error.empty()) {
        fail(frame, progress.error);
    } else if (progress.proven && !wrong_) {
        compare(frame, *progress.proven, shown);
    }
}

void JournalCheck::compare(std::uint64_t frame, const BackgroundReplay::Proven& replayed,
                           const journal::JournalEnd& shown) {
    const std::uint64_t hash = rightHash_ = replayed.hash;
    const bool sameSand = hash == majority_.sand.hash;
    if (sameSand && replayed.movement == movement_) {
        replay_.reset();
        record_.checked({frame, shown, false});
        report(frame, "agreed", hash,
               fmt::format("frame {}: the journal confirms the majority of frame {}", frame, majority_.frame));
        return;
    }
    wrong_ = true;
    way_ = std::numeric_limits<std::uint64_t>::max();
    const std::string what =
        sameSand ? fmt::format("after step {} it had other steps in which its sand moved last", majority_.sand.step)
                 : fmt::format("after step {} it had {:016x}, the journal has {:016x}", majority_.sand.step,
                               majority_.sand.hash, hash);
    report(frame, "disagreed", hash,
           fmt::format("frame {}: the majority of frame {} was wrong: {}; all ranks will take the sand of the journal",
                       frame, majority_.frame, what));
}

void JournalCheck::taken(std::uint64_t frame, const journal::JournalEnd& shown) {
    ++incidents_.outvoted;
    wrong_ = holds_ = taking_ = false;
    record_.checked({frame, shown, true});
    report(frame, "outvoted", rightHash_,
           fmt::format("frame {}: all ranks have the sand of the journal, which has outvoted the majority of frame {}",
                       frame, majority_.frame));
}

void JournalCheck::finish(std::uint64_t frame, const journal::JournalEnd& shown, std::chrono::milliseconds patience) {
    constexpr std::chrono::milliseconds kPause{5};
    for (std::chrono::milliseconds left = patience; replay_ && !wrong_ && left.count() > 0; left -= kPause) {
        std::this_thread::sleep_for(kPause);
        look(frame, shown);
    }
    if (pending()) {
        doubt_ = wrong_ || taking_ ? "the replay has other sand, which the ranks could not take any more"
                                   : "the replay of its journal was not done in time";
    }
    replay_.reset();
    wrong_ = holds_ = taking_ = false;
}

void JournalCheck::reportResumed(const Outvoted& outvoted) {
    ++incidents_.outvoted;
    majority_ = outvoted.majority;
    report(majority_.frame, "outvoted", outvoted.rightHash,
           fmt::format("the majority of frame {} was wrong: after step {} it had {:016x}, the journal has {:016x}; the "
                       "session continues with the sand of the journal",
                       majority_.frame, majority_.sand.step, majority_.sand.hash, outvoted.rightHash));
}

void JournalCheck::fail(std::uint64_t frame, const std::string& error) {
    wrong_ = holds_ = false;
    if (tries_ < kTries) {
        start();
        return;
    }
    replay_.reset();
    doubt_ = "its journal could not be replayed: " + error;
    report(frame, "failed", 0,
           fmt::format("frame {}: the journal cannot be replayed, so the majority of frame {} is not confirmed: {}",
                       frame, majority_.frame, error));
}

void JournalCheck::report(std::uint64_t frame, const char* state, std::uint64_t rightHash,
                          const std::string& line) const {
    host::emitEvent("journal_check", {{"state", state},
                                      {"frame", frame},
                                      {"majority_frame", majority_.frame},
                                      {"majority_step", majority_.sand.step},
                                      {"majority_hash", fmt::format("{:016x}", majority_.sand.hash)},
                                      {"journal_hash", fmt::format("{:016x}", rightHash)}});
    master::report({line}, out_ / "divergence.txt");
}

}  // namespace master
