// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/byte_stream.hpp"
#include "base/keystroke.hpp"
#include "haptic_bridge/hand/pointer.hpp"

namespace lockstep {

/// Message that a rank sends when it reaches the barrier. `arrived` and `lastSwap` are times on the rank's own clock,
/// corrected to the master's clock.
struct Arrival {
    std::uint64_t frame = 0;
    std::int64_t arrived = 0;     // [ns], when the rank had its hash and, if it draws, its picture
    std::int64_t lastSwap = 0;    // [ns], swap of the frame before; 0 in the first frame
    std::int64_t drawn = 0;       // [ns], duration of the drawing; 0 at the master
    std::uint64_t stateHash = 0;  // sand::Replica::stateHash() after the steps of this frame
    std::uint64_t movement = 0;   // sand::Replica::movementDigest() after the steps of this frame
    std::uint64_t viewHash = 0;   // ViewProof::hash() of this frame's view
    base::Keystroke key{};        // key pressed in a window of this rank; without code if none was
    // [ns], durations of the movements and edits of this frame's steps, of their coarse phases, of their sweeps, and of
    // audit and hash
    std::int64_t dragged = 0, slid = 0, swept = 0, hashed = 0;
    // [pixel], present size of the window that the picture follows (walls::followsWindow); 0 without one
    std::array<std::int32_t, 2> window{};
    // base::MonitorState of each output of the rank's tile. A tile has at most two outputs. The other numbers are 0, so
    // that the message has no gap.
    std::array<std::uint8_t, 8> monitors{};
};

/// Size of the master's receive buffer for each rank's message at the barrier [byte]. It is longer than an arrival, so
/// that the master can tell a message that is too long.
inline constexpr std::size_t kArrivalRoom = 512;
/// Length that is reported for a message longer than the buffer.
inline constexpr int kCutShort = -1;

/// Decodes a rank's message at the barrier of frame `frame`, which is the first `length` bytes of `room`. `length` may
/// be kCutShort. Throws base::FormatError, which describes the message, if it is not an arrival at that frame.
///
/// @param pointer  Not null in a session whose hand is the pointer. The message then has a valid PointerReport behind
///          the arrival, which is stored here.
[[nodiscard]] Arrival readArrival(std::span<const std::uint8_t, kArrivalRoom> room, int length, std::uint64_t frame,
                                  haptic_bridge::PointerReport* pointer = nullptr);

/// Returns the random bytes that a drill sends instead of the arrival at frame `frame`. Their number changes from frame
/// to frame: the length of an arrival, 200, and 4000, which is longer than the master's buffer.
[[nodiscard]] base::Bytes noiseForArrival(std::uint64_t frame);

}  // namespace lockstep
