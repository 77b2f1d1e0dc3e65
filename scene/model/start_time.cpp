// SPDX-License-Identifier: Apache-2.0
#include "scene/model/start_time.hpp"

#include <fmt/format.h>

namespace scene {

StartTime StartTime::of(const SandSize& sand) {
    // [s] for a million cells, and for the programs. docs/figures.md has them ("The start of a large field").
    constexpr double kRead = 0.05, kReplica = 0.03, kDrawing = 0.015, kPrograms = 1;
    const double cells = 1e-6 * sand.field.columns * sand.field.rows;
    return {sand.rasterBytes > 0 ? kRead * cells : 0, kReplica * cells, kDrawing * cells, kPrograms};
}

std::string StartTime::text() const {
    return fmt::format(
        "the start takes ≈ {:.1f} s, an estimate: {:.1f} to read the terrain, {:.1f} for the replicas, {:.1f} for the "
        "first frame, and {:.0f} for the programs",
        sum(), read, replica, drawing, programs);
}

}  // namespace scene
