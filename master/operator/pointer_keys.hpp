// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lockstep/overlays.hpp"
#include "scene/model/material.hpp"

namespace master {

inline constexpr char kFrameKey = 'v';  // frames the terrain; the key Home arrives as this one, too
inline constexpr const char* kFixedView = "this wall's view is fixed";  // answer to who tries to move it

/// Returns the operator's command for a key that a person at a desktop has pressed (docs/pointer.md), or an empty text
/// if the key has none. The command starts from the present material and from the layers that are shown.
[[nodiscard]] std::string commandOf(char key, const scene::Material& material, lockstep::Overlays layers);

}  // namespace master
