// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

/// Limits of the messages between ranks. They are far above what a session has, and bound what a damaged message can
/// ask for.
namespace lockstep {

inline constexpr std::size_t kMostRanks = 1 << 16;   // in a list of ranks
inline constexpr std::size_t kMostFaults = 1 << 16;  // of all drills
inline constexpr std::size_t kMostText = 1 << 16;    // [byte] of a text of a rank, and texts in a list

}  // namespace lockstep
