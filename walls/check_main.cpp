// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <optional>
#include <string>

#include "base/input_error.hpp"
#include "host/command_line.hpp"
#include "host/memory.hpp"
#include "host/version.hpp"
#include "host/whole_file.hpp"
#include "walls/check_scene.hpp"
#include "walls/desk_windows.hpp"
#include "walls/draft/new_wall.hpp"
#include "walls/wall.hpp"
#include "walls/wall_report.hpp"
#include "walls/wall_svg.hpp"

namespace {

struct Options {
    std::string wall, newGrid, scene, stereo, svg, desk;
    bool mono = false, ranks = false, hosts = false, outputs = false, cells = false, memory = false,
         noCheckpoints = false, freeMemory = false;
};

walls::Wall wallOf(const Options& options) {
    const walls::Wall wall = walls::loadWallAs(options.wall, options.mono ? "mono" : options.stereo);
    return options.desk.empty()
               ? wall
               : walls::placedOnDesk(wall, walls::DeskArea::parse(options.desk, "--desk"), options.wall);
}

int check(const Options& options) {
    if (options.freeMemory) {
        fmt::print("free {}\n", host::freeMemory());
        return 0;
    }
    if (options.cells && options.scene.empty()) {
        throw base::InputError("--cells: name a scene with --scene");
    }
    if (options.wall.empty() && (options.scene.empty() || options.memory)) {
        throw base::InputError(options.memory ? "--memory: name a WALL, too" : "name a WALL, or a scene with --scene");
    }
    if (!options.newGrid.empty()) {
        if (options.wall.empty()) {
            throw base::InputError("--new: name the file that is written, such as my_wall.toml");
        }
        walls::writeNewWall(options.wall, options.newGrid);
        fmt::print("{}: written; change its values to those of your wall\n", options.wall);
    }
    const std::optional<walls::Wall> known = options.wall.empty() ? std::nullopt : std::optional(wallOf(options));
    if (options.memory) {
        fmt::print("{}", walls::memoryLines(options.scene, *known, !options.noCheckpoints));
        return 0;
    }
    if (!options.scene.empty()) {
        fmt::print("{}", options.cells ? walls::cellsOfScene(options.scene)
                                       : walls::describeScene(options.scene, known ? &*known : nullptr));
    }
    if (!known) {
        return 0;
    }
    const walls::Wall& wall = *known;
    if (!options.svg.empty()) {
        host::WholeFile file(options.svg);
        file.stream() << walls::drawingOf(wall);
        file.keep();
    }
    if (options.ranks) {
        fmt::print("{}\n", wall.ranks());
    } else if (options.outputs) {
        fmt::print("{}", walls::outputsLine(wall));
    } else {
        fmt::print("{}", options.hosts ? walls::hostLines(wall) : walls::describe(wall));
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    if (host::answersVersion(argc, argv, "sandwall-check")) {
        return 0;
    }
    host::CommandLine line("Checks a wall file or a scene file and prints what it describes.", "sandwall-check");
    Options options;
    line.option("WALL", options.wall, "a wall file (docs/wall_files.md)");
    line.option("--new", options.newGrid, "write the wall file first: a grid of displays, such as 2x2")
        .metavar("ROWSxCOLUMNS");
    line.option("--scene", options.scene, "check this scene file, too, and print units and no data of its terrain");
    const host::Option stereo = line.option("--stereo", options.stereo, "check it as shown in this mode");
    line.flag("--cells", options.cells, "print only columns, rows and cell size [scene unit] of the scene");
    line.flag("--mono", options.mono, "check it as shown without stereo").excludes(stereo);
    line.option("--desk", options.desk,
                "check it as shown in windows on this area of a desktop, instead of where its file places them")
        .metavar("WIDTHxHEIGHT+X+Y")
        .excludes(stereo);
    line.option("--svg", options.svg, "draw front view and plan into this file");
    const host::Option ranks = line.flag("--ranks", options.ranks, "print only the number of render ranks");
    const host::Option hosts = line.flag("--hosts", options.hosts, "print only the host of each rank from 1, or '-'");
    hosts.excludes(ranks);
    const host::Option memory =
        line.flag(
                "--memory", options.memory,
                "print only the memory of each process with this --scene: server, master or rank, then bytes at rest, "
                "at the peak of the start, with all sand moving, and shared by such processes on a host")
            .excludes(ranks)
            .excludes(hosts);
    line.flag("--no-checkpoints", options.noCheckpoints, "with --memory: of a master that writes no checkpoints");
    line.flag("--free-memory", options.freeMemory,
              "print only the memory that is free on this machine, or in this control group [byte]");
    line.flag("--outputs", options.outputs, "print only the number of outputs, and of those with a place on a screen")
        .excludes(ranks)
        .excludes(hosts)
        .excludes(memory);
    return host::runMain(line, argc, argv, [&] { return check(options); });
}
