// SPDX-License-Identifier: Apache-2.0
#include "scene/load/step_cost.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <vector>

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
        replica_.apply(step, [&moved](sand::StepPart) { moved = host::monotonicNs(); });
        const std::int64_t ended = host::monotonicNs();
        dragNs_ += moved - began;
        sweepNs_ += ended - moved;
        sweeps_ += replica_.lastWork().sweeps;
        refused_ |= replica_.refusedPress();
        if (!replica_.holdsTool()) {
            endedNs_ = dragNs_ + sweepNs_;
            whole_ = begun_;
        }
    }
    /// Digs for a time. Returns how long it took [s].
    double digFor(double seconds) {
        const std::int64_t began = host::monotonicNs();
        do {
            dig();
        } while (secondsSince(began) < seconds);
        return secondsSince(began);
    }
    [[nodiscard]] bool wasRefused() const { return refused_; }
    /// Returns the mean of the steps that have run whole. While the first step still runs, scales up its sweeps.
    [[nodiscard]] double secondsOfAStep(std::int32_t sweeps) const {
        if (whole_ > 0) {
            return static_cast<double>(endedNs_) * 1e-9 / static_cast<double>(whole_);
        }
        const double perSweep = static_cast<double>(sweepNs_) / static_cast<double>(std::max<std::int64_t>(sweeps_, 1));
        return (static_cast<double>(dragNs_) + perSweep * sweeps) * 1e-9;
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
    bool refused_ = false;    // whether a press did not fit
    std::int64_t begun_ = 0, whole_ = 0, sweeps_ = 0;
    std::int64_t dragNs_ = 0, sweepNs_ = 0, endedNs_ = 0;  // the last one: of the steps that have run whole
};

/// Radius of the largest tool that is measured in a part of the field [cell]. A larger one would cover the part.
constexpr std::int32_t kLargestMeasured = kMostCells / 4;

/// Returns the tuning with which a tool of `tuning` is measured: that of a smaller tool if it is large.
sand::Tuning measuredAs(sand::Tuning tuning) {
    const std::int64_t radius = tuning.tool.radius, largest = std::int64_t{kLargestMeasured} * sand::kProbePerCell;
    if (radius > largest) {
        tuning.tool.halfWidth = static_cast<std::int32_t>(tuning.tool.halfWidth * largest / radius);
        tuning.tool.radius = static_cast<std::int32_t>(largest);
        const double smaller = static_cast<double>(largest) / static_cast<double>(radius);
        tuning.sweepsPerStep = std::max(static_cast<std::int32_t>(tuning.sweepsPerStep * smaller * smaller), 1);
    }
    return tuning;
}

/// Returns by how much more cells move on the whole field, with a tool of `radius`, than on the part, with its own tool
/// [ratio].
double moreOnTheField(const sand::Start& field, std::int32_t radius, const sand::Start& part) {
    // A coarse phase slides sand up to two radii from the tool.
    const std::int64_t radii = part.rules.sweepPlan().hasCoarsePhase() ? 4 : 2;
    const auto more = [&](int cells, int ofPart) {
        const std::int64_t moved = std::min<std::int64_t>(cells, radii * radius / sand::kProbePerCell);
        const std::int64_t measured =
            std::min<std::int64_t>(ofPart, radii * part.rules.tuning.tool.radius / sand::kProbePerCell);
        return std::max(1.0, static_cast<double>(moved) / static_cast<double>(measured));
    };
    return more(field.rules.columns, part.rules.columns) * more(field.rules.rows, part.rules.rows);
}

/// Returns how many radii come up to the largest at which a step takes at most `seconds`.
std::size_t lastWithin(double seconds, std::span<const std::pair<double, double>> measured) {
    std::size_t end = measured.size();
    while (end > 0 && measured[end - 1].second > seconds) {
        --end;
    }
    return end;
}

/// Returns two digits of a small number, and a large one in whole.
std::string shortText(double number) {
    return number < 10 ? fmt::format("{:.2g}", number) : fmt::format("{:.0f}", number);
}

}  // namespace

sand::ProbePoint digPlace(const sand::Rules& rules, std::int64_t step, std::int32_t level) {
    constexpr int kWay = 16;  // [cell], to one side
    const int at = static_cast<int>(step % (2 * kWay));
    const std::int32_t x =
        rules.columns * sand::kProbePerCell / 2 + (at < kWay ? at : 2 * kWay - at) * sand::kProbePerCell;
    return {x, rules.rows * sand::kProbePerCell / 2, level + rules.tuning.tool.radius / 2};
}

std::optional<StepCost> stepCostOf(const Scene& scene) {
    std::optional<sand::Start> part = scene.middle(kMostCells);
    const std::int32_t radius = scene.rules.tuning.tool.radius;
    if (!part || radius == 0) {
        return std::nullopt;
    }
    part->rules.tuning = measuredAs(scene.rules.tuning);
    Digger digger(*part);
    StepCost cost{.columns = part->rules.columns, .rows = part->rules.rows};
    cost.measured = digger.digFor(kSeconds);
    cost.seconds = digger.secondsOfAStep(part->rules.sweepPlan().moved) * moreOnTheField(scene, radius, *part);
    return cost;
}

std::string StepCost::text(const Scene& scene) const {
    return fmt::format(
        "a step in which the tool digs takes ≈ {} ms of one core for {} sweeps at most; it was measured for {:.1f} s "
        "on {} x {} cells",
        shortText(seconds * 1e3), scene.rules.sweepPlan().moved, measured, columns, rows);
}

std::string StepCost::longFrameText(const std::string& file) const {
    if (seconds <= LargestTools::kLongFrame) {
        return {};
    }
    return fmt::format(
        "{}: a step in which this tool digs takes ≈ {} s on this machine, and holds a frame for as long; "
        "sandwall-check "
        "--scene {} prints up to which radius a step takes at most {:.0f} ms",
        file, shortText(seconds), file, LargestTools::kLongFrame * 1e3);
}

std::optional<StepCost> costOfALargeTool(const Scene& scene) {
    // Movement and coarse phase are not spread over steps. With a smaller tool they have never taken a tenth of
    // kLongFrame.
    constexpr std::int32_t kLarge = 100;  // [cell]
    const bool large = scene.rules.tuning.tool.radius > kLarge * sand::kProbePerCell;
    return large && scene.rules.sweepPlan().hasCoarsePhase() ? stepCostOf(scene) : std::nullopt;
}

std::optional<LargestTools> largestToolsOf(const Scene& scene) {
    constexpr int kSmallest = 4;          // [cell]
    constexpr double kSecondsEach = 0.1;  // [s]
    constexpr double kSecondsInAll = 3;   // [s], after which no larger tool is tried
    if (scene.rules.tuning.tool.radius == 0) {
        return std::nullopt;
    }
    const std::int64_t began = host::monotonicNs();
    const std::optional<sand::Start> middle = scene.middle(kMostCells);
    sand::Start part = middle.value_or(scene);
    constexpr std::int32_t kLargest = sand::kLargestToolRadius / sand::kProbePerCell;  // [cell]
    const int largest = std::min({scene.rules.columns / 2, scene.rules.rows / 2, kLargest});
    std::vector<std::pair<double, double>> measured;
    for (int cells = kSmallest; cells <= largest; cells *= 2) {
        Material material = scene.material;
        material.toolRadius = cells * scene.grid().cellSize;
        const sand::Tuning tuning = tuningOf(material, scene.grid());
        part.rules.tuning = middle ? measuredAs(tuning) : tuning;
        Digger digger(part);
        (void)digger.digFor(kSecondsEach);
        if (digger.wasRefused()) {
            break;
        }
        const double more = moreOnTheField(scene, tuning.tool.radius, part);
        const double seconds = digger.secondsOfAStep(part.rules.sweepPlan().moved) * more;
        measured.emplace_back(cells, seconds);
        if (seconds > LargestTools::kLongFrame || secondsSince(began) > kSecondsInAll) {
            break;
        }
    }
    if (measured.empty()) {
        return std::nullopt;
    }
    return largestOf(measured, scene.rules.stepsPerSecond);
}

LargestTools largestOf(std::span<const std::pair<double, double>> measured, int stepsPerSecond) {
    const double half = 0.5 / stepsPerSecond;
    return {.following = radiusAt(half, measured),
            .fitting = radiusAt(LargestTools::kLongFrame, measured),
            .slower = slowerBelow(half, measured),
            .tried = measured.back().first};
}

double radiusAt(double seconds, std::span<const std::pair<double, double>> measured) {
    const auto end = lastWithin(seconds, measured);
    if (end == 0) {
        return 0;
    }
    const auto& [radius, time] = measured[end - 1];
    if (end == measured.size() || time <= 0) {
        return radius;
    }
    const auto& [larger, longer] = measured[end];
    return radius * std::pow(larger / radius, std::log(seconds / time) / std::log(longer / time));
}

double slowerBelow(double seconds, std::span<const std::pair<double, double>> measured) {
    double slower = 0;
    for (const auto& [radius, time] : measured.first(lastWithin(seconds, measured))) {
        slower = time > seconds ? radius : slower;
    }
    return slower;
}

std::string LargestTools::text(const Scene& scene) const {
    const auto upTo = [&](double cells) {
        if (cells == 0) {
            return std::string("at no radius of 4 cells or more");
        }
        const bool all = cells >= tried;
        return fmt::format("up to a radius of ≈ {} ({} cells{})", shortText(cells * scene.grid().cellSize),
                           shortText(cells), all ? ", the largest that was tried" : "");
    };
    const std::string except = slower > 0 ? fmt::format(", but not at {:.0f} cells", slower) : "";
    const bool holds = scene.rules.stepLimits().mostSweeps == 0 && fitting < tried;
    return fmt::format("this tool follows the hand {}{}; its step takes at most {:.0f} ms {}{}", upTo(following),
                       except, kLongFrame * 1e3, upTo(fitting),
                       holds ? ", and a larger one holds frames, because steps of a TIN are not spread" : "");
}

}  // namespace scene
