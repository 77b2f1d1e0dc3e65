// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "haptic_bridge/devices/picture_window.hpp"
#include "haptic_bridge/hand/arm.hpp"

namespace haptic_bridge {

/// Loads a driver and opens its arm. `spec` is "FILE.so" or "FILE.so:WHAT". Throws base::InputError that begins with
/// --device if the file is not a driver or the arm cannot be opened. Modules stay loaded.
[[nodiscard]] std::unique_ptr<Arm> openArmModule(const std::string& spec);

/// Opens the window of the mouse. Its module sandwall-window.so lies beside this program, and only this module loads
/// GLFW and GL. Throws base::InputError if the module is missing or there is no display.
[[nodiscard]] std::unique_ptr<PictureWindow> openPictureWindow(const std::string& title, int width, int height);

}  // namespace haptic_bridge
