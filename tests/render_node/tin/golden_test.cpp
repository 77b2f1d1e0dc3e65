// SPDX-License-Identifier: Apache-2.0
// Figures 1 and 3 of Purchart et al. 2012 on a TIN, drawn in one process.
#include <gtest/gtest.h>

#include <memory>

#include "haptic_bridge/devices/strokes.hpp"
#include "render_node/gl/gl_context.hpp"
#include "sand/tin/geometry/surface_view.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/support/pictures/golden_pictures.hpp"
#include "tests/support/pictures/wall_painter.hpp"

namespace {

using pictures::Image;
using sand::kProbePerCell;

scene::Scene sceneOf(const std::string& name) {
    return scene::loadScene(std::filesystem::path(SANDWALL_SOURCE_DIR) / "scenes" / (name + ".toml"));
}

void step(sand::Replica& replica, bool engaged, std::vector<sand::ProbePoint> path, const sand::Edit& edit = {}) {
    replica.apply(
        {.epoch = 1, .number = replica.stepNumber() + 1, .engaged = engaged, .path = std::move(path), .edit = edit});
}

/// Moves a scripted hand over sand that is level at the start, at four places per step.
void write(sand::Replica& replica, const scene::Scene& scene, const haptic_bridge::Strokes& strokes) {
    haptic_bridge::StrokeDevice device(strokes);
    const double half = 0.5 * std::min(scene.rules.columns, scene.rules.rows) * kProbePerCell;
    const double level = static_cast<double>(scene.referenceHeight()) * kProbePerCell / sand::kUnitsPerCell;
    const auto lattice = [](double at) { return static_cast<std::int32_t>(std::lround(at)); };
    for (int tick = 0; !device.finished(tick / 240.0);) {
        std::vector<sand::ProbePoint> path;
        bool engaged = false;
        for (int i = 0; i < 4; ++i) {
            const haptic_bridge::Pose pose = device.read(tick++ / 240.0);
            engaged = pose.engaged;
            path.push_back({lattice(half * (1 + pose.x)), lattice(half * (1 + pose.y)),
                            lattice(level + pose.z * scene.rules.tuning.tool.radius)});
        }
        step(replica, engaged, path);
    }
}

class GoldenTin : public testing::Test {
protected:
    std::unique_ptr<render_node::GlContext> context_ =
        render_node::makeOffscreenContext(render_node::Backend::automatic);
};

TEST_F(GoldenTin, GisIsWrittenAcrossTheWall) {
    const scene::Scene scene = sceneOf("gis_tin");
    sand::Replica replica(scene);
    write(replica, scene, haptic_bridge::Strokes::parse(haptic_bridge::gisStrokes(), "gis"));
    step(replica, false, {}, sand::Edit::settle);
    const walls::Wall wall =
        sample::smallWall(walls::loadWall(sample::wallFolder() / "tiled_3x4.toml"), golden::kMostPixels);
    render_node::ScenePainter view(scene, replica.surface().data(), sample::sceneToRoom(wall, scene));
    view.setTool(replica.probe(), false);
    const double unit = replica.cellSize() / kProbePerCell, ground = scene.referenceHeight() * scene.terrain.unit();
    const sand::ProbePoint probe = replica.probe();
    const std::vector<double>& sun = scene.look.sunDirection;
    const sample::Ball ball{glm::dvec3(probe.x, probe.y, probe.z) * unit,
                            scene.rules.tuning.tool.radius * unit,
                            {sun[0], sun[1], sun[2]},
                            [ground](const glm::dvec2&) { return ground; }};
    golden::expect(golden::folder("golden_tin"), "gis", sample::wallPicture(view, wall),
                   sample::partOfBall(ball, sample::sceneToRoom(wall, scene), wall));
}

/// Presses a stamp into the sand and takes it away. `radius` is half of its length, and `heading` is the direction of
/// its length.
void imprint(sand::Replica& replica, const glm::dvec2& place, double radius, double heading /* [degree] */) {
    const double probe = replica.cellSize() / kProbePerCell;  // [scene unit]
    constexpr double kDepth = 0.06;                           // [scene unit], below the sand's mean height
    sand::Tuning stamp = replica.rules().tuning;
    stamp.tool.halfWidth = static_cast<std::int32_t>(radius / probe * stamp.tool.halfWidth / stamp.tool.radius);
    stamp.tool.radius = static_cast<std::int32_t>(radius / probe);
    stamp.tool.heading = sand::headingOf(heading).value();
    const auto at = [&](double height) {
        return sand::ProbePoint{static_cast<std::int32_t>(place.x / probe), static_cast<std::int32_t>(place.y / probe),
                                static_cast<std::int32_t>((height + radius) / probe)};
    };
    step(replica, false, {at(0.5)}, sand::Edit::tuned(stamp));
    step(replica, true, {at(0.2 - kDepth)});
    step(replica, false, {at(0.5)});
}

TEST_F(GoldenTin, ThreeEllipsesAreImprintedAndTheirBordersMarked) {
    const scene::Scene scene = sceneOf("ellipses");
    sand::Replica replica(scene);
    imprint(replica, {0.55, 1.3}, 0.36, 35);
    imprint(replica, {1.45, 1.4}, 0.28, -20);
    imprint(replica, {1.1, 0.6}, 0.2, 80);
    step(replica, false, {}, sand::Edit::settle);
    const render_node::Camera camera = sample::camera({1, 0.2, 1.9}, {1, 0.95, 0.2});
    const render_node::EyeTarget target(240, 180);
    render_node::ScenePainter view(scene, replica.surface().data(), glm::dmat4(1));
    Image both(2 * target.width(), target.height());
    for (const bool wires : {false, true}) {
        lockstep::Overlays layers;
        layers.set(lockstep::Overlay::wireframe, wires);
        view.setLayers(layers);
        view.draw(camera, target);
        pictures::blit(both, sample::pictureOf(target), wires ? target.width() : 0, 0);
    }
    golden::expect(golden::folder("golden_tin"), "ellipses", both);
}

}  // namespace
