// SPDX-License-Identifier: Apache-2.0
// Measures the CPU time of a wall's frames during digging, in three parts: the sand's steps, the update of the views,
// and drawing. Prints it for all tiles together and for the busiest tile. One process holds a view of the sand for each
// tile, as each rank does. LP_NUM_THREADS=0 keeps all work in this thread.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "bench/draw/moving_sand.hpp"
#include "bench/report/timing.hpp"
#include "host/command_line.hpp"
#include "render_node/gl/gl_context.hpp"
#include "render_node/scene_painter.hpp"
#include "sand/replica.hpp"
#include "scene/load/scene_file.hpp"
#include "walls/projection.hpp"
#include "walls/wall.hpp"
#include "walls/wall_file.hpp"

namespace {

struct Options {
    std::string wall = "walls/configs/tiled_3x4.toml";
    std::string scene = "scenes/writing.toml";
    int frames = 120;
    int rate = 30;  // [frame/s]
    bool json = false;
    bench::MovingSandOptions moving{.wall = "walls/configs/desktop.toml",
                                    .row = {},
                                    .frames = 0,
                                    .pixelsPerQuad = {static_cast<int>(render_node::LevelRule::kPixelsPerQuad)},
                                    .folder = {}};
};

/// A tile with the view and the eyes that its rank has.
struct Tile {
    render_node::ScenePainter view;
    struct Eye {
        render_node::Camera camera;
        render_node::EyeTarget target;
        render_node::EyeMemory memory;
    };
    std::vector<std::unique_ptr<Eye>> eyes;
};

std::vector<std::unique_ptr<Tile>> tilesOf(const walls::Wall& wall, const scene::Scene& scene,
                                           const sand::SurfaceData& start) {
    const sand::HeightField& field = scene.terrain;
    const double cell = field.cellSize();
    const glm::dmat4 sceneToRoom = walls::stageToRoom(wall.stage, scene.rules.columns * cell, scene.rules.rows * cell,
                                                      scene.referenceHeight() * field.unit());
    std::vector<std::unique_ptr<Tile>> tiles;
    for (const walls::Tile& tile : wall.tiles) {
        tiles.push_back(std::make_unique<Tile>(Tile{render_node::ScenePainter(scene, start, sceneToRoom), {}}));
        for (const walls::Eye eye : walls::eyesOf(wall.stereo)) {
            const walls::View seen = walls::viewOf(wall, tile, eye);
            tiles.back()->eyes.push_back(std::make_unique<Tile::Eye>(
                Tile::Eye{{seen.viewProjection, seen.eye}, {tile.pixels.x, tile.pixels.y}, {}}));
        }
    }
    return tiles;
}

/// Returns the hand after `seconds`. It digs rings of all sizes, half a radius deep, at half a side per second, as the
/// stroke list of scripts/figures/sessions/wall_rates.py does.
sand::ProbePoint handAt(const sand::Rules& rules, std::int32_t level, double seconds) {
    double left = 0.5 * seconds;
    double radius = 0.6;
    while (left > 2 * std::numbers::pi * radius) {
        left -= 2 * std::numbers::pi * radius;
        radius = radius > 0.13 ? radius - 0.04 : 0.6;
    }
    const double half = rules.columns / 2.0 * sand::kProbePerCell;
    return {static_cast<std::int32_t>(half * (1 + radius * std::cos(left / radius))),
            static_cast<std::int32_t>(half * (1 + radius * std::sin(left / radius))),
            level / sand::kUnitsPerProbe + rules.tuning.tool.radius / 2};
}

/// Applies the `steps` steps of one frame. Each step has as many samples of the hand as a device gives.
void dig(sand::Replica& replica, std::int32_t level, int steps) {
    constexpr int kSamples = 17;  // per step
    for (int i = 0; i < steps; ++i) {
        sand::Step step{1, replica.stepNumber() + 1, true, {}};
        for (int sample = 1; sample <= kSamples; ++sample) {
            const double at = static_cast<double>(step.number) + static_cast<double>(sample) / kSamples;
            step.path.push_back(handAt(replica.rules(), level, at / replica.rules().stepsPerSecond));
        }
        replica.apply(step);
    }
    (void)replica.stateHash();
}

struct Measured {
    std::vector<double> stepMs, updateMs, drawMs, busiestMs, busiestUpdateMs;  // per frame
    std::vector<double> views, shares;                                         // per frame
    std::vector<double> placesRead;                                            // per frame and tile
    std::vector<double> viewMs, viewTriangles, viewChunks;                     // per view
};

void takeOver(Tile& tile, const sand::Replica& replica, const sand::SurfaceChange& change) {
    render_node::ScenePainter& view = tile.view;
    std::vector<render_node::Camera> cameras;
    for (const auto& eye : tile.eyes) {
        cameras.push_back(eye->camera);
    }
    view.update(replica.surface().data(), change, cameras);
    view.setTool(replica.probe(), replica.engaged(), replica.tool());
}

/// Updates the views with the changes since the last call, and draws them, tile by tile.
void show(const std::vector<std::unique_ptr<Tile>>& tiles, sand::Replica& replica, Measured& measured) {
    sand::SurfaceChange change;
    const double listed = bench::secondsOf([&] { change = replica.takeChange(); });  // each rank does this once
    double update = listed * static_cast<double>(tiles.size());
    double read = 0, draw = 0, busiest = 0, busiestUpdate = 0, drawn = 0, pixels = 0, all = 0;
    for (const auto& tile : tiles) {
        const std::int64_t readBefore = tile->view.placesRead();
        const double taken = bench::secondsOf([&] { takeOver(*tile, replica, change); });
        read += static_cast<double>(tile->view.placesRead() - readBefore);
        double both = 0;
        for (const auto& eye : tile->eyes) {
            render_node::PixelRect changed;
            const double spent = bench::secondsOf([&] {
                changed = tile->view.drawIfChanged(eye->camera, eye->target, eye->memory);
                eye->target.finish();
            });
            both += spent;
            all += eye->target.width() * eye->target.height();
            if (!changed.empty()) {
                pixels += static_cast<double>(tile->view.counts().pixels);
                ++drawn;
                measured.viewMs.push_back(1e3 * spent);
                measured.viewTriangles.push_back(tile->view.counts().triangles);
                measured.viewChunks.push_back(tile->view.counts().chunks);
            }
        }
        update += taken;
        draw += both;
        if (listed + taken + both > busiest) {
            busiest = listed + taken + both;
            busiestUpdate = listed + taken;
        }
    }
    measured.updateMs.push_back(1e3 * update);
    measured.placesRead.push_back(read / static_cast<double>(tiles.size()));
    measured.drawMs.push_back(1e3 * draw);
    measured.busiestMs.push_back(1e3 * busiest);
    measured.busiestUpdateMs.push_back(1e3 * busiestUpdate);
    measured.views.push_back(drawn);
    measured.shares.push_back(100 * pixels / all);
}

int measure(const Options& options) {
    const walls::Wall wall = walls::loadWall(options.wall);
    const scene::Scene scene = scene::loadScene(options.scene);
    const auto context = render_node::makeOffscreenContext(render_node::Backend::automatic);
    sand::Replica replica(scene);
    const std::vector<std::unique_ptr<Tile>> tiles = tilesOf(wall, scene, replica.surface().data());
    const std::int32_t level = scene.referenceHeight();
    Measured measured;
    constexpr int kWarmUp = 30;  // [frame]; shaders are compiled, buffers are filled, and the first bank is made
    for (int frame = 0; frame < kWarmUp + options.frames; ++frame) {
        if (frame == kWarmUp) {
            measured = {};
        }
        const int steps = scene.rules.stepsPerSecond / options.rate;
        measured.stepMs.push_back(1e3 * bench::secondsOf([&] { dig(replica, level, steps); }));
        show(tiles, replica, measured);
    }
    if (options.json) {
        const auto median = [](const std::vector<double>& values) { return bench::quantile(values, 0.5); };
        const auto mean = [](const std::vector<double>& values) {
            return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
        };
        const nlohmann::ordered_json json{
            {"step_ms", median(measured.stepMs)},       {"busiest_tile_ms", median(measured.busiestMs)},
            {"update_ms", median(measured.updateMs)},   {"draw_ms", median(measured.drawMs)},
            {"places_read", mean(measured.placesRead)}, {"pixels_percent", mean(measured.shares)}};
        fmt::print("{}\n", json.dump());
        return 0;
    }
    const auto row = [](const char* what, const std::vector<double>& values) {
        fmt::print("{:48} {:8.2f} {:8.2f}\n", what, bench::quantile(values, 0.5), bench::quantile(values, 0.99));
    };
    fmt::print("{} frames at {} per second of {}, {}, {}\n", options.frames, options.rate, wall.name, scene.name,
               context->renderer());
    fmt::print("{:48} {:>8} {:>8}\n", "", "p50", "p99");
    row("steps of one replica [ms/frame]", measured.stepMs);
    row("update of the views, all tiles [ms/frame]", measured.updateMs);
    row("places that a tile reads for it [1/frame]", measured.placesRead);
    row("drawing, all tiles [ms/frame]", measured.drawMs);
    row("the busiest tile, both eyes [ms/frame]", measured.busiestMs);
    row("update of its view [ms/frame]", measured.busiestUpdateMs);
    row("one drawn view [ms]", measured.viewMs);
    row("its triangles of sand", measured.viewTriangles);
    row("its chunks", measured.viewChunks);
    row("views drawn [1/frame]", measured.views);
    row("pixels drawn [% of the wall]", measured.shares);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    host::CommandLine line("Measures the CPU time of a wall's frames during digging.", "redraw_bench");
    line.option("--wall", options.wall, "wall file").showDefault();
    line.option("--scene", options.scene, "scene file").showDefault();
    line.option("--frames", options.frames, "number of frames").range(1, 100000).showDefault();
    line.option("--rate", options.rate, "frames per second of the wall").range(1, 1000).showDefault();
    line.flag("--json", options.json, "print medians per frame as an object: step_ms, busiest_tile_ms, update_ms, …");
    line.option("--moving", options.moving.row, "measure moving sand instead, on --wall or on desktop.toml: a row")
        .oneOf(bench::movingSandRows());
    line.option("--pixels", options.moving.pixelsPerQuad, "with --moving: least pixels of a quad, separated by commas")
        .commaSeparated();
    line.flag("--errors", options.moving.errors, "with --moving: compare with pictures of every cell");
    line.option("--write", options.moving.folder, "with --moving: folder for the frames, as a window shows them");
    return host::runMain(line, argc, argv, [&] {
        if (options.moving.row.empty()) {
            return measure(options);
        }
        options.moving.frames = options.frames;
        bench::measureMovingSand(options.moving);
        return 0;
    });
}
