// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/model/ground.hpp"
#include "sand/model/height_field.hpp"
#include "scene/scene.hpp"

namespace scene::relax {

/// The steepest face of a field across which sand could flow: its slope as the isotropic law sees it, whatever the
/// rules' scheme, as a difference from a cell to the next one east [unit]. Stable where it is at most the threshold.
///
/// A face counts when its upper cell holds at least four units of sand, of which it may give one. 0 where there is no
/// such face. `ground` may be null.
[[nodiscard]] double steepestFace(const sand::HeightField& field, const sand::Rules& rules, const sand::Ground* ground);

}  // namespace scene::relax
