// SPDX-License-Identifier: Apache-2.0
#include "master/view_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>

#include "host/print_line.hpp"
#include "walls/projection.hpp"

namespace master {

ViewSource::ViewSource(const walls::Wall& wall, const scene::Scene& scene, const tracking::Source& source)
    : viewer_(wall, source, [](const std::string& line) { host::printLine("{}", line); }),
      stage_(wall.stage),
      field_(scene.rules.columns * scene.terrain.cellSize(), scene.rules.rows * scene.terrain.cellSize(),
             scene.referenceHeight() * scene.terrain.unit()),
      turns_(walls::isDesktop(wall) && !viewer_.tracked()) {
    show(wall.stereo);
    place({});
}

void ViewSource::place(const walls::Orbit& orbit) {
    orbit_ = orbit;
    const glm::dmat4 toRoom = orbit == walls::Orbit{} ? walls::stageToRoom(stage_, field_.x, field_.y, field_.z)
                                                      : walls::stageToRoom(stage_, field_.x, field_.y, field_.z, orbit);
    std::copy_n(glm::value_ptr(toRoom), state_.sceneToRoom.size(), state_.sceneToRoom.begin());
}

void ViewSource::turn(double right, double down) {
    if (turns_ && (right != 0 || down != 0)) {
        place(orbit_.dragged(stage_, right, down));
    }
}

void ViewSource::turnBack() { place({}); }

lockstep::ViewState ViewSource::at(double seconds) {
    const walls::Viewer viewer = viewer_.at(seconds);
    std::copy_n(glm::value_ptr(viewer.eye), state_.head.size(), state_.head.begin());
    std::copy_n(glm::value_ptr(viewer.right), state_.right.size(), state_.right.begin());
    state_.eyeSeparation = viewer.eyeSeparation;
    return state_;
}

}  // namespace master
