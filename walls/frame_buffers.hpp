// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "walls/wall.hpp"

namespace walls {

/// Returns the memory of a rank's pictures with their depth, and of the buffers of its windows [byte]. A rank that
/// draws in memory has no windows, and takes less.
[[nodiscard]] std::int64_t frameBufferBytes(const Wall& wall, const Tile& tile);

}  // namespace walls
