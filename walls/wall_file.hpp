// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "host/toml_table.hpp"
#include "walls/wall.hpp"

/// The parts of a wall file, one source file each; what others include is wall.hpp. All throw base::InputError.
namespace walls::wall_file {

using host::TomlTable;

// Units mixed up (millimetres, pixels) are the usual mistake: no display or room is larger than this.
inline constexpr double kMaxLength = 1000;  // [m]

/// Within kMaxLength of the origin.
[[nodiscard]] glm::dvec3 point(const TomlTable& table, std::string_view key);
/// Of unit length, whatever the file's was.
[[nodiscard]] glm::dvec3 direction(const TomlTable& table, std::string_view key, glm::dvec3 fallback);
/// `value` itself, when it lies within [lowest, kMaxLength].
[[nodiscard]] double length(const TomlTable& table, std::string_view key, double value, double lowest);
[[nodiscard]] glm::dvec2 lengths(const TomlTable& table, std::string_view key, double lowest);
[[nodiscard]] glm::ivec2 pixels(const TomlTable& table, std::string_view key);
/// `up` made exactly perpendicular to the unit vector `right`; complains when it was not nearly so.
[[nodiscard]] glm::dvec3 squared(const TomlTable& table, std::string_view key, glm::dvec3 right, glm::dvec3 up,
                                 const std::string& what);

[[nodiscard]] Grid readGrid(const TomlTable& table);
/// One [[screen]], as the tile after `others`. Checked against them: its name, and whether they lie on one another.
[[nodiscard]] Tile readScreen(const TomlTable& table, Stereo stereo, const std::vector<Tile>& others);
/// All [[place]] tables: hosts, displays, devices, monitors and windows of the tiles they name.
void readPlaces(const TomlTable& file, Stereo stereo, std::vector<Tile>& tiles);

}  // namespace walls::wall_file
