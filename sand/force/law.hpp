// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/force/contact_force.hpp"
#include "sand/force/control_points.hpp"

/// The scene's law in two parts, so that the model between two surfaces can work between them.
namespace sand::force {

[[nodiscard]] inline Gauges measure(const ForceConstants& constants, const SurfacePatch& patch, const Contour& tool,
                                    Vec3 place /* [scene unit] */) {
    return constants.law == ForceLaw::repulse ? measureContact(patch, place, tool).gauges()
                                              : measureControlPoints(constants, patch, tool, place);
}
[[nodiscard]] inline Response respond(const ForceConstants& constants, const Contour& tool, const Gauges& gauges) {
    return constants.law == ForceLaw::repulse ? contactForce(constants, tool, Contact(gauges))
                                              : controlPointsForce(constants, tool, gauges);
}
/// Returns the exact response of the law on one surface, for callers that need it once per step.
[[nodiscard]] inline Response respond(const ForceConstants& constants, const SurfacePatch& patch, const Contour& tool,
                                      Vec3 place) {
    return respond(constants, tool, measure(constants, patch, tool, place));
}

}  // namespace sand::force
