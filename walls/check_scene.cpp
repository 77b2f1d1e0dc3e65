// SPDX-License-Identifier: Apache-2.0
#include "walls/check_scene.hpp"

#include <fmt/format.h>

#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "scene/load/sand_size.hpp"
#include "scene/load/step_cost.hpp"
#include "scene/model/start_time.hpp"
#include "walls/window_size.hpp"

namespace walls {
namespace {

using scene::MemoryFigures;
using scene::ProcessMemory;

std::string row(const std::string& name, const MemoryFigures& figures) {
    return fmt::format("  {:<34} {:>10} {:>10} {:>10}\n", name, scene::bytesInWords(figures.rest),
                       scene::bytesInWords(figures.peak), scene::bytesInWords(figures.moving));
}

MemoryFigures withoutShared(const ProcessMemory& process) {
    MemoryFigures figures = process.figures();
    figures += {-process.shared(), -process.shared(), -process.shared()};
    return figures;
}

/// Returns the rows of all hosts. Ranks on one host share their code.
std::string hostRows(const scene::SandSize& sand, const Wall& wall) {
    struct Host {
        int ranks = 0;
        MemoryFigures figures;
    };
    std::map<std::string, Host> hosts;
    for (const Tile& tile : wall.tiles) {
        const ProcessMemory rank = ProcessMemory::ofRank(sand, frameBufferBytes(wall, tile));
        Host& host = hosts[tile.place.host];
        host.figures += host.ranks++ == 0 ? rank.figures() : withoutShared(rank);
    }
    Host here = std::exchange(hosts[""], {});
    hosts.erase("");
    here.figures += ProcessMemory::ofServer(sand).figures();
    here.figures += ProcessMemory::ofMaster(sand).figures();
    const auto ranksIn = [](int ranks) { return fmt::format("{} rank{}", ranks, ranks == 1 ? "" : "s"); };
    std::string rows = row(fmt::format("this machine: server, master, {}", ranksIn(here.ranks)), here.figures);
    for (const auto& [name, host] : hosts) {
        rows += row(fmt::format("{}: {}", name, ranksIn(host.ranks)), host.figures);
    }
    return rows;
}

std::string line(const std::string& name, const ProcessMemory& process) {
    const MemoryFigures figures = process.figures();
    return fmt::format("{} {} {} {} {}\n", name, figures.rest, figures.peak, figures.moving, process.shared());
}

/// Returns the memory of each kind of process of a session on this sand, and of each host of the wall. If `wall` is
/// null, a rank has the picture of the desktop wall.
std::string memoryTable(const scene::SandSize& sand, const Wall* wall) {
    constexpr std::int64_t kDesktop = std::int64_t{12} * 1280 * 720;  // [byte] of frame buffers
    std::string text =
        fmt::format("{:<36} {:>10} {:>10} {:>10}\n", "memory of a process at most", "at rest", "start", "all moves");
    text += row("haptic server", ProcessMemory::ofServer(sand).figures());
    text += row("master", ProcessMemory::ofMaster(sand).figures());
    std::map<std::pair<int, int>, ProcessMemory> sizes;
    if (wall == nullptr) {
        return text + row("rank of 1280 x 720 pixels", ProcessMemory::ofRank(sand, kDesktop).figures());
    }
    for (const Tile& tile : wall->tiles) {
        sizes.try_emplace({tile.pixels.x, tile.pixels.y}, ProcessMemory::ofRank(sand, frameBufferBytes(*wall, tile)));
    }
    for (const auto& [pixels, rank] : sizes) {
        text += row(fmt::format("rank of {} x {} pixels", pixels.first, pixels.second), rank.figures());
    }
    return text + hostRows(sand, *wall);
}

}  // namespace

std::string describeScene(const std::string& file, const Wall* wall) {
    scene::SizeCollector sizes;
    const scene::Scene scene = scene::loadScene(file, sizes.checks());
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
    const scene::SandSize sand = sizes.of(scene);
    text += memoryTable(sand, wall);
    return sand.hasHeights() ? text + scene::StartTime::of(sand).text() + "\n" : text;  // estimated for heights only
}

std::string cellsOfScene(const std::string& file) {
    const scene::Scene scene = scene::loadScene(file);
    return fmt::format("{} {} {}\n", scene.rules.columns, scene.rules.rows, scene.terrain.cellSize());
}

std::string memoryLines(const std::string& file, const Wall& wall, bool checkpoints) {
    const std::optional<scene::SandSize> sand = scene::sizeOfScene(file);
    if (!sand) {
        return "";
    }
    const ProcessMemory server = ProcessMemory::ofServer(*sand), master = ProcessMemory::ofMaster(*sand, checkpoints);
    std::string lines = line("server", server) + line("master", master);
    for (const Tile& tile : wall.tiles) {
        lines += line(std::to_string(tile.rank), ProcessMemory::ofRank(*sand, frameBufferBytes(wall, tile)));
    }
    return lines;
}

}  // namespace walls
