// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

namespace shapes {

/// Converts linear light to sRGB exactly; the shaders' encode() is an approximation. The result is a whole level,
/// because a driver may clear a part of a picture by another path than the whole. The two paths may round differently.
[[nodiscard]] glm::vec3 encoded(const glm::vec3& linear);

/// Returns the albedo of wet sand. Water between the grains sends a share of the light that they scatter back to them
/// (Ångström 1925). A darker colour loses more of its light, so that wet sand is also more saturated. Most of the
/// change comes with the first water. Dry sand keeps its albedo, bit for bit.
[[nodiscard]] glm::vec3 wetAlbedo(const glm::vec3& dry, double humidity);

}  // namespace shapes
