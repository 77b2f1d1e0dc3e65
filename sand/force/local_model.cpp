// SPDX-License-Identifier: Apache-2.0
#include "sand/force/local_model.hpp"

#include <algorithm>
#include <cmath>

namespace sand::force {
namespace {

constexpr double kShortestWay = 0.1;  // [tool reach], shortest way from which the model learns
constexpr double kMotion =
    0.003;  // [s], time over which motion is averaged; the motion of one tick is mostly resolution
constexpr double kSlowest = 0.1;  // smallest rate of recovery, as a share of the full rate

/// Returns the time constant of the recovery [s] for a hand that moves along `motion`. Control points lie where the
/// tool cuts, and see every change of the sand there. With the time of `repulse` they keep a hand moving up and down
/// that rests on the sand with its weight. A hand that moves across is not slowed down, because new sand comes all the
/// time.
double recoveryTimeOf(const ForceConstants& constants, Vec3 motion) {
    constexpr double kUpAndDown = 2;  // [recovery time], of control points
    const double across = motion.x * motion.x + motion.y * motion.y, all = across + motion.z * motion.z;
    const double share = constants.law != ForceLaw::controlPoints ? 1 : all > 0 ? across / all : 0;
    return (kUpAndDown + share * (1 - kUpAndDown)) * constants.recoveryTime;
}

}  // namespace

Gauges LocalModel::at(const ForceConstants& constants, const SurfacePatch& surface, bool replaced, bool forget,
                      const Contour& tool, Vec3 place, double time) {
    const Vec3 step = place - origin_;
    const double moved = std::hypot(step.x, step.y);  // horizontally; vertically the tangent is exact
    // A hand that jumps leaves the sand that the model describes.
    const bool unknown = forget || !(moved < 2 * tool.reach);
    const double span = time - time_;
    motion_ = unknown ? Vec3{} : motion_ + (1 - std::exp(-span / kMotion)) * (place - place_ - motion_);
    time_ = time;
    place_ = place;
    if (unknown) {
        tangent_ = mark_ = measure(constants, surface, tool, place);
        origin_ = markPlace_ = place;
        // Control points lie where the tool pushes. There, no part of the tangent is assumed before it has come true.
        share_.fill(constants.law == ForceLaw::repulse ? 1 : 0);
        debt_.fill(0);
    } else if (replaced || !(moved <= constants.validity * tool.reach)) {
        const Gauges carried = carriedBy(step);
        tangent_ = measure(constants, surface, tool, place);
        origin_ = place;
        for (std::size_t i = 0; i < tangent_.count; ++i) {
            debt_[i] = carried.dials[i].value - tangent_.dials[i].value;
        }
        const Vec3 way = place - markPlace_;
        if (replaced && std::hypot(way.x, way.y) > kShortestWay * tool.reach) {
            learn(mark_, way);
            mark_ = tangent_;
            markPlace_ = place;
        }
    }
    recover(constants, tool, span);
    return carriedBy(place_ - origin_);
}

/// Reduces the debt. Reduces it only a little while that would change the force along the motion.
void LocalModel::recover(const ForceConstants& constants, const Contour& tool, double span) {
    if (!(constants.recoveryTime > 0)) {
        debt_.fill(0);
        return;
    }
    const Vec3 step = place_ - origin_;
    const Vec3 before = respond(constants, tool, carriedBy(step)).push;
    const auto owed = debt_;
    const auto pay = [&](double rate) {
        const double kept = std::exp(-span * rate / recoveryTimeOf(constants, motion_));
        for (std::size_t i = 0; i < debt_.size(); ++i) {
            debt_[i] = kept * owed[i];
        }
    };
    pay(1);
    const Vec3 change = respond(constants, tool, carriedBy(step)).push - before;
    const double power = dot(change, motion_);
    if (power > 0) {
        pay(std::max(1 - power / (norm(change) * norm(motion_)), kSlowest));
    }
}

Gauges LocalModel::carriedBy(Vec3 step) const {
    Gauges result = tangent_;
    for (std::size_t i = 0; i < result.count; ++i) {
        const Vec3 slope = tangent_.dials[i].slope;
        result.dials[i].value += share_[i] * (slope.x * step.x + slope.y * step.y) + slope.z * step.z + debt_[i];
    }
    return result;
}

/// Compares what `before` predicted for the horizontal way with the gauges at its end.
void LocalModel::learn(const Gauges& before, Vec3 step) {
    const Vec3 across{step.x, step.y, 0};
    for (std::size_t i = 0; i < tangent_.count; ++i) {
        const Dual was = before.dials[i], is = tangent_.dials[i];
        const double predicted = 0.5 * dot(was.slope + is.slope, across);
        const double found = is.value - was.value - was.slope.z * step.z;
        share_[i] = found * predicted > 0 ? std::min(found / predicted, 1.0) : 0;
    }
}

}  // namespace sand::force
