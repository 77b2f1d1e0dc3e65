// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "base/names.hpp"

namespace base {

/// State of the monitor that an output of the wall file names.
enum class MonitorState : std::uint8_t {
    on,        // it shows the output's window; also of an output that names no monitor
    off,       // it is switched off, or its cable is unplugged
    otherSize  // it shows another number of pixels than the output, and has no mode that fits
};
constexpr auto valuesOf(MonitorState) {
    return std::array{Named{MonitorState::on, "on"}, Named{MonitorState::off, "off"},
                      Named{MonitorState::otherSize, "other_size"}};
}

}  // namespace base
