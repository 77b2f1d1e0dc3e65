// SPDX-License-Identifier: Apache-2.0
#include "scene/import/raster_memory.hpp"

#include <fmt/format.h>

#include "base/input_error.hpp"

namespace scene {

void requireBytes(std::int64_t needed, std::int64_t freeBytes, const std::string& file, const std::string& what,
                  const std::string& advice) {
    if (needed > freeBytes) {
        constexpr double kGibibyte = 1 << 30;
        throw base::InputError(fmt::format("{}: {} need at least {:.1f} GiB, and {:.1f} GiB are free: {}", file, what,
                                           static_cast<double>(needed) / kGibibyte,
                                           static_cast<double>(freeBytes) / kGibibyte, advice));
    }
}

RasterCheck fitsMemory(const std::string& file, std::int64_t freeBytes) {
    return [=](const RasterSize& size) {
        requireBytes(size.bytes(), freeBytes, file, fmt::format("{} x {} pixels of a raster", size.columns, size.rows),
                     "coarsen it, or take a machine with more memory");
    };
}

}  // namespace scene
