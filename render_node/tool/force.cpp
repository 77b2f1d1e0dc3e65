// SPDX-License-Identifier: Apache-2.0
#include "render_node/tool/force.hpp"

#include "sand/force/law.hpp"
#include "sand/force/tool_contour.hpp"

namespace render_node {

using sand::force::Vec3;

std::optional<ForceArrow> ToolForce::arrow(const sand::Replica& replica) {
    const double unit = sand::probeUnit(replica.cellSize());
    const double radius = unit * replica.rules().tuning.tool.radius;
    const Vec3 place = sand::force::placeOf(replica.probe(), unit);
    if (!last_ || replica.stepNumber() < lastStep_) {
        velocity_ = {};
    } else if (replica.stepNumber() > lastStep_) {  // a frame without a step keeps the velocity
        const auto steps = static_cast<double>(replica.stepNumber() - lastStep_);
        velocity_ = (replica.rules().stepsPerSecond / (60.0 * steps)) * (place - *last_);
    }
    last_ = place;
    lastStep_ = replica.stepNumber();
    if (!replica.engaged() || !(radius > 0)) {
        return std::nullopt;
    }
    sand::force::SurfacePatch patch;
    patch.take(replica.surface(), replica.rules(), replica.cellSize(), replica.probe());
    const auto tool = sand::force::contourOf(replica.tool(), replica.cellSize());
    const auto felt = sand::force::respond(constants_, patch, tool, place);
    const Vec3 whole = sand::force::lawfulForce(felt, velocity_);
    const Vec3 force = sand::force::guarded(whole, 0, kMostNewtons);
    const double newtons = sand::force::norm(force);
    if (newtons < kFewestNewtons) {
        return std::nullopt;
    }
    const Vec3 from = place + (radius / newtons) * force;
    const Vec3 to = from + (kArrowPerNewton * radius) * force;
    const auto vector = [](Vec3 v) { return glm::vec3(glm::dvec3(v.x, v.y, v.z)); };
    return ForceArrow{vector(from), vector(to), sand::force::norm(whole) >= kMostNewtons};
}

}  // namespace render_node
