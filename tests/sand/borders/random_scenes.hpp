// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace borders {

/// Plays `scenes` random sessions with walls, holes, rims and tools, the first with `seed`. Compares the volume of
/// every part that walls or holes separate, to the unit, and the hash of a replica that loads the last state. Prints
/// each scene that is wrong. Returns whether none is.
bool playRandomScenes(int scenes, std::uint32_t seed);

}  // namespace borders
