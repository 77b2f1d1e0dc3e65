// SPDX-License-Identifier: Apache-2.0
#include "sand/force/control_points.hpp"

#include <algorithm>
#include <cmath>

namespace sand::force {
namespace {

/// Limits the gradient to one that resting sand can have. A steeper gradient is that of the wall that the tool has cut
/// around its outline. That wall is a cell thick and moves with the tool.
Dual resting(Dual height) {
    constexpr double kSteepest = 1;
    const double slope = std::hypot(height.slope.x, height.slope.y);
    return slope > kSteepest ? Dual{height.value, (kSteepest / slope) * height.slope} : height;
}

/// The part of dh with which a control point acts, its derivative, and how much the point touches the sand, 0 to 1.
struct Pressed {
    double depth = 0, rate = 0, touch = 0;
};

Pressed pressed(const ForceConstants& constants, double dh) {
    const double tolerance = constants.tolerance;
    if (constants.literal) {
        return dh > -tolerance ? Pressed{dh, 1, 1} : Pressed{};
    }
    if (dh <= 0) {
        return {};
    }
    if (dh >= tolerance) {
        return {dh, 1, 1};
    }
    // t² (2 − t): value and slope are 0 at t = 0, and equal those of dh at t = 1.
    const double t = dh / tolerance;
    return {tolerance * t * t * (2 - t), t * (4 - 3 * t), t};
}

Vec3 outward(Vec3 point) {
    const double length = std::hypot(point.x, point.y);
    return length > 0 ? (1 / length) * Vec3{point.x, point.y, 0} : Vec3{};
}

}  // namespace

Gauges measureControlPoints(const ForceConstants& constants, const SurfacePatch& patch, const Contour& tool,
                            Vec3 place) {
    Gauges result;
    result.count = tool.points.size();
    const double inUnits = 1 / constants.unitLength;
    for (std::size_t i = 0; i < result.count; ++i) {
        const Vec3 at = place + tool.points[i];
        const Dual underside{at.z, {0, 0, 1}};
        const Vec3 beside = at + patch.cutBeyond() * outward(tool.points[i]);
        // A point beside the field is just out of touch, so that the next surface does not make the force jump.
        result.dials[i] = !patch.empty() && patch.overField(at.x, at.y)
                              ? inUnits * (resting(patch.tangent(beside.x, beside.y)) - underside)
                              : Dual{-constants.tolerance, {}};
    }
    return result;
}

Response controlPointsForce(const ForceConstants& constants, const Contour& tool, const Gauges& gauges) {
    Response felt;
    Dual x, y, z;
    double touch = 0, mostTouch = 0;
    for (std::size_t i = 0; i < gauges.count; ++i) {
        const Pressed point = pressed(constants, gauges.dials[i].value);
        if (point.touch == 0) {
            continue;
        }
        const Dual depth{point.depth, point.rate * gauges.dials[i].slope};
        const Vec3 direction = outward(tool.points[i]);
        x = x - direction.x * depth;
        y = y - direction.y * depth;
        z = z + depth;
        touch += point.touch;
        mostTouch = std::max(mostTouch, point.touch);
    }
    if (gauges.count == 0 || mostTouch == 0) {
        return felt;
    }
    const double each = constants.maxForce / static_cast<double>(gauges.count);
    felt.push = each * Vec3{x.value, y.value, z.value};
    felt.stiffness = each * steepness(x, y, z);
    // As printed, the gel effect acts fully or not at all. Here it grows with the number of points that touch the sand.
    const double gel = constants.literal ? mostTouch : touch / static_cast<double>(gauges.count);
    const double rub = constants.frictionCoefficient * std::max(felt.push.z, 0.0) / (constants.frictionSpeed / 60);
    felt.drag = gel * constants.maxForce / constants.unitLength + rub;
    return felt;
}

}  // namespace sand::force
