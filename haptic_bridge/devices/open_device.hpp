// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "haptic_bridge/hand/device.hpp"
#include "haptic_bridge/hand/hand_settings.hpp"
#include "scene/model/scene.hpp"

namespace haptic_bridge {

/// Opens a device of docs/devices.md: "script:gis", "script:FILE", "trace:FILE", "driver:FILE.so", "sim:PRESET"
/// or "spacenav". Throws base::InputError if `spec` is unknown, if a file cannot be read, or if the device does
/// not answer.
[[nodiscard]] std::unique_ptr<Device> openDevice(const std::string& spec, const HandSettings& settings,
                                                 const scene::Scene& scene);

/// Returns whether `spec` names hardware, which a person may hold: "driver:FILE.so" or "spacenav". Hardware cannot
/// follow a virtual clock, and gets no force without limits.
[[nodiscard]] bool isRealDevice(std::string_view spec);

}  // namespace haptic_bridge
