// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "scene/model/scene.hpp"

namespace web {

/// Returns the sand of an ESRI ASCII grid: dry sand of the default material, and a tool of the usual size. Cells
/// without data are walls, and edges without data are left out. Throws base::InputError for a text that is no such
/// grid, for degrees, for cells that are not square, for heights that do not fit, and for sand that needs more than
/// `memory` bytes. `name` is that of the file.
[[nodiscard]] scene::Scene sceneOfGrid(std::string_view text, const std::string& name, std::int64_t memory);

/// Checks only the header of a grid, so that a file that is too large need not be read. `begin` is the first part of
/// its text, which has `bytes` bytes. Throws as sceneOfGrid() does.
void requireGridFits(std::string_view begin, std::int64_t bytes, const std::string& name, std::int64_t memory);

}  // namespace web
