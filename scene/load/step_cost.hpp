// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "sand/model/probe_point.hpp"
#include "scene/model/scene.hpp"

namespace scene {

/// Estimate of a step in which the scene's tool digs in its field.
struct StepCost {
    double seconds = 0;         // [s], of one thread of this machine
    double measured = 0;        // [s], for which steps were measured
    int columns = 0, rows = 0;  // [cell], of the part of the field on which they were measured

    /// Returns one line for the user. The times have a mark, because they are no promise.
    [[nodiscard]] std::string text(const Scene& scene) const;
    /// Returns one line for the user if a step holds a frame for longer than LargestTools::kLongFrame, or an empty
    /// text. `file` names the scene.
    [[nodiscard]] std::string longFrameText(const std::string& file) const;
};

/// Largest radii of the scene's tool at which a step of digging is fast enough, of one thread of this machine.
struct LargestTools {
    static constexpr double kLongFrame = 0.25;  // [s], a step that takes longer can hold a frame for as long

    /// Largest radius at which a step takes at most half of the time between two steps. The other half is for drawing.
    double following = 0;  // [cell]
    double fitting = 0;    // [cell], largest radius at which a step takes at most kLongFrame
    /// Largest tried radius below `following` at which a step takes longer than that [cell]. It is 0 if every smaller
    /// tool is as fast. A tool of 16 cells has no coarse phase, so that its step can take longer than that of a larger
    /// tool.
    double slower = 0;
    double tried = 0;  // [cell], largest radius that was tried; the two numbers are not above it

    /// Returns one line for the user.
    [[nodiscard]] std::string text(const Scene& scene) const;
};

/// Returns where the tool is in step `step` of the measurement, 0 or more. It moves to and fro by a cell a step,
/// between the middle of the field and 16 cells east of it. It is half a radius deep in sand of the height `level`
/// [probe unit].
[[nodiscard]] sand::ProbePoint digPlace(const sand::Rules& rules, std::int64_t step, std::int32_t level);

/// Digs for a short time in the middle of the field, in at most 512 x 512 cells of it, and extrapolates to all sweeps
/// of a step. If the tool has more than 128 cells, digs with one of 128 cells, and extrapolates by the cells that move.
/// Returns nullopt for a TIN, whose steps are not measured in parts. Needs memory for a replica of these cells.
[[nodiscard]] std::optional<StepCost> stepCostOf(const Scene& scene);

/// Returns stepCostOf() if the tool is so large that what is not spread over steps may hold a frame; otherwise nullopt.
[[nodiscard]] std::optional<StepCost> costOfALargeTool(const Scene& scene);

/// Digs as stepCostOf() does, or in a whole TIN, with tools of the scene's kind whose radii double from 4 cells on, and
/// interpolates between them. Ends at a radius that takes too long, that is half the field, or whose first press does
/// not fit. Returns nullopt without a tool. Takes about a second, and a large TIN some seconds. Needs memory for a
/// replica of the part or of the TIN.
[[nodiscard]] std::optional<LargestTools> largestToolsOf(const Scene& scene);

/// Returns the largest tools of at least one radius and its time of a step.
[[nodiscard]] LargestTools largestOf(std::span<const std::pair<double, double>> measured /* [cell], [s] */,
                                     int stepsPerSecond);

/// Returns the largest radius at which a step takes `seconds`, between measured radii. Both grow as powers of each
/// other between two of them. Returns the largest radius if it takes less, and 0 if all take more.
[[nodiscard]] double radiusAt(double seconds, std::span<const std::pair<double, double>> measured /* [cell], [s] */);
/// Returns the largest measured radius below radiusAt() at which a step takes more than `seconds`. Returns 0 if each of
/// them takes less.
[[nodiscard]] double slowerBelow(double seconds, std::span<const std::pair<double, double>> measured);

}  // namespace scene
