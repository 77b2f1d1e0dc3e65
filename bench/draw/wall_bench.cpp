// SPDX-License-Identifier: Apache-2.0
// Compares a redraw of every view of a wall with a bare redraw. The bare one draws every cell of the same chunks, lit
// by one dot product at each vertex, without grain, shadow, box and tool. The two alternate, so that their ratio is
// valid on a busy machine. Times are CPU time; LP_NUM_THREADS=0 keeps all work in this thread.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "bench/report/timing.hpp"
#include "host/command_line.hpp"
#include "render_node/gl/gl_context.hpp"
#include "render_node/gl/gl_program.hpp"
#include "render_node/grid/mesh.hpp"
#include "render_node/scene_painter.hpp"
#include "scene/load/scene_file.hpp"
#include "walls/projection.hpp"
#include "walls/wall.hpp"
#include "walls/wall_file.hpp"

namespace {

const render_node::ShaderSource kBareVertex{"bare vertex shader", R"(
layout(location = 0) in float aHeight;
layout(location = 1) in vec2 aGrid;
layout(location = 2) in vec2 aNormal;
uniform mat4 uSceneToClip;
uniform float uCell;
uniform vec2 uCells;
uniform float uFirst;
out vec3 vColour;
void main() {
    vec3 normal = vec3(aNormal, sqrt(max(1.0 - dot(aNormal, aNormal), 0.0)));
    vColour = vec3(0.8, 0.7, 0.5) * max(dot(normal, vec3(-0.6, 0.4, 0.7)), 0.1);
    gl_Position = uSceneToClip * vec4(clamp(aGrid - uFirst, vec2(0.0), uCells) * uCell, aHeight, 1.0);
})"};
const render_node::ShaderSource kBareFragment{"bare fragment shader", R"(
in vec3 vColour;
out vec4 oColour;
void main() { oColour = vec4(vColour, 1.0); })"};

/// Draws the bare sand.
class BareView {
public:
    explicit BareView(const scene::Scene& scene)
        : mesh_(sand::GridData{scene.terrain}, {0, 0, 1}, scene.rules.stepsPerSecond),
          program_(kBareVertex, {}, kBareFragment) {}

    void draw(const glm::dmat4& sceneToClip, const render_node::EyeTarget& target) {
        target.bind();
        glEnable(GL_DEPTH_TEST);
        glEnable(GL_CULL_FACE);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        program_.use();
        program_.set("uSceneToClip", glm::mat4(sceneToClip));
        mesh_.prepare(program_);
        mesh_.draw(sceneToClip, true, {sceneToClip, {target.width(), target.height()}, 0}, {});
    }

private:
    render_node::GridMesh mesh_;
    render_node::GlProgram program_;
};

std::vector<render_node::Camera> camerasOf(const walls::Wall& wall) {
    std::vector<render_node::Camera> cameras;
    for (const walls::Tile& tile : wall.tiles) {
        for (const walls::Eye eye : walls::eyesOf(wall.stereo)) {
            const walls::View view = walls::viewOf(wall, tile, eye);
            cameras.push_back({view.viewProjection, view.eye});
        }
    }
    return cameras;
}

int measure(const std::string& wallFile, const std::string& sceneFile, int rounds, bool json) {
    const walls::Wall wall = walls::loadWall(wallFile);
    const scene::Scene scene = scene::loadScene(sceneFile);
    const sand::HeightField& field = scene.terrain;
    const glm::dmat4 sceneToRoom =
        walls::stageToRoom(wall.stage, field.columns() * field.cellSize(), field.rows() * field.cellSize(),
                           scene.referenceHeight() * field.unit());
    const auto context = render_node::makeOffscreenContext(render_node::Backend::automatic);
    const glm::ivec2 pixels = wall.tiles.front().pixels;
    const render_node::EyeTarget target(pixels.x, pixels.y);
    const std::vector<render_node::Camera> cameras = camerasOf(wall);
    render_node::ScenePainter sand(scene, sceneToRoom);
    BareView bare(scene);
    std::vector<double> bareMs, sandMs, ratios;
    for (int round = -1; round < rounds; ++round) {  // the first round compiles shaders and fills buffers
        double bareSeconds = 0;
        double sandSeconds = 0;
        for (const render_node::Camera& camera : cameras) {
            bareSeconds += bench::secondsOf([&] {
                bare.draw(camera.roomToClip * sceneToRoom, target);
                target.finish();
            });
            sandSeconds += bench::secondsOf([&] {
                sand.draw(camera, target);
                target.finish();
            });
        }
        if (round >= 0) {
            bareMs.push_back(1e3 * bareSeconds);
            sandMs.push_back(1e3 * sandSeconds);
            ratios.push_back(sandSeconds / bareSeconds);
        }
    }
    if (json) {
        fmt::print("{{\"bare_ms\": {}, \"sand_ms\": {}}}\n", bench::spreadOf(bareMs).median,
                   bench::spreadOf(sandMs).median);
        return 0;
    }
    const bench::Spread ratio = bench::spreadOf(ratios);
    fmt::print("{} views of {}, {}: bare {:.0f} ms, as sand {:.0f} ms, ratio {:.2f} ({:.2f} to {:.2f})\n",
               cameras.size(), wall.name, context->renderer(), bench::spreadOf(bareMs).median,
               bench::spreadOf(sandMs).median, ratio.median, ratio.lowest, ratio.highest);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    std::string wall = "walls/configs/tiled_3x4.toml";
    std::string scene = "scenes/writing.toml";
    int rounds = 5;
    bool json = false;
    host::CommandLine line("Compares the CPU time of a redraw of all views of a wall with that of a bare redraw.",
                           "wall_bench");
    line.option("--wall", wall, "wall file").showDefault();
    line.option("--scene", scene, "scene file").showDefault();
    line.option("--rounds", rounds, "number of drawings of each view").range(1, 1000).showDefault();
    line.flag("--json", json, "print the medians as an object: bare_ms, sand_ms");
    return host::runMain(line, argc, argv, [&] { return measure(wall, scene, rounds, json); });
}
