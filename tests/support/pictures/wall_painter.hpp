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
#include "scene/model/scene.hpp"
#include "tests/support/pictures/sample_scene.hpp"
#include "walls/canvas.hpp"
#include "walls/projection.hpp"

/// Walls that are drawn tile by tile in one process, as their ranks would draw them.
namespace sample {

using pictures::Image;

/// Dunes with a furrow through them. The tool is still in the sand.
struct DugScene {
    scene::Scene scene = ballInDunes();
    sand::Replica replica{scene};

    DugScene() {
        drag(replica, scene, {0.4, 0.4, 0.07}, {1.5, 0.6, 0.06});
        drag(replica, scene, {1.5, 0.6, 0.06}, {1.3, 1.5, 0.09});
    }

private:
    static scene::Scene ballInDunes() {
        scene::Scene dunes = duneScene(128);
        dunes.rules.tuning.tool.radius *= 2;
        return dunes;
    }
};

inline std::filesystem::path wallFolder() { return std::filesystem::path(SANDWALL_SOURCE_DIR) / "walls/configs"; }

/// Returns the files of walls/configs, in the order of their names. Throws if there is no file.
[[nodiscard]] std::vector<std::string> wallNames();

/// Returns the same display with each side of a tile `by` times shorter in pixels, at least one pixel.
[[nodiscard]] walls::Wall reduced(walls::Wall wall, int by);

/// Returns the same display with smaller tiles. One number divides the sides of all tiles: the least that divides them
/// without remainder and leaves at most `mostPixels` pixels in the whole picture.
[[nodiscard]] walls::Wall smallWall(const walls::Wall& full, int mostPixels);

[[nodiscard]] Image pictureOf(const render_node::EyeTarget& target);

/// Draws the sand as seen through one screen. `sand` must have the wall's stage (makeView). `depth` receives GL's
/// depths, the lowest row first.
[[nodiscard]] Image drawThrough(render_node::ScenePainter& sand, const walls::Wall& wall, const walls::Screen& screen,
                                glm::ivec2 pixels, walls::Eye eye, std::vector<float>* depth = nullptr);
[[nodiscard]] render_node::ScenePainter makeView(const DugScene& dug, const walls::Wall& wall);
/// Returns the matrix from the scene to the wall's room.
[[nodiscard]] glm::dmat4 sceneToRoom(const walls::Wall& wall, const scene::Scene& scene);

/// Returns the pictures of a tile's outputs, in their order. An output that shows the eyes in turn gives the left
/// picture, then the right one.
[[nodiscard]] std::vector<Image> outputsOf(render_node::ScenePainter& sand, const walls::Wall& wall,
                                           const walls::Tile& tile);

/// Returns one picture of all outputs of the wall, with black bezels. First outputs are at their places on the wall;
/// second outputs, or second eyes, are below them.
[[nodiscard]] Image wallOfOutputs(const walls::Wall& wall, const std::vector<std::vector<Image>>& outputsByTile);

/// Returns one picture of everything that the wall shows of the sand.
[[nodiscard]] Image wallPicture(render_node::ScenePainter& sand, const walls::Wall& wall);

/// Ball over or in the sand, in the scene's axes [scene unit].
struct Ball {
    glm::dvec3 centre;
    double radius;
    glm::dvec3 sun;                                     // direction towards the sun
    std::function<double(const glm::dvec2&)> groundAt;  // height of the sand at a place
};
[[nodiscard]] Ball ballOf(const DugScene& dug);

/// Returns the pixels, in a picture of all outputs (wallOfOutputs), that may show the ball, its shadow, or sand that it
/// dims. The result is a box for every tile and eye, from the geometry alone.
[[nodiscard]] pictures::Mask partOfBall(const Ball& ball, const glm::dmat4& sceneToRoom, const walls::Wall& wall);

/// Returns one picture of every tile's pattern for one eye.
[[nodiscard]] Image patternOfWall(const walls::Wall& wall, lockstep::Pattern pattern, walls::Eye eye,
                                  std::uint64_t frame = 0);

}  // namespace sample
