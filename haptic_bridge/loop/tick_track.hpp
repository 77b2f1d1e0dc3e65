// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/byte_stream.hpp"
#include "haptic_bridge/hand/device.hpp"
#include "haptic_bridge/hand/hand_settings.hpp"
#include "haptic_bridge/loop/haptic_tick.hpp"
#include "haptic_bridge/loop/tick.hpp"

namespace haptic_bridge {

/// What a device was, from a link's start to its end.
struct TrackHeader {
    bool body = false;  // false: a recording, which has no physics
    ArmPhysics physics;
    double scale = 1;  // Device::scale()
    HandSettings::Datum datum = HandSettings::Datum::surface;
    bool literal = false;  // Guards::Mode::literal
};

/// A piece of the track, as a message carries it and a journal keeps it: of one sitting, from a link's start to its
/// end, its header, or ticks that follow each other.
struct TrackPiece {
    std::uint32_t sitting = 0;
    bool begins = false;
    TrackHeader header;            // when it begins
    std::vector<TickInput> ticks;  // otherwise
};

[[nodiscard]] TrackHeader headerOf(const HapticTick& hand);
[[nodiscard]] base::Bytes encode(const TrackPiece& piece);
/// Throws base::FormatError for bytes that encode() does not write.
[[nodiscard]] TrackPiece decodeTrackPiece(std::span<const std::uint8_t> bytes);

/// The most ticks of a piece, so that it is a message of usual length.
inline constexpr std::size_t kMostTicksInPiece = 400;

/// The title line of --record's file, and one row: numbers in the shortest digits that give the same doubles again.
[[nodiscard]] std::string tickTitles();
void appendRow(const Tick& tick, std::string& text);

}  // namespace haptic_bridge
