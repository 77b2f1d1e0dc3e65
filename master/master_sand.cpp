// SPDX-License-Identifier: Apache-2.0
#include "master/master_sand.hpp"

#include <algorithm>
#include <cmath>

#include "host/clock.hpp"
#include "lockstep/cluster.hpp"

namespace master {
namespace {

constexpr double kAuditSeconds = 1.0;

}  // namespace

MasterSand::MasterSand(const sand::Start& start, const base::Executor* executor,
                       const std::vector<lockstep::Fault>& faults, std::span<const std::uint8_t> state,
                       std::uint64_t edits)
    : replica_(start, executor), faults_(faults, lockstep::kMaster), edits_(edits) {
    if (!state.empty()) {
        replica_.decodeState(state);
    }
    rehash();
}

void MasterSand::apply(std::uint64_t frame, const std::vector<haptic_bridge::TimedStep>& steps,
                       std::uint32_t auditTiles, StepSource& source) {
    faults_.strike(frame, replica_);
    source.reached(replica_);
    work_ = {};
    time_ = {};
    settleEnd_.reset();
    for (const haptic_bridge::TimedStep& timed : steps) {
        const bool settling = replica_.settling();
        time_ += lockstep::applyTimed(replica_, timed.step);
        if (settling && !replica_.settling()) {
            settleEnd_ = timed.step.edit.any()          ? SettleEnd::edit
                         : replica_.surface().settled() ? SettleEnd::rest
                                                        : SettleEnd::hand;
        }
        work_ += replica_.lastWork();
        if (!replica_.leftOut().empty()) {
            leftOut_.push_back({timed.step.number, replica_.leftOut(), replica_.refusedStep()});
        }
        edits_ += timed.step.edit.any() ? 1 : 0;
        stepsUnplaced_ += replica_.refusedPress() ? 1 : 0;
        source.reached(replica_);
    }
    const std::int64_t applied = host::monotonicNs();
    replica_.audit(static_cast<int>(auditTiles));
    rehash();
    time_.hashNs = host::monotonicNs() - applied;
}

std::uint32_t MasterSand::auditTiles(double sinceSwap) const {
    const int tiles = replica_.hashTiles().tileCount();
    const auto due = static_cast<int>(std::ceil(tiles * sinceSwap / kAuditSeconds));
    return static_cast<std::uint32_t>(std::clamp(due, (tiles + 63) / 64, tiles));
}

}  // namespace master
