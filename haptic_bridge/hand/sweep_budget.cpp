// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/hand/sweep_budget.hpp"

#include <algorithm>

namespace haptic_bridge {
namespace {

constexpr double kMostGrowth = 2;

/// Returns the area of sand that moves after a drag, in areas of the tool.
double areaOf(std::int64_t substeps, const sand::Tool& tool) {
    const double across = std::max(2.0 * tool.radius / sand::kProbePerCell, 1.0);                 // [cell]
    const double farther = static_cast<double>(sand::substepOnGrid(tool)) / sand::kProbePerCell;  // [cell], a sub-step
    return 1 + static_cast<double>(substeps) * farther / across;
}

}  // namespace

void SweepBudget::shown(const FrameCost& cost, std::uint64_t step) {
    drawNs_ = cost.drawNs;
    if (cost.phases > 0) {
        phaseNs_ = static_cast<double>(cost.phaseNs) / static_cast<double>(cost.phases);
    }
    if (cost.sweeps > 0 || cost.substeps > 0) {
        hashNs_ = cost.hashNs;
    }
    if (cost.sweeps > 0) {
        const double now = static_cast<double>(cost.sweepNs) / static_cast<double>(cost.sweeps);
        growth_ = sweepNs_ > 0 ? std::clamp(now / sweepNs_, 1.0, kMostGrowth) : 1;
        sweepNs_ = now;
        substeps_ = cost.substeps;
    }
    if (cost.substeps > 0) {
        substepNs_ = static_cast<double>(cost.dragNs) / static_cast<double>(cost.substeps);
    }
    if (step >= since_ && part_ > 0) {
        part_ = std::max(part_, 2 * cost.sweeps);
    }
}

std::int64_t SweepBudget::budgetNs() const {
    const std::int64_t rest = std::max(kFrameNs - drawNs_, kLeastNs);
    return std::min({std::max(periodNs_, drawNs_) / 2, kMostNs, rest});
}

void SweepBudget::begin(std::int64_t part, std::uint64_t step) {
    part_ = part;
    since_ = step;
}

std::int64_t SweepBudget::whenAllMoves(const sand::Replica& replica) const {
    return std::clamp<std::int64_t>(budgetNs() / (kCellNs * replica.surface().sweepCost()), 1, kFastPart);
}

std::int32_t SweepBudget::sweepsOf(const sand::Step& step, const sand::Replica& replica) {
    const std::int32_t most = replica.mostSweeps(step);
    if (most == 0 || pace_ == Pace::fast) {
        return std::min(most, kFastPart);
    }
    if (step.edit.any() || part_ == 0) {
        begin(whenAllMoves(replica), step.number);
    }
    if (!step.edit.any() && step.engaged && !replica.engaged()) {
        // Sand at rest moves at the tool alone. The costs of other sand say nothing about it.
        begin(replica.settled() ? kFastPart : std::min<std::int64_t>(part_, kFastPart), step.number);
    }
    double sweeps = static_cast<double>(std::min<std::int64_t>(part_, most));
    if (sweepNs_ > 0) {
        const double budget = static_cast<double>(budgetNs());
        const std::int64_t substeps =
            sand::substepsOf(step, replica.probe(), replica.engaged(), replica.rules().substepLength());
        const double phase = replica.hasCoarsePhase(step) ? phaseNs_ : 0;
        const double others = static_cast<double>(hashNs_) + substepNs_ * static_cast<double>(substeps) + phase;
        // If the rest takes the whole budget, a quarter of it is still left for sweeps, or they would stop.
        sweeps = std::min(sweeps, sweepsIn(std::max(budget - others, budget / 4), substeps, replica.tool()));
    }
    return std::max(static_cast<std::int32_t>(sweeps), 1);
}

double SweepBudget::widened(std::int64_t substeps, const sand::Tool& tool) const {
    return std::max(areaOf(substeps, tool) / areaOf(substeps_, tool), 1.0);
}

double SweepBudget::sweepsIn(double ns, std::int64_t substeps, const sand::Tool& tool) const {
    const double fit = ns / (sweepNs_ * widened(substeps, tool));
    return std::min(fit, std::max(fit / growth_, double{kFastPart}));
}

bool holdsHand(const sand::Replica& replica, Pace pace) {
    return replica.holdsTool() && (pace == Pace::fast || replica.engaged());
}

SubstepLimit SweepBudget::substeps(const sand::Replica& replica) const {
    SubstepLimit limit{.most = replica.rules().mostSubsteps(),
                       .length = replica.rules().substepLength(),
                       .onlyHovering = replica.holdsTool()};
    if (pace_ == Pace::realtime && substepNs_ > 0) {
        const auto budget = static_cast<double>(budgetNs());
        const double phase = replica.rules().sweepPlan().hasCoarsePhase() ? phaseNs_ : 0;
        const double fit = std::max(budget - phase, budget / 4) / substepNs_;
        limit.wanted = static_cast<std::int64_t>(std::clamp(fit, 1.0, static_cast<double>(limit.most)));
    }
    return limit;
}

bool SweepBudget::fits(const sand::StepWork& taken, const sand::StepWork& further, const sand::Tool& tool) const {
    sand::StepWork all = taken;
    all += further;
    const double growth = further.sweeps >= kFastPart ? growth_ : 1;
    const double sweepsNs = sweepNs_ * static_cast<double>(all.sweeps) * widened(all.substeps, tool) * growth;
    const double othersNs = substepNs_ * static_cast<double>(all.substeps) +
                            phaseNs_ * static_cast<double>(all.phases) + static_cast<double>(hashNs_);
    return pace_ == Pace::fast || sweepsNs + othersNs <= static_cast<double>(budgetNs());
}

}  // namespace haptic_bridge
