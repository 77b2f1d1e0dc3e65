// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/model/ground.hpp"
#include "sand/model/height_field.hpp"
#include "scene/model/scene.hpp"

namespace scene::relax {

/// Returns the slope of the steepest face of a field across which sand could flow. The slope is that of the isotropic
/// law, whatever the rules' scheme, as a difference from a cell to the next one east [unit]. The sand is stable if it
/// is at most the threshold.
///
/// A face counts if its upper cell holds at least four units of sand, because it may then give one of them. Returns 0
/// if no face counts. `ground` may be null.
[[nodiscard]] double steepestFace(const sand::HeightField& field, const sand::Rules& rules, const sand::Ground* ground);

}  // namespace scene::relax
