// SPDX-License-Identifier: Apache-2.0
#include "master/steps/master_sand.hpp"

#include <algorithm>
#include <cmath>

#include "host/clock.hpp"
#include "lockstep/cluster.hpp"

namespace master {
namespace {

constexpr double kAuditSeconds = 1.0;

}  // namespace

MasterSand::MasterSand(sand::Replica replica, const std::vector<lockstep::Fault>& faults, std::uint64_t edits)
    : replica_(std::move(replica)), faults_(faults, lockstep::kMaster), edits_(edits) {
    if (replica_.settling()) {
        settlingSince_ = 0;
    }
    rehash();
}

void MasterSand::apply(std::uint64_t frame, const ArrivedSteps& steps, std::uint32_t auditTiles, StepSource& source) {
    faults_.strike(frame, replica_);
    source.reached(replica_);
    work_ = {};
    time_ = {};
    endedSettles_.clear();
    for (const ArrivedStep& timed : steps) {
        const bool begins = replica_.settlesBySweeps(timed.step);
        if (history_) {
            history_->begin(replica_, timed.step, timed.intent, timed.material);
        }
        time_ += lockstep::applyTimed(replica_, timed.step);
        if (history_) {
            history_->end(replica_);
        }
        noteSettle(timed.step, begins);
        work_ += replica_.lastWork();
        if (!replica_.leftOut().empty()) {
            leftOut_.push_back({timed.step.number, replica_.leftOut(), replica_.refusedStep()});
        }
        edits_ += timed.step.edit.any() ? 1 : 0;
        if (replica_.refusedPress() && stepsUnplaced_++ == 0) {
            firstStepUnplaced_ = timed.step.number;
        }
        source.reached(replica_);
    }
    const std::int64_t applied = host::monotonicNs();
    replica_.audit(static_cast<int>(auditTiles));
    rehash();
    time_.hashNs = host::monotonicNs() - applied;
}

void MasterSand::noteSettle(const sand::Step& step, bool begins) {
    if (replica_.refusedStep()) {
        return;
    }
    // A settle at once whose step has not finished it continues by sweeps.
    if (begins || (step.edit.kind == sand::Edit::settle && replica_.settling())) {
        if (settlingSince_) {
            endedSettles_.push_back({*settlingSince_, SettleEnd::edit});
        }
        settlingSince_ = step.number;
    }
    if (settlingSince_ && !replica_.settling()) {
        const SettleEnd otherwise = step.edit.any() ? SettleEnd::edit : SettleEnd::hand;
        endedSettles_.push_back({*settlingSince_, replica_.settleCameToRest() ? SettleEnd::rest : otherwise});
        settlingSince_.reset();
    }
}

std::optional<SettleEnd> MasterSand::endOfSettle(std::uint64_t begun) const {
    const auto ended = std::ranges::find(endedSettles_, begun, &EndedSettle::begun);
    return ended == endedSettles_.end() ? std::nullopt : std::optional(ended->by);
}

std::uint32_t MasterSand::auditTiles(double sinceSwap) const {
    const int tiles = replica_.hashTiles().tileCount();
    const auto due = static_cast<int>(std::ceil(tiles * sinceSwap / kAuditSeconds));
    return static_cast<std::uint32_t>(std::clamp(due, (tiles + 63) / 64, tiles));
}

}  // namespace master
