// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include "host/toml_table.hpp"
#include "scene/load/scene_file.hpp"

namespace scene {

/// Reads [field] and [terrain] of a scene file: heights, rock, walls, and the rules for them. Returns whether the sand
/// must come to rest before the session begins. Throws base::InputError with file, line and key. An error in a DEM
/// names the DEM's line.
[[nodiscard]] bool readTerrain(const host::TomlTable& file, Scene& scene, const SizeChecks& checks);

}  // namespace scene
