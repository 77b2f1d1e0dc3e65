// SPDX-License-Identifier: Apache-2.0
#include "master/view_source.hpp"

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>

#include "walls/projection.hpp"

namespace master {

ViewSource::ViewSource(const walls::Wall& wall, const sand::Scene& scene) {
    const sand::HeightField& field = scene.terrain;
    const glm::dmat4 toRoom =
        walls::stageToRoom(wall.stage, field.columns() * field.cellSize(), field.rows() * field.cellSize(),
                           scene.referenceHeight() * field.unit());
    std::copy_n(glm::value_ptr(toRoom), state_.sceneToRoom.size(), state_.sceneToRoom.begin());
    std::copy_n(glm::value_ptr(wall.viewer.eye), state_.head.size(), state_.head.begin());
    std::copy_n(glm::value_ptr(wall.viewer.right), state_.right.size(), state_.right.begin());
    state_.eyeSeparation = wall.viewer.eyeSeparation;
}

lockstep::ViewState ViewSource::next(std::uint64_t /* frame */) { return state_; }

}  // namespace master
