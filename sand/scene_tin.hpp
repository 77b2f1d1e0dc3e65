// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "files/toml_table.hpp"
#include "sand/import/points_file.hpp"
#include "sand/scene.hpp"
#include "sand/terrain.hpp"

namespace sand {

/// Puts points on the lattice of nominal cells: scene.tin holds them, until readTin() makes a TIN of them, the
/// rules know how many cells lie under them, and the georeference where they were. Returns one cell. Throws
/// files::InputError.
[[nodiscard]] HeightField layOutPoints(const files::TomlTable& file, const files::TomlTable& terrain,
                                       const Points& points, Scene& scene);

/// Reads [tin] of a scene file: the scene's height field becomes a TIN. Does nothing without that table. Throws
/// files::InputError with file, line and key.
void readTin(const files::TomlTable& file, Scene& scene);

/// The scene starts with the sand as it is there.
void startFrom(const Terrain& terrain, Scene& scene);

}  // namespace sand
