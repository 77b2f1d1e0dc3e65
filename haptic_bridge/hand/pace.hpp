// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "base/names.hpp"

namespace haptic_bridge {

/// How a session passes time. The master's frames and the server's hand have the same pace.
enum class Pace : std::uint8_t {
    realtime,  // by the clock: frames follow the wall's refresh rate, and the hand is read every millisecond
    fast       // frames follow each other without a pause; a virtual clock counts frames and ticks of the hand
};
constexpr auto valuesOf(Pace) {
    return std::array{base::Named{Pace::realtime, "realtime"}, base::Named{Pace::fast, "fast"}};
}

}  // namespace haptic_bridge
