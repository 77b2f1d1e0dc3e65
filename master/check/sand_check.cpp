// SPDX-License-Identifier: Apache-2.0
#include "master/check/sand_check.hpp"

#include <utility>

#include "host/print_line.hpp"

namespace master {
namespace {

// The launcher kills a session 120 s after it was asked to stop, and pictures take time, too.
constexpr std::int64_t kLongestWaitNs = 90'000'000'000;

}  // namespace

SandCheck::SandCheck(const walls::Wall& wall, const RankLabels& labels, const std::filesystem::path& out, Parts parts)
    : counted_(parts.counted),
      ranks_(parts.barrier),
      viewProof_(wall.encode()),
      agreement_(ranks_, labels, out, counted_, parts.statistics, std::move(parts.witness)),
      compared_(parts.tiles, parts.firstDifference),
      journal_(std::move(parts.record), out, counted_),
      tiles_(parts.tiles) {}

void SandCheck::applied(std::uint64_t step) {
    if (auto right = journal_.rightSand(step)) {
        agreement_.overrule(std::move(right));
    }
}

bool SandCheck::agree(const lockstep::FrameMessage& frame, const lockstep::Arrival& mine, MasterSand& sand,
                      StepSource& steps, std::int64_t next) {
    const std::uint64_t before = counted_.divergences;
    const bool agreed = agreement_.reach(mine, sand, steps, next);
    const bool differed = counted_.divergences != before;
    if (differed) {
        compared_.differed(frame.frame);
    }
    if (agreed) {
        // Ranks that differed have hashed the whole sand again.
        compared_.agreed(frame.frame, differed ? tiles_ : frame.auditTiles);
    }
    agreedToEnd_ = agreed && frame.stop;
    return agreed;
}

void SandCheck::serverDiffered(std::uint64_t frame) {
    ++counted_.serverDivergences;
    compared_.differed(frame);
}

void SandCheck::shown(std::uint64_t frame, const journal::JournalEnd& sand) {
    if (journal_.taking()) {
        journal_.taken(frame, sand);
    }
    // Begins before it looks, so that a confirmation in this frame does not cover a newer decision.
    const auto decided = agreement_.takeDecision();
    if (decided) {
        journal_.begin(frame, *decided);
    }
    journal_.look(frame, sand);
    if (!decided && !journal_.pending()) {
        agreement_.confirmed();
    }
}

bool SandCheck::mayEnd(std::int64_t nowNs, std::uint64_t step) {
    if (journal_.pending() && endsSince_ == 0) {
        endsSince_ = nowNs;
        host::printLine("the session ends when its journal has been replayed; the replay is at step {} of {}",
                        journal_.step(), step);
    }
    return !journal_.pending() || nowNs - endsSince_ > kLongestWaitNs;
}

void SandCheck::fill(Summary& summary) const {
    summary.unhealed = agreement_.unhealed();
    summary.compared.atEnd = agreedToEnd_;
    summary.compared.lastWhole = compared_.lastWhole();
}

}  // namespace master
