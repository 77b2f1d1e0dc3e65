// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <string>

#include "walls/wall.hpp"

namespace walls {

/// Returns one line for each check of this wall, with the figures that were found on its tiles. Throws std::logic_error
/// if tiles are not where the grid's numbers place them. That is an error of this program, not of the file.
[[nodiscard]] std::string checklist(const Wall& wall);

}  // namespace walls
