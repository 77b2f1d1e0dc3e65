// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "host/toml_table.hpp"
#include "walls/wall.hpp"

/// Readers of the parts of a wall file, one source file each. Other folders include wall.hpp. All functions throw
/// base::InputError.
namespace walls::wall_file {

using host::TomlTable;

// Largest length in a wall file. No display or room is larger, and mixed-up units (millimetres, pixels) are the usual
// mistake.
inline constexpr double kMaxLength = 1000;  // [m]

/// Reads a point within kMaxLength of the origin [m].
[[nodiscard]] glm::dvec3 point(const TomlTable& table, std::string_view key);
/// Reads a direction of any length and returns it with length 1.
[[nodiscard]] glm::dvec3 direction(const TomlTable& table, std::string_view key, glm::dvec3 fallback);
/// Returns `value` if it is in [lowest, kMaxLength].
[[nodiscard]] double length(const TomlTable& table, std::string_view key, double value, double lowest);
[[nodiscard]] glm::dvec2 lengths(const TomlTable& table, std::string_view key, double lowest);
[[nodiscard]] glm::ivec2 pixels(const TomlTable& table, std::string_view key);
/// Returns `up`, made exactly perpendicular to the unit vector `right`. Throws base::InputError if the two are not
/// nearly perpendicular.
[[nodiscard]] glm::dvec3 squared(const TomlTable& table, std::string_view key, glm::dvec3 right, glm::dvec3 up,
                                 const std::string& what);

[[nodiscard]] Grid readGrid(const TomlTable& table);
/// Reads one [[screen]] as the tile after `others`. Checks that its name is unique and that it does not lie on another
/// tile.
[[nodiscard]] Tile readScreen(const TomlTable& table, Stereo stereo, const std::vector<Tile>& others);
/// Reads all [[place]] tables: hosts, displays, devices, monitors and windows of the tiles that they name.
void readPlaces(const TomlTable& file, Stereo stereo, std::vector<Tile>& tiles);

}  // namespace walls::wall_file
