// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

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
};

/// Returns where the tool is in step `step` of the measurement, 0 or more. It moves to and fro by a cell a step,
/// between the middle of the field and 16 cells east of it. It is half a radius deep in sand of the height `level`
/// [probe unit].
[[nodiscard]] sand::ProbePoint digPlace(const sand::Rules& rules, std::int64_t step, std::int32_t level);

/// Digs for a short time in the middle of the field, in at most 512 x 512 cells of it, and extrapolates to all sweeps
/// of a step. Returns nullopt for a TIN, whose steps are not measured in parts. Needs memory for a replica of these
/// cells.
[[nodiscard]] std::optional<StepCost> stepCostOf(const Scene& scene);

}  // namespace scene
