// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include "scene/scene.hpp"

namespace scene {

/// Receives the size of a height field before its heights are made, and throws if it does not fit the memory. With
/// `tin`, a TIN is made of it and these are its nominal cells.
using FieldCheck = std::function<void(int columns, int rows, bool tin)>;

/// Reads a scene file. Throws base::InputError with file, line and key; a DEM's errors name the DEM's line.
/// Calls `check` once, but never for a terrain of points, which makes no field.
[[nodiscard]] Scene loadScene(const std::filesystem::path& file, const FieldCheck& check = {});

}  // namespace scene
