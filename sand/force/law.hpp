// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/force/contact_force.hpp"
#include "sand/force/control_points.hpp"

/// The scene's law in two halves, so that what lies between two surfaces can come between them.
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
/// The law on one surface, exactly: for whoever asks once a step.
[[nodiscard]] inline Response respond(const ForceConstants& constants, const SurfacePatch& patch, const Contour& tool,
                                      Vec3 place) {
    return respond(constants, tool, measure(constants, patch, tool, place));
}

}  // namespace sand::force
