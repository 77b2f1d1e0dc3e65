// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "files/toml_table.hpp"
#include "sand/scene.hpp"
#include "sand/terrain.hpp"

namespace sand {

/// Reads [tin] of a scene file: the scene's height field becomes a TIN. Does nothing without that table. Throws
/// files::InputError with file, line and key.
void readTin(const files::TomlTable& file, Scene& scene);

/// The scene starts with the sand as it is there.
void startFrom(const Terrain& terrain, Scene& scene);

}  // namespace sand
