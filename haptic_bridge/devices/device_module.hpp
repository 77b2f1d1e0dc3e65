// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "haptic_bridge/hand/arm.hpp"

namespace haptic_bridge {

/// Loads a driver and opens its arm. `spec` is "FILE.so" or "FILE.so:WHAT". Throws base::InputError that begins with
/// --device if the file is not a driver or the arm cannot be opened. It also throws if a number of the arm's physics is
/// missing or out of its bounds. Modules stay loaded.
[[nodiscard]] std::unique_ptr<Arm> openArmModule(const std::string& spec);

}  // namespace haptic_bridge
