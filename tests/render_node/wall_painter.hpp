// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "pictures/compare.hpp"
#include "pictures/image.hpp"
#include "render_node/overlay/test_pattern.hpp"
#include "render_node/scene_painter.hpp"
#include "render_node/stereo_composer.hpp"
#include "scene/scene.hpp"
#include "tests/support/sample_scene.hpp"
#include "walls/canvas.hpp"
#include "walls/projection.hpp"

/// Walls drawn tile by tile in one process, as their ranks would.
namespace sample {

using pictures::Image;

/// Dunes with a furrow dug through them, the tool still in the sand.
struct DugScene {
    scene::Scene scene = ballInDunes();
    sand::Replica terrain{scene};

    DugScene() {
        drag(terrain, scene, {0.4, 0.4, 0.07}, {1.5, 0.6, 0.06});
        drag(terrain, scene, {1.5, 0.6, 0.06}, {1.3, 1.5, 0.09});
    }

private:
    static scene::Scene ballInDunes() {
        scene::Scene dunes = duneScene(128);
        dunes.rules.toolRadius *= 2;
        return dunes;
    }
};

inline std::filesystem::path wallFolder() { return std::filesystem::path(SANDWALL_SOURCE_DIR) / "walls/configs"; }

/// The files of walls/configs, in the order of their names. Throws if there is none.
[[nodiscard]] std::vector<std::string> wallNames();

/// The same display with each side of a tile `by` times shorter in pixels, at least one.
[[nodiscard]] walls::Wall reduced(walls::Wall wall, int by);

/// The same display with as many pixels as divide those of every tile, and at most so many from end to end.
[[nodiscard]] walls::Wall smallWall(const walls::Wall& full, int mostPixels);

[[nodiscard]] Image pictureOf(const render_node::EyeTarget& target);

/// Draws the sand as seen through one screen. `sand` must have the wall's stage (makeView). `depth` takes GL's depths,
/// the lowest row first.
[[nodiscard]] Image drawThrough(render_node::ScenePainter& sand, const walls::Wall& wall, const walls::Screen& screen,
                                glm::ivec2 pixels, walls::Eye eye, std::vector<float>* depth = nullptr);
[[nodiscard]] render_node::ScenePainter makeView(const DugScene& dug, const walls::Wall& wall);
/// Where the wall has the sand stand.
[[nodiscard]] glm::dmat4 sceneToRoom(const walls::Wall& wall, const scene::Scene& scene);

/// What the outputs of a tile show, in their order; an output that shows the eyes in turn gives the left, then the
/// right.
[[nodiscard]] std::vector<Image> outputsOf(render_node::ScenePainter& sand, const walls::Wall& wall,
                                           const walls::Tile& tile);

/// One picture of all that the wall's outputs show, bezels black: first outputs as they stand on the wall, second
/// ones, or second eyes, below.
[[nodiscard]] Image wallOfOutputs(const walls::Wall& wall, const std::vector<std::vector<Image>>& outputsByTile);

/// All that the wall shows of the sand.
[[nodiscard]] Image wallPicture(render_node::ScenePainter& sand, const walls::Wall& wall);

/// A ball over or in sand, in the scene's axes [scene unit].
struct Ball {
    glm::dvec3 centre;
    double radius;
    glm::dvec3 sun;                                     // the direction towards it
    std::function<double(const glm::dvec2&)> groundAt;  // height of the sand at a place
};
[[nodiscard]] Ball ballOf(const DugScene& dug);

/// Returns which pixels of a picture of all outputs (wallOfOutputs) may show the ball, its shadow, or sand that it
/// dims: a box for every tile and eye, from the geometry alone.
[[nodiscard]] pictures::Mask partOfBall(const Ball& ball, const glm::dmat4& sceneToRoom, const walls::Wall& wall);

/// Every tile's pattern for one eye, put together.
[[nodiscard]] Image patternOfWall(const walls::Wall& wall, lockstep::Pattern pattern, walls::Eye eye,
                                  std::uint64_t frame = 0);

}  // namespace sample
