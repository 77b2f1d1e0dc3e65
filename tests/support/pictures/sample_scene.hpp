// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <initializer_list>
#include <vector>

#include "render_node/scene_painter.hpp"
#include "sand/grid/dunes.hpp"
#include "sand/replica.hpp"
#include "scene/model/scene.hpp"

/// Scenes and cameras that tests and benchmarks of drawing share. One scene unit is a metre in the room.
namespace sample {

inline constexpr double kWidth = 2;  // [scene unit], as in Dorjgotov et al. 2007

inline scene::Scene flatScene(int columns, int rows, double toolRadius = 0.04) {
    scene::Scene scene;
    scene.terrain = sand::HeightField(columns, rows, kWidth / columns);
    scene.rules.columns = columns;
    scene.rules.rows = rows;
    scene.rules.tuning.threshold = 44204;  // 34 degrees
    scene.rules.tuning.startThreshold = 44204;
    scene.rules.tuning.sweepsPerStep = 16;
    scene.rules.stepsPerSecond = 60;
    scene.rules.tuning.tool.radius =
        static_cast<std::int32_t>(toolRadius / scene.terrain.cellSize() * sand::kProbePerCell);
    return scene;
}

inline scene::Scene duneScene(int columns) {
    scene::Scene scene = flatScene(columns, columns);
    sand::grid::makeDunes({}, scene.terrain);
    return scene;
}

/// Returns a change that lists exactly `cells`.
inline sand::SurfaceChange changeOf(const sand::CellRect& cells) {
    return {.whole = false, .parts = sand::CellChange{{cells}}};
}

inline sand::ProbePoint probeAt(const scene::Scene& scene, const glm::dvec3& place) {
    const glm::dvec3 units = place / scene.terrain.cellSize() * double{sand::kProbePerCell};
    return {static_cast<std::int32_t>(units.x), static_cast<std::int32_t>(units.y), static_cast<std::int32_t>(units.z)};
}

/// Drags the tool along a straight line, with a step per centimetre. Then lets the sand settle for 60 steps.
inline void drag(sand::Replica& replica, const scene::Scene& scene, const glm::dvec3& from, const glm::dvec3& to) {
    sand::Step step;
    const int steps = 1 + static_cast<int>(glm::length(to - from) / 0.01);
    for (int i = 0; i <= steps; ++i) {
        step.number = replica.stepNumber() + 1;
        step.engaged = true;
        step.path = {probeAt(scene, glm::mix(from, to, static_cast<double>(i) / steps))};
        replica.apply(step);
    }
    for (int i = 0; i < 60; ++i) {
        replica.apply({0, replica.stepNumber() + 1, false, {}});
    }
}

/// A rectangle of a camera's picture plane, in shares of its width and height from the lower left.
struct Window {
    double left = 0, bottom = 0, right = 1, top = 1;
};

/// Returns the camera of a head at `eye` that looks at the middle of a plane of 2 m × 1.5 m through `target`. The
/// camera shows one window of this plane.
inline render_node::Camera camera(const glm::dvec3& eye, const glm::dvec3& target, const Window& window = {}) {
    constexpr double kNear = 0.05;
    const double half = 0.5 * kNear;  // tangent 0.5: 53 degrees across
    const double low = -0.75 * half;
    const auto x = [&](double share) { return -half + 2 * half * share; };
    const auto y = [&](double share) { return low - 2 * low * share; };
    const glm::dmat4 projection =
        glm::frustum(x(window.left), x(window.right), y(window.bottom), y(window.top), kNear, 30.0);
    const glm::dvec3 up =
        std::abs(target.z - eye.z) > 10 * std::abs(target.y - eye.y) ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    return {projection * glm::lookAt(eye, target, up), eye};
}

/// Returns a set of exactly these layers.
inline lockstep::Overlays layersOf(std::initializer_list<lockstep::Overlay> shown) {
    lockstep::Overlays layers;
    for (const lockstep::Overlay layer : shown) {
        layers.set(layer, true);
    }
    return layers;
}

using Pixels = std::vector<std::uint8_t>;

inline Pixels draw(render_node::ScenePainter& view, const render_node::Camera& camera,
                   const render_node::EyeTarget& target) {
    view.draw(camera, target);
    return target.read();
}

inline glm::ivec3 pixel(const Pixels& pixels, int width, int x, int yFromTop) {
    const std::size_t at =
        3 * (static_cast<std::size_t>(yFromTop) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    return {pixels[at], pixels[at + 1], pixels[at + 2]};
}

}  // namespace sample
