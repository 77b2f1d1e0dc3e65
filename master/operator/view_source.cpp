// SPDX-License-Identifier: Apache-2.0
#include "master/operator/view_source.hpp"

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>

#include "base/input_error.hpp"
#include "host/print_line.hpp"
#include "shapes/box_outline.hpp"
#include "walls/projection.hpp"

namespace master {

ViewSource::ViewSource(const walls::Wall& wall, const scene::Scene& scene, const tracking::Source& source)
    : viewer_(wall, source, [](const std::string& line) { host::printLine("{}", line); }),
      field_{scene.rules.columns * scene.terrain.cellSize(), scene.rules.rows * scene.terrain.cellSize(),
             scene.referenceHeight() * scene.terrain.unit()},
      unit_(scene.terrain.unit()) {
    show(wall.stereo);
    swapEyes(wall.swapEyes);
    if (walls::isDesktop(wall) && !viewer_.tracked()) {
        desk_.emplace(wall, field_);
    }
    place(walls::stageToRoom(wall.stage, field_.width, field_.height, field_.referenceZ));
}

void ViewSource::place(const glm::dmat4& sceneToRoom) {
    std::copy_n(glm::value_ptr(sceneToRoom), state_.sceneToRoom.size(), state_.sceneToRoom.begin());
}

bool ViewSource::move(const haptic_bridge::PointerReport& report) {
    if (!report.movesView()) {
        return true;
    }
    const auto vector = [](const std::array<float, 3>& from) { return glm::dvec3(from[0], from[1], from[2]); };
    desk_->turn(static_cast<double>(report.turnX), static_cast<double>(report.turnY));
    desk_->pan(vector(report.pan));
    const bool zoomed = desk_->zoom(static_cast<double>(report.wheel), vector(report.wheelAt));
    place(desk_->sceneToRoom());
    return zoomed;
}

void ViewSource::frame(const sand::HeightSpan& sand) {
    if (desk_) {
        const double lowest = sand.lowest * unit_;
        floorOf_ = std::min(floorOf_.value_or(lowest), lowest);
        const shapes::Box box = shapes::boxOutline({field_.width, field_.height}, *floorOf_, sand.highest * unit_);
        desk_->frame({box.low, box.high});
        place(desk_->sceneToRoom());
    }
}

void ViewSource::show(const walls::Orbit& orbit) {
    if (!desk_) {
        throw base::InputError("--view: this wall has a fixed view; leave --view out");
    }
    desk_->show(orbit);
    place(desk_->sceneToRoom());
}

lockstep::ViewState ViewSource::at(double seconds) {
    const walls::Viewer viewer = viewer_.at(seconds);
    std::copy_n(glm::value_ptr(viewer.eye), state_.head.size(), state_.head.begin());
    std::copy_n(glm::value_ptr(viewer.right), state_.right.size(), state_.right.begin());
    state_.eyeSeparation = viewer.eyeSeparation;
    return state_;
}

}  // namespace master
