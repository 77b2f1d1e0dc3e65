// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "scene/import/raster_check.hpp"

namespace scene {

/// Throws base::InputError unless `needed` bytes fit into `freeBytes`. The message is "FILE: WHAT need at least 4.0
/// GiB, and 1.0 GiB are free: ADVICE".
void requireBytes(std::int64_t needed, std::int64_t freeBytes, const std::string& file, const std::string& what,
                  const std::string& advice);

/// Returns a check for a program that may take `freeBytes`. It refuses a raster whose pixels do not fit. `file` is for
/// the message.
[[nodiscard]] RasterCheck fitsMemory(const std::string& file, std::int64_t freeBytes);

}  // namespace scene
