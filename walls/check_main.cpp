// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

#include "files/command_line.hpp"
#include "walls/wall.hpp"
#include "walls/wall_report.hpp"

int main(int argc, char** argv) {
    CLI::App app{"Checks a wall file and prints what it describes.", "sandwall-check"};
    std::string file;
    bool ranks = false;
    app.add_option("WALL", file, "a wall file (docs/wall_files.md)")->required();
    app.add_flag("--ranks", ranks, "print only the number of render ranks");
    return files::runMain(app, argc, argv, [&] {
        const walls::Wall wall = walls::loadWall(file);
        fmt::print("{}", ranks ? fmt::format("{}\n", wall.ranks()) : walls::describe(wall));
        return 0;
    });
}
