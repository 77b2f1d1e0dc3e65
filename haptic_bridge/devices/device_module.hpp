// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "haptic_bridge/devices/picture_window.hpp"
#include "haptic_bridge/hand/arm.hpp"

namespace haptic_bridge {

/// "FILE.so" or "FILE.so:WHAT": loads a driver and opens its arm. Throws base::InputError that begins with --device
/// when the file is no such module or the arm cannot be opened. Modules stay loaded.
[[nodiscard]] std::unique_ptr<Arm> openArmModule(const std::string& spec);

/// The window of the mouse, from sandwall-window.so beside this program: nothing else maps GLFW or GL. Throws
/// base::InputError when it is missing, or there is no display.
[[nodiscard]] std::unique_ptr<PictureWindow> openPictureWindow(const std::string& title, int width, int height);

}  // namespace haptic_bridge
