// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl_check.hpp"

#include <fmt/format.h>

#include <iostream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "base/input_error.hpp"
#include "host/command_line.hpp"
#include "render_node/gl/gl_context.hpp"
#include "walls/wall.hpp"

namespace render_node {
namespace {

struct Options {
    int rank = 0;
    Backend backend = Backend::automatic;
    bool json = false;
};

int probe(const Options& options) {
    const int rank = options.rank;
    walls::Wall wall;
    std::unique_ptr<GlContext> context;
    if (rank == 0) {
        context = makeOffscreenContext(options.backend);
    } else {
        wall = walls::parseWall(std::string{std::istreambuf_iterator<char>(std::cin), {}}, "standard input");
        if (rank > wall.ranks()) {
            throw base::InputError(
                fmt::format("--probe: the wall on standard input has {} ranks, not {}", wall.ranks(), rank));
        }
        context = makeContext(options.backend, wall, wall.tiles[static_cast<std::size_t>(rank - 1)]);
    }
    if (options.json) {
        nlohmann::ordered_json found{{"backend", context->name()},
                                     {"renderer", context->renderer()},
                                     {"shortcomings", context->windows().shortcomings()}};
        if (const auto area = context->windows().workArea()) {
            const glm::ivec2 size = area->high - area->low;
            found["work_area"] = {{"x", area->low.x}, {"y", area->low.y}, {"width", size.x}, {"height", size.y}};
        }
        fmt::print("{}\n", found.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
        return 0;
    }
    fmt::print("{}: {}\n", context->name(), context->renderer());
    for (const std::string& line : context->windows().shortcomings()) {
        fmt::print("{}\n", line);
    }
    return 0;
}

}  // namespace

int probeMain(int argc, char** argv) {
    host::CommandLine line(
        "Checks a render rank's backend and windows on this machine. Reads the wall file from standard input.",
        "sandwall-render-node");
    Options options;
    line.option("--probe", options.rank, "rank of the wall; 0: off screen, without a wall").range(0, walls::kMaxTiles);
    line.choice("--gl", options.backend, "backend; docs/backends.md");
    line.flag("--json", options.json,
              "print an object with backend, renderer, a list of shortcomings, and the desktop's area for windows");
    return host::runMain(line, argc, argv, [&] { return probe(options); });
}

}  // namespace render_node
