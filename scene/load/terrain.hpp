// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include "host/toml_table.hpp"
#include "scene/load/scene_file.hpp"

namespace scene {

/// Reads [field] and [terrain] of a scene file: heights, rock, walls, and what the rules say of them. Throws
/// base::InputError with file, line and key; a DEM's errors name the DEM's line. Returns whether the sand shall come
/// to rest before anybody touches it.
[[nodiscard]] bool readTerrain(const host::TomlTable& file, Scene& scene, const SizeChecks& checks);

}  // namespace scene
