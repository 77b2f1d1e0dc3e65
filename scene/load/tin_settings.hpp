// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include "host/toml_table.hpp"
#include "scene/model/scene.hpp"

namespace scene {

/// Nominal cells of a TIN.
struct TinCells {
    int columns, rows;
    double side;  // [scene unit]
};

/// Reads [tin] of a scene whose terrain is a raster of these cells. Points at a distance of `widest` must not be more
/// than `vertices` allows. If the file gives only one of these two keys, the other adapts to it. Throws
/// base::InputError.
[[nodiscard]] sand::tin::Settings readTinSettings(const host::TomlTable& tin, const TinCells& cells);

/// Reads [tin] of a scene whose terrain is points. The start takes all of them. `places` is their number, including the
/// field's corners.
[[nodiscard]] sand::tin::Settings readTinSettings(const host::TomlTable& tin, const TinCells& cells,
                                                  std::size_t places);

/// Sets the limit of vertices if the file gives none. The limit is the usual number of vertices, or the number of the
/// start if that is larger.
void keepUsual(const host::TomlTable& tin, sand::tin::TinStart& start);

/// Throws base::InputError if the squares with which a tool refines the mesh are too many. This is so if they are
/// smaller than a cell, and if there are more of them than the scene may have vertices. Each of them costs time in
/// every step, whether or not it gets a vertex. Tool and material must have been read.
void requireSpacing(const host::TomlTable& file, const Scene& scene);

}  // namespace scene
