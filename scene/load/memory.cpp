// SPDX-License-Identifier: Apache-2.0
#include "scene/load/memory.hpp"

#include <fmt/format.h>

#include <memory>

#include "scene/import/raster_memory.hpp"
#include "scene/load/sand_size.hpp"

namespace scene {
namespace {

constexpr std::string_view kServer = "haptic server", kFewerInRaster = "fewer cells, or no edges without data";

}  // namespace

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

SizeChecks checksOfServer(const std::string& file, std::int64_t freeBytes) {
    const auto sizes = std::make_shared<SizeCollector>();
    const auto require = [=](const FieldToMake& field, std::string_view fewer) {
        requireProcess(ProcessMemory::ofServer(sizes->with(field)).figures().most(), freeBytes, file,
                       {field.text(), fewer}, kServer);
    };
    return {.raster =
                [=, fits = fitsMemory(file, freeBytes)](const RasterSize& size) {
                    fits(size);
                    sizes->addRaster(size);
                },
            .field = [=](const FieldToMake& field) { require(field, "fewer cells"); },
            .fieldAtMost = [=](const FieldToMake& field) { require(field, kFewerInRaster); }};
}

void requireServer(const Scene& scene, const std::string& file, std::int64_t freeBytes) {
    requireProcess(ProcessMemory::ofServer(SandSize::of(scene)).figures().most(), freeBytes, file, scene.sizeText(),
                   kServer);
}

}  // namespace scene
