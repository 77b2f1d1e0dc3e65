// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "base/byte_stream.hpp"

namespace lockstep {

/// Message that a rank sends when it reaches the barrier. Times are in its own clock, corrected to the master's [ns].
struct Arrival {
    std::uint64_t frame = 0;
    std::int64_t arrived = 0;
    std::int64_t lastSwap = 0;  // when it swapped the frame before; 0 on the first
    std::int64_t drawn = 0;     // how long it drew [ns]
    std::uint64_t stateHash = 0;
    std::uint64_t viewHash = 0;  // ViewProof::hash of what this frame was drawn by
    char key = 0;                // pressed in a window of this rank since the frame before; 0 for none
};

/// Size of the master's receive buffer for each rank's message at the barrier [byte]. It is longer than an arrival, so
/// that the master can tell a message that is too long.
inline constexpr std::size_t kArrivalRoom = 256;
/// Stands for the length of a message that was longer than the buffer.
inline constexpr int kCutShort = -1;

/// Reads the message of a rank at the barrier of `frame`: the first `length` bytes of `room`; `length` may be
/// kCutShort. Throws base::FormatError, which says what the message is, unless it is an arrival at that frame.
[[nodiscard]] Arrival readArrival(std::span<const std::uint8_t, kArrivalRoom> room, int length, std::uint64_t frame);

/// Makes the random bytes that a drill sends in place of the arrival at `frame`. Their count alternates with the frame:
/// the length of an arrival, 200, and 4000, which is longer than the master's buffer.
[[nodiscard]] base::Bytes noiseForArrival(std::uint64_t frame);

}  // namespace lockstep
