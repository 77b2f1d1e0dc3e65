// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include "host/toml_table.hpp"
#include "scene/import/points_file.hpp"
#include "scene/load/progress.hpp"
#include "scene/model/scene.hpp"

namespace scene {

/// Puts points on the lattice of nominal cells. `scene.tin` then holds the points, until readTin() makes a TIN of them.
/// The rules hold the number of cells below the points, and the georeference holds their original place. Returns a
/// height field of one cell. Throws base::InputError.
[[nodiscard]] sand::HeightField layOutPoints(const host::TomlTable& file, const host::TomlTable& terrain,
                                             const Points& points, Scene& scene);

/// Reads [tin] of a scene file, and makes a TIN of the scene's height field or points. Does nothing without that table.
/// Throws base::InputError with file, line and key.
///
/// @param done  Called with the part of the work that is done, 0 to 1. It may be empty.
void readTin(const host::TomlTable& file, Scene& scene, const Progress& done = {});

}  // namespace scene
