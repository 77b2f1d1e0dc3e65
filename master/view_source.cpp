// SPDX-License-Identifier: Apache-2.0
#include "master/view_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>

#include "host/print_line.hpp"
#include "walls/projection.hpp"

namespace master {

ViewSource::ViewSource(const walls::Wall& wall, const scene::Scene& scene, const tracking::Source& source)
    : viewer_(wall, source, [](const std::string& line) { host::printLine("{}", line); }) {
    const double cell = scene.terrain.cellSize();
    const glm::dmat4 toRoom = walls::stageToRoom(wall.stage, scene.rules.columns * cell, scene.rules.rows * cell,
                                                 scene.referenceHeight() * scene.terrain.unit());
    show(wall.stereo);
    std::copy_n(glm::value_ptr(toRoom), state_.sceneToRoom.size(), state_.sceneToRoom.begin());
}

lockstep::ViewState ViewSource::at(double seconds) {
    const walls::Viewer viewer = viewer_.at(seconds);
    std::copy_n(glm::value_ptr(viewer.eye), state_.head.size(), state_.head.begin());
    std::copy_n(glm::value_ptr(viewer.right), state_.right.size(), state_.right.begin());
    state_.eyeSeparation = viewer.eyeSeparation;
    return state_;
}

}  // namespace master
