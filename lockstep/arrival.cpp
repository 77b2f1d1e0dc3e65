// SPDX-License-Identifier: Apache-2.0
#include "lockstep/arrival.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <random>

namespace lockstep {

Arrival readArrival(std::span<const std::uint8_t, kArrivalRoom> room, int length, std::uint64_t frame) {
    static_assert(sizeof(Arrival) < kArrivalRoom);
    constexpr int kLength = static_cast<int>(sizeof(Arrival));
    if (length == kCutShort) {
        throw base::FormatError(fmt::format("longer than {} bytes", kArrivalRoom));
    }
    if (length != kLength) {
        throw base::FormatError(fmt::format("{} bytes instead of {}", length, kLength));
    }
    Arrival arrival;
    std::memcpy(&arrival, room.data(), sizeof arrival);
    if (arrival.frame != frame) {
        throw base::FormatError(fmt::format("of frame {}", arrival.frame));
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
