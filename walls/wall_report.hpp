// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <string>

#include "walls/wall.hpp"

namespace walls {

/// A map of the wall in text, what was checked, and the facts of every tile, for a person who holds them against a
/// tape measure. Throws std::logic_error when the tiles are not where the grid's numbers say: a mistake of ours.
[[nodiscard]] std::string describe(const Wall& wall);

/// One line per rank, from 1: its host, or "-" where the wall names none. What a launcher reads.
[[nodiscard]] std::string hostLines(const Wall& wall);

}  // namespace walls
