// SPDX-License-Identifier: Apache-2.0
#include "scene/load/step_cost.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "host/clock.hpp"
#include "sand/replica.hpp"

namespace scene {
namespace {

constexpr int kMostCells = 512;     // [cell], along a side of the part
constexpr double kSeconds = 0.2;    // [s], of the measurement
constexpr std::int32_t kPart = 16;  // [sweep], between two looks at the clock

double secondsSince(std::int64_t then) { return static_cast<double>(host::monotonicNs() - then) * 1e-9; }

/// Digs through the middle of the part.
class Digger {
public:
    explicit Digger(const sand::Start& part) : replica_(part) {}

    /// Applies a part of a step.
    void dig() {
        sand::Step step;
        step.number = replica_.stepNumber() + 1;
        step.engaged = true;
        if (!replica_.holdsTool()) {
            step.path = {next()};
            ++begun_;
        }
        step.sweeps = std::min(replica_.mostSweeps(step), kPart);
        const std::int64_t began = host::monotonicNs();
        std::int64_t moved = began;
        replica_.apply(step, [&moved] { moved = host::monotonicNs(); });
        const std::int64_t ended = host::monotonicNs();
        dragNs_ += moved - began;
        sweepNs_ += ended - moved;
        sweeps_ += replica_.lastWork().sweeps;
        if (!replica_.holdsTool()) {
            endedNs_ = dragNs_ + sweepNs_;
            whole_ = begun_;
        }
    }
    /// Returns the mean of the steps that have run whole. If there is none, the sweeps of the first one are scaled up.
    [[nodiscard]] double secondsOfAStep(std::int32_t sweepsPerStep) const {
        if (whole_ > 0) {
            return static_cast<double>(endedNs_) * 1e-9 / static_cast<double>(whole_);
        }
        const double perSweep = static_cast<double>(sweepNs_) / static_cast<double>(std::max<std::int64_t>(sweeps_, 1));
        return (static_cast<double>(dragNs_) + perSweep * sweepsPerStep) * 1e-9;
    }

private:
    [[nodiscard]] sand::ProbePoint next() {
        if (begun_ == 0) {
            const sand::ProbePoint middle = digPlace(replica_.rules(), 0, 0);
            level_ = static_cast<std::int32_t>(replica_.surface().height(middle.x, middle.y) / sand::kUnitsPerCell *
                                               sand::kProbePerCell);
        }
        return digPlace(replica_.rules(), begun_, level_);
    }

    sand::Replica replica_;
    std::int32_t level_ = 0;  // [probe unit], of the sand in the middle
    std::int64_t begun_ = 0, whole_ = 0, sweeps_ = 0;
    std::int64_t dragNs_ = 0, sweepNs_ = 0, endedNs_ = 0;  // the last one: of the steps that have run whole
};

}  // namespace

sand::ProbePoint digPlace(const sand::Rules& rules, std::int64_t step, std::int32_t level) {
    constexpr int kWay = 16;  // [cell], to one side
    const int at = static_cast<int>(step % (2 * kWay));
    const std::int32_t x =
        rules.columns * sand::kProbePerCell / 2 + (at < kWay ? at : 2 * kWay - at) * sand::kProbePerCell;
    return {x, rules.rows * sand::kProbePerCell / 2, level + rules.tuning.tool.radius / 2};
}

std::optional<StepCost> stepCostOf(const Scene& scene) {
    const std::optional<sand::Start> part = scene.middle(kMostCells);
    if (!part || scene.rules.tuning.tool.radius == 0) {
        return std::nullopt;
    }
    Digger digger(*part);
    StepCost cost{.columns = part->rules.columns, .rows = part->rules.rows};
    for (const std::int64_t began = host::monotonicNs(); cost.measured < kSeconds;
         cost.measured = secondsSince(began)) {
        digger.dig();
    }
    // A tool that is larger than the part moves more cells on the whole field.
    const auto moved = [&](int cells) {
        return static_cast<double>(std::min(cells, 2 * scene.rules.tuning.tool.radius / sand::kProbePerCell));
    };
    const double more = std::max(1.0, moved(scene.rules.columns) / part->rules.columns) *
                        std::max(1.0, moved(scene.rules.rows) / part->rules.rows);
    cost.seconds = digger.secondsOfAStep(scene.rules.tuning.sweepsPerStep) * more;
    return cost;
}

std::string StepCost::text(const Scene& scene) const {
    const double ms = seconds * 1e3;
    return fmt::format(
        "a step in which the tool digs takes ≈ {} ms of one core for {} sweeps at most; it was measured for {:.1f} s "
        "on {} x {} cells",
        ms < 10 ? fmt::format("{:.2g}", ms) : fmt::format("{:.0f}", ms), scene.rules.tuning.sweepsPerStep, measured,
        columns, rows);
}

}  // namespace scene
