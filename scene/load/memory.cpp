// SPDX-License-Identifier: Apache-2.0
#include "scene/load/memory.hpp"

#include <fmt/format.h>

#include "sand/replica.hpp"
#include "scene/import/raster_memory.hpp"

namespace scene {
namespace {

constexpr const char* kFewerCells = "fewer cells, or a machine with more memory";

}  // namespace

std::int64_t bytesOfField(int columns, int rows, bool tin) {
    return tin ? std::int64_t{sizeof(std::int32_t)} * columns * rows : sand::Replica::leastBytes(columns, rows);
}

SizeChecks checksOfOneReplica(const std::string& file, std::int64_t freeBytes) {
    return {.raster = [fits = fitsMemory(file, freeBytes)](int columns, int rows) { fits(columns, rows, false); },
            .field =
                [=](int columns, int rows, bool tin) {
                    requireBytes(bytesOfField(columns, rows, tin), freeBytes, file,
                                 fmt::format("{} x {} {}", columns, rows, tin ? "nominal cells of a TIN" : "cells"),
                                 kFewerCells);
                }};
}

void requireReplica(const Scene& scene, const std::string& file, std::int64_t freeBytes) {
    if (scene.tin == nullptr) {
        return requireReplica(scene.rules.columns, scene.rules.rows, file, freeBytes);
    }
    requireBytes(sand::Replica::leastBytes(scene), freeBytes, file,
                 fmt::format("a TIN's {} vertices", scene.tin->places.size()),
                 "fewer vertices, or a machine with more memory");
}

void requireReplica(int columns, int rows, const std::string& file, std::int64_t freeBytes) {
    requireBytes(bytesOfField(columns, rows, false), freeBytes, file, fmt::format("{} x {} cells", columns, rows),
                 kFewerCells);
}

}  // namespace scene
