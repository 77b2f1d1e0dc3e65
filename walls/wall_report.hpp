// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "walls/wall.hpp"

namespace walls {

/// A map of the wall in text, and the facts of every tile, for a person who checks them against a tape measure.
[[nodiscard]] std::string describe(const Wall& wall);

}  // namespace walls
