// SPDX-License-Identifier: Apache-2.0
#include "scene/load/memory.hpp"

#include <fmt/format.h>

#include "scene/import/raster_memory.hpp"

namespace scene {

SizeChecks checksOfOneReplica(const std::string& file, std::int64_t freeBytes) {
    return {.raster = fitsMemory(file, freeBytes),
            .field = [=](const sand::FieldSize& size) { requireReplica(size, file, freeBytes); }};
}

void requireReplica(const Scene& scene, const std::string& file, std::int64_t freeBytes) {
    const sand::SizeText size = scene.sizeText();
    requireBytes(scene.leastBytes(), freeBytes, file, size.what,
                 fmt::format("{}, or a machine with more memory", size.fewer));
}

void requireReplica(const sand::FieldSize& size, const std::string& file, std::int64_t freeBytes) {
    requireBytes(size.leastBytes(), freeBytes, file, size.text(), "fewer cells, or a machine with more memory");
}

}  // namespace scene
