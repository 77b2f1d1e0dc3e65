// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "sand/model/probe_point.hpp"

namespace haptic_bridge {

/// One reading of the pointer: where its ray meets the sand.
struct PointerSample {
    std::int64_t readNs = 0;             // [ns], when the rank read it, on the master's clock
    sand::ProbePoint probe;              // place on the sand's surface; meaningless unless `meets`
    std::uint8_t pressed = 0;            // 1: the left button or a finger is down
    std::uint8_t meets = 0;              // 1: the ray meets sand
    std::array<std::uint8_t, 2> zero{};  // fills the gap, so that no byte of the message is indeterminate
    friend bool operator==(const PointerSample&, const PointerSample&) = default;
};

/// Pointer of a rank's windows since its arrival before. A rank sends it behind its arrival, and only in a session
/// whose hand is the pointer.
struct PointerReport {
    static constexpr std::size_t kMostSamples = 6;

    std::uint32_t touch = 0;             // number of touches in the rank's windows so far
    float wheel = 0;                     // notches of the wheel, positive towards the user
    float depth = 0;                     // notches of the wheel with Shift
    float size = 0;                      // notches of the wheel with Ctrl
    float turnX = 0, turnY = 0;          // [side of the window], drag that turns the view, right and down
    std::array<float, 3> wheelAt{};      // [m], place in the room under the pointer when the wheel turned
    std::array<float, 3> pan{};          // [m], drag that moves the sand in the room
    std::uint8_t count = 0;              // number of samples, in the order of time
    std::uint8_t pressed = 0;            // 1: the left button or a finger is down now
    std::array<std::uint8_t, 2> zero{};  // fills the gap
    std::array<PointerSample, kMostSamples> samples{};

    /// Returns the samples that the report has: the first `count`.
    [[nodiscard]] std::span<const PointerSample> taken() const { return {samples.data(), count}; }
    /// Returns whether a touch lasts, or began and ended since the arrival before.
    [[nodiscard]] bool touches() const;
    /// Returns whether the pointer turns, pans or zooms the view.
    [[nodiscard]] bool movesView() const;
    friend bool operator==(const PointerReport&, const PointerReport&) = default;
};
static_assert(std::is_trivially_copyable_v<PointerReport>);
static_assert(sizeof(PointerSample) == 24 && sizeof(PointerReport) == 56 + 24 * PointerReport::kMostSamples,
              "no hidden gaps, because the bytes are a message");

/// Throws base::FormatError if `report` has too many samples, a place beyond sand::kMaxProbe, a time that no clock
/// shows, or a number that is not finite.
void requireValid(const PointerReport& report);

}  // namespace haptic_bridge
