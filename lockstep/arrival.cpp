// SPDX-License-Identifier: Apache-2.0
#include "lockstep/arrival.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <random>

#include "base/monitor_state.hpp"

namespace lockstep {

Arrival readArrival(std::span<const std::uint8_t, kArrivalRoom> room, int length, std::uint64_t frame,
                    haptic_bridge::PointerReport* pointer) {
    static_assert(sizeof(Arrival) + sizeof(haptic_bridge::PointerReport) < kArrivalRoom);
    const int expected =
        static_cast<int>(sizeof(Arrival) + (pointer == nullptr ? 0 : sizeof(haptic_bridge::PointerReport)));
    if (length == kCutShort) {
        throw base::FormatError(fmt::format("longer than {} bytes", kArrivalRoom));
    }
    if (length != expected) {
        throw base::FormatError(fmt::format("{} bytes instead of {}", length, expected));
    }
    Arrival arrival;
    std::memcpy(&arrival, room.data(), sizeof arrival);
    if (arrival.frame != frame) {
        throw base::FormatError(fmt::format("of frame {}", arrival.frame));
    }
    for (const std::uint8_t state : arrival.monitors) {
        if (base::nameOf(static_cast<base::MonitorState>(state)).empty()) {
            throw base::FormatError(fmt::format("with a monitor in state {}", state));
        }
    }
    if (pointer != nullptr) {
        haptic_bridge::PointerReport report;
        std::memcpy(&report, room.data() + sizeof arrival, sizeof report);
        requireValid(report);
        *pointer = report;
    }
    return arrival;
}

base::Bytes noiseForArrival(std::uint64_t frame) {
    constexpr std::array<std::size_t, 3> kLengths{sizeof(Arrival), 200, 4000};
    std::minstd_rand noise(static_cast<unsigned>(frame));
    base::Bytes bytes(kLengths.at(frame % kLengths.size()));
    std::generate(bytes.begin(), bytes.end(), [&] { return static_cast<std::uint8_t>(noise() >> 8); });
    return bytes;
}

}  // namespace lockstep
