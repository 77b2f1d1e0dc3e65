// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "base/names.hpp"

namespace haptic_bridge {

/// Reason why the wall takes no steps, although it shows frames.
enum class Held : std::uint8_t {
    no,    // it takes steps
    disk,  // the journal's disk has no room
    pause  // an operator has paused the sand
};
constexpr auto valuesOf(Held) {
    return std::array{base::Named{Held::no, "no"}, base::Named{Held::disk, "disk"}, base::Named{Held::pause, "pause"}};
}

}  // namespace haptic_bridge
