// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "haptic_bridge/hand/device.hpp"
#include "haptic_bridge/hand/hand_settings.hpp"
#include "scene/scene.hpp"

namespace haptic_bridge {

/// Opens what docs/devices.md lists: "script:gis", "script:FILE", "trace:FILE", "driver:FILE.so", "sim:PRESET",
/// "mouse", "spacenav". Throws base::InputError for anything else, for files that cannot be read and devices that are
/// not there.
[[nodiscard]] std::unique_ptr<Device> openDevice(const std::string& spec, const HandSettings& settings,
                                                 const scene::Scene& scene);

}  // namespace haptic_bridge
