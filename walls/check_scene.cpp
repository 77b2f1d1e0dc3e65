// SPDX-License-Identifier: Apache-2.0
#include "walls/check_scene.hpp"

#include <fmt/format.h>

#include <iterator>

#include "scene/load/sand_size.hpp"
#include "scene/load/step_cost.hpp"
#include "scene/model/start_time.hpp"
#include "walls/check_memory.hpp"

namespace walls {

std::string describeScene(const std::string& file, const Wall* wall) {
    scene::SizeCollector sizes;
    const scene::Scene scene =
        scene::loadScene(file, {.raster = [&](const scene::RasterSize& raster) { sizes.addRaster(raster); }});
    std::string text = fmt::format("scene '{}': {} x {} cells of {}\n", scene.name, scene.rules.columns,
                                   scene.rules.rows, scene.terrain.cellSize());
    for (const scene::RasterStatement& statement : *scene.statements) {
        fmt::format_to(std::back_inserter(text), "{}: {}\n", statement.file, statement.text());
    }
    for (const std::string& warning : scene.warnings) {
        fmt::format_to(std::back_inserter(text), "warning: {}\n", warning);
    }
    if (const auto cost = scene::stepCostOf(scene)) {
        fmt::format_to(std::back_inserter(text), "{}\n", cost->text(scene));
    }
    if (const auto tools = scene::largestToolsOf(scene)) {
        fmt::format_to(std::back_inserter(text), "{}\n", tools->text(scene));
    }
    scene::SandSize sand = scene::SandSize::of(scene);
    sand.rasterBytes = sizes.rasterBytes();
    return text + memoryTable(sand, wall) + scene::StartTime::of(sand).text() + "\n";
}

std::string cellsOfScene(const std::string& file) {
    const scene::Scene scene = scene::loadScene(file);
    return fmt::format("{} {} {}\n", scene.rules.columns, scene.rules.rows, scene.terrain.cellSize());
}

}  // namespace walls
