// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <string>

#include "walls/wall.hpp"

namespace walls {

/// Returns a report for a person with a tape measure. It has a map in text, the checks, and the data of every tile.
/// Throws std::logic_error if the tiles are not where the grid's numbers place them. That is an error of this program.
[[nodiscard]] std::string describe(const Wall& wall);

/// Returns one line per rank, from 1, with its host, or "-" if the wall names none. Launchers read these lines.
[[nodiscard]] std::string hostLines(const Wall& wall);

/// Returns a line with two numbers: the outputs of the wall, and those to which the wall file gives a display, a
/// monitor or a window's place. Launchers read this line.
[[nodiscard]] std::string outputsLine(const Wall& wall);

}  // namespace walls
