// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include "host/toml_table.hpp"
#include "scene/scene.hpp"

namespace scene {

/// The nominal cells that a TIN is made on.
struct TinCells {
    int columns, rows;
    double side;  // [scene unit]
};

/// Reads [tin] of a scene whose terrain is a raster of these cells. Points that lie `widest` apart are within what
/// `vertices` allows: of the two, one that the file does not give yields. Throws base::InputError.
[[nodiscard]] sand::tin::Settings readTinSettings(const host::TomlTable& tin, const TinCells& cells);

/// The same where the terrain is points, of which the start takes all: they, with the field's corners, are so many
/// `places`.
[[nodiscard]] sand::tin::Settings readTinSettings(const host::TomlTable& tin, const TinCells& cells,
                                                  std::size_t places);

/// A tool makes vertices up to the usual number of them where the file gives none, however many a start has.
void keepUsual(const host::TomlTable& tin, sand::tin::TinStart& start);

/// Throws base::InputError where a tool would be refined around by squares below a cell, of which there are more than
/// the scene may have vertices: each costs time in every step, whether it gets a vertex or not. Tool and material have
/// been read.
void requireSpacing(const host::TomlTable& file, const Scene& scene);

}  // namespace scene
