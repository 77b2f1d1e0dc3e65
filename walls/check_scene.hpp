// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <string>

namespace walls {

/// Loads a scene file and returns what it describes: its size, and the units and no data of its files of terrain, one
/// line each, and its warnings. Throws base::InputError if a session could not load it.
[[nodiscard]] std::string describeScene(const std::string& file);

}  // namespace walls
