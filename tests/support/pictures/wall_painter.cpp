// SPDX-License-Identifier: Apache-2.0
#include "tests/support/pictures/wall_painter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "pictures/stereo_packing.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/sand/sand_of.hpp"

namespace sample {
namespace {

constexpr int kGap = 4;  // [pixel], between the pictures of different outputs of a tile

render_node::Camera cameraOf(const walls::Wall& wall, const walls::Screen& screen, walls::Eye eye) {
    const glm::dvec3 position = walls::eyePosition(wall.viewer, eye);
    return {walls::viewOf(screen, position, wall.clip.near, wall.clip.far).viewProjection, position};
}

/// Returns the wall for the layout of its outputs: with the sizes of the outputs' buffers instead of the sizes of the
/// eyes' pictures.
walls::Wall ofBuffers(walls::Wall wall) {
    for (walls::Tile& tile : wall.tiles) {
        tile.pixels = walls::outputPixels(wall.stereo, tile.pixels);
    }
    if (wall.grid) {
        wall.grid->tilePixels = walls::outputPixels(wall.stereo, wall.grid->tilePixels);
    }
    return wall;
}

/// Returns the place where the line from the sun through the ball's centre meets the sand.
glm::dvec3 shadowOf(const Ball& ball) {
    const glm::dvec3 step = glm::normalize(ball.sun) * (0.1 * ball.radius);
    glm::dvec3 place = ball.centre;
    while (place.z > ball.groundAt(glm::dvec2(place))) {
        place -= step;
    }
    return place;
}

/// Returns a mask of one tile, as one eye sees it: white in the box around the ball and its shadow, black elsewhere. If
/// the box begins behind the eye, the tile sees no part of it. If the box begins in front of the eye and ends behind
/// it, it would cover the whole tile.
Image boxOf(const Ball& ball, const glm::dmat4& sceneToClip, glm::ivec2 pixels) {
    // Lengths in radii of the ball. The ball dims sand up to a distance of 1.8 (docs/look.md). A shadow on level sand
    // is an ellipse, longer by the sine of the sun's height. It extends 1.48 to either side under this sun, plus 0.2 of
    // penumbra.
    constexpr double kReach = 2;
    glm::dvec2 low(std::numeric_limits<double>::max()), high(-low);
    for (const glm::dvec3& centre : {ball.centre, shadowOf(ball)}) {
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 side(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
            const glm::dvec4 clip = sceneToClip * glm::dvec4(centre + kReach * ball.radius * (2.0 * side - 1.0), 1);
            if (clip.w > 0) {
                const glm::dvec2 at = (glm::dvec2(clip.x, -clip.y) / clip.w + 1.0) / 2.0 * glm::dvec2(pixels);
                low = glm::min(low, at);
                high = glm::max(high, at);
            }
        }
    }
    Image box(pixels.x, pixels.y);
    const glm::ivec2 from = glm::clamp(glm::floor(low), glm::dvec2(0), glm::dvec2(pixels));
    const glm::ivec2 to = glm::clamp(glm::ceil(high), glm::dvec2(0), glm::dvec2(pixels));
    for (int y = from.y; y < to.y && from.x < to.x; ++y) {
        std::fill_n(box.at(from.x, y), static_cast<std::ptrdiff_t>(to.x - from.x) * pictures::kChannels,
                    std::uint8_t{255});
    }
    return box;
}

}  // namespace

std::vector<std::string> wallNames() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(wallFolder())) {
        if (entry.path().extension() == ".toml") {
            names.push_back(entry.path().stem().string());
        }
    }
    if (names.empty()) {
        throw std::runtime_error("no wall file in " + wallFolder().string() +
                                 ": a test of all of them would test nothing");
    }
    std::sort(names.begin(), names.end());
    return names;
}

walls::Wall reduced(walls::Wall wall, int by) {
    const auto smaller = [by](glm::ivec2 pixels) { return glm::max(pixels / by, glm::ivec2(1)); };
    for (walls::Tile& tile : wall.tiles) {
        tile.pixels = smaller(tile.pixels);
    }
    if (wall.grid) {
        wall.grid->tilePixels = smaller(wall.grid->tilePixels);
    }
    return wall;
}

walls::Wall smallWall(const walls::Wall& full, int mostPixels) {
    const walls::Canvas canvas = walls::wallCanvas(full);
    const auto divides = [&](int by) {
        return std::all_of(full.tiles.begin(), full.tiles.end(),
                           [by](const walls::Tile& t) { return t.pixels.x % by == 0 && t.pixels.y % by == 0; });
    };
    int by = 1;
    while (canvas.width / by * (canvas.height / by) > mostPixels || !divides(by)) {
        ++by;
    }
    return reduced(full, by);
}

Image pictureOf(const render_node::EyeTarget& target) {
    Image image(target.width(), target.height());
    image.rgb = target.read();
    return image;
}

glm::dmat4 sceneToRoom(const walls::Wall& wall, const scene::Scene& scene) {
    const double cell = scene.terrain.cellSize();
    return walls::stageToRoom(wall.stage, scene.rules.columns * cell, scene.rules.rows * cell,
                              static_cast<double>(scene.referenceHeight()) * cell / sand::kUnitsPerCell);
}

render_node::ScenePainter makeView(const DugScene& dug, const walls::Wall& wall) {
    render_node::ScenePainter view(dug.scene, sceneToRoom(wall, dug.scene));
    view.update(dug.replica.surface().data(), {});
    view.setTool(dug.replica.probe(), true);
    return view;
}

Image drawThrough(render_node::ScenePainter& sand, const walls::Wall& wall, const walls::Screen& screen,
                  glm::ivec2 pixels, walls::Eye eye, std::vector<float>* depth) {
    const render_node::EyeTarget target(pixels.x, pixels.y);
    sand.draw(cameraOf(wall, screen, eye), target);
    Image image = pictureOf(target);
    if (depth != nullptr) {
        depth->resize(image.pixels());
        glReadPixels(0, 0, pixels.x, pixels.y, GL_DEPTH_COMPONENT, GL_FLOAT, depth->data());
    }
    return image;
}

std::vector<Image> outputsOf(render_node::ScenePainter& sand, const walls::Wall& wall, const walls::Tile& tile) {
    std::vector<render_node::EyeTarget> targets;
    for (const walls::Eye eye : walls::eyesOf(wall.stereo)) {
        targets.emplace_back(tile.pixels.x, tile.pixels.y);
        sand.draw(cameraOf(wall, tile.screen, eye), targets.back());
    }
    render_node::StereoComposer composer(wall.stereo, tile);
    composer.compose(targets);
    std::vector<Image> images;
    for (const render_node::OutputPicture& output : composer.shown(targets)) {
        images.push_back(pictureOf(*output.picture));
        if (output.right != nullptr) {
            images.push_back(pictureOf(*output.right));
        }
    }
    return images;
}

Image wallOfOutputs(const walls::Wall& wall, const std::vector<std::vector<Image>>& outputsByTile) {
    const walls::Canvas canvas = walls::wallCanvas(ofBuffers(wall));
    const auto most = std::max_element(outputsByTile.begin(), outputsByTile.end(), [](const auto& a, const auto& b) {
                          return a.size() < b.size();
                      })->size();
    const int step = canvas.height + kGap;
    Image whole(canvas.width, static_cast<int>(most) * step - kGap);
    for (std::size_t tile = 0; tile < outputsByTile.size(); ++tile) {
        for (std::size_t i = 0; i < outputsByTile[tile].size(); ++i) {
            pictures::blit(whole, outputsByTile[tile][i], canvas.tiles[tile].x,
                           canvas.tiles[tile].y + static_cast<int>(i) * step);
        }
    }
    return whole;
}

Image wallPicture(render_node::ScenePainter& sand, const walls::Wall& wall) {
    std::vector<std::vector<Image>> outputs;
    for (const walls::Tile& tile : wall.tiles) {
        outputs.push_back(outputsOf(sand, wall, tile));
    }
    return wallOfOutputs(wall, outputs);
}

Ball ballOf(const DugScene& dug) {
    const double cell = dug.scene.terrain.cellSize();
    const sand::ProbePoint probe = dug.replica.probe();
    const std::vector<double>& sun = dug.scene.look.sunDirection;
    const sand::HeightField* field = &samples::fieldOf(dug.replica);
    return {glm::dvec3(probe.x, probe.y, probe.z) * (cell / sand::kProbePerCell),
            dug.scene.rules.tuning.tool.radius * (cell / sand::kProbePerCell),
            {sun[0], sun[1], sun[2]},
            [field, cell](const glm::dvec2& place) {
                const glm::ivec2 last(field->columns() - 1, field->rows() - 1);
                const glm::ivec2 at = glm::clamp(glm::ivec2(glm::floor(place / cell)), glm::ivec2(0), last);
                return field->height(at.x, at.y) * cell / sand::kUnitsPerCell;
            }};
}

pictures::Mask partOfBall(const Ball& ball, const glm::dmat4& sceneToRoom, const walls::Wall& wall) {
    std::vector<std::vector<Image>> outputs;
    for (const walls::Tile& tile : wall.tiles) {
        std::vector<Image> eyes;
        for (const walls::Eye eye : walls::eyesOf(wall.stereo)) {
            eyes.push_back(boxOf(ball, cameraOf(wall, tile.screen, eye).roomToClip * sceneToRoom, tile.pixels));
        }
        if (walls::packsEyes(wall.stereo)) {
            eyes = {pictures::packStereo(wall.stereo, eyes[0], eyes[1])};
        }
        outputs.push_back(std::move(eyes));
    }
    const Image boxes = wallOfOutputs(wall, outputs);
    pictures::Mask mask(boxes.pixels(), 0);
    for (std::size_t i = 0; i < boxes.rgb.size(); ++i) {
        if (boxes.rgb[i] != 0) {
            mask[i / pictures::kChannels] = 1;
        }
    }
    return mask;
}

Image patternOfWall(const walls::Wall& wall, lockstep::Pattern pattern, walls::Eye eye, std::uint64_t frame) {
    const walls::Canvas canvas = walls::wallCanvas(wall);
    Image whole(canvas.width, canvas.height);
    for (std::size_t i = 0; i < wall.tiles.size(); ++i) {
        const walls::Tile& tile = wall.tiles[i];
        const render_node::EyeTarget target(tile.pixels.x, tile.pixels.y);
        render_node::TestPatternView view(wall, tile, "node" + std::to_string(tile.rank));
        view.draw(pattern, eye, frame, target);
        pictures::blit(whole, pictureOf(target), canvas.tiles[i].x, canvas.tiles[i].y);
    }
    return whole;
}

}  // namespace sample
