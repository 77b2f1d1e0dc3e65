// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <string>

#include "walls/wall.hpp"

namespace walls {

/// What holds of this wall, a line for each thing that was checked, with the figures found on its tiles. Throws
/// std::logic_error when tiles are not where the grid's numbers say: a mistake of ours and not of the file.
[[nodiscard]] std::string checklist(const Wall& wall);

}  // namespace walls
