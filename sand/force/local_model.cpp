// SPDX-License-Identifier: Apache-2.0
#include "sand/force/local_model.hpp"

#include <algorithm>
#include <cmath>

namespace sand::force {
namespace {

constexpr double kTooShort = 0.02;  // [tool reach]: from a shorter way nothing can be learnt

}  // namespace

Gauges LocalModel::at(const ForceConstants& constants, const SurfacePatch& surface, bool replaced, bool forget,
                      const Contour& tool, Vec3 place, double time) {
    const Vec3 step = place - origin_;
    const double moved = std::hypot(step.x, step.y);  // across; up and down the tangent is exact
    // A hand that leaps has no business with the sand it came from.
    const bool unknown = forget || !(moved < 2 * tool.reach);
    const double kept = constants.recoveryTime > 0 ? std::exp((time_ - time) / constants.recoveryTime) : 0;
    for (double& debt : debt_) {
        debt *= kept;
    }
    time_ = time;
    if (unknown || replaced || !(moved <= constants.validity * tool.reach)) {
        const Gauges before = tangent_, carried = carriedBy(step);
        tangent_ = measure(constants, surface, tool, place);
        origin_ = place;
        if (unknown) {
            // Control points lie where the tool pushes: nothing there is believed before it has come true.
            share_.fill(constants.law == ForceLaw::repulse ? 1 : 0);
            debt_.fill(0);
        } else {
            for (std::size_t i = 0; i < tangent_.count; ++i) {
                debt_[i] = constants.recoveryTime > 0 ? carried.dials[i].value - tangent_.dials[i].value : 0;
            }
            if (replaced && moved > kTooShort * tool.reach) {
                learn(before, step);
            }
        }
    }
    return carriedBy(place - origin_);
}

Gauges LocalModel::carriedBy(Vec3 step) const {
    Gauges result = tangent_;
    for (std::size_t i = 0; i < result.count; ++i) {
        const Vec3 slope = tangent_.dials[i].slope;
        result.dials[i].value += share_[i] * (slope.x * step.x + slope.y * step.y) + slope.z * step.z + debt_[i];
    }
    return result;
}

/// Compares what `before` foretold for the way across with what is there now.
void LocalModel::learn(const Gauges& before, Vec3 step) {
    const Vec3 across{step.x, step.y, 0};
    for (std::size_t i = 0; i < tangent_.count; ++i) {
        const Dual was = before.dials[i], is = tangent_.dials[i];
        const double foretold = 0.5 * dot(was.slope + is.slope, across);
        const double found = is.value - was.value - was.slope.z * step.z;
        share_[i] = found * foretold > 0 ? std::min(found / foretold, 1.0) : 0;
    }
}

}  // namespace sand::force
