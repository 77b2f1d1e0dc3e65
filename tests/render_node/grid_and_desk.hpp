// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <memory>

#include "render_node/gl/gl_context.hpp"
#include "tests/support/pictures/wall_painter.hpp"
#include "walls/stereo_change.hpp"

/// A small wall with screens in two planes, and the dunes that it shows. Tests of what viewers see share it.
namespace sample {

inline constexpr glm::ivec2 kEyePixels(160, 120);
inline constexpr double kEyesApart = 0.065;                   // [m]
inline const glm::dvec3 kHeadAt(0.1, 1.5, 2.5);               // [m]
inline constexpr double kScreenWide = 1, kScreenHigh = 0.75;  // [m], of each screen
inline constexpr double kDeskHigh = 0.38, kDeskFront = 0.8;   // [m]

/// Returns a wall of two neighbouring tiles in the plane z = 0, and a desk in front of them.
inline walls::Wall gridAndDesk(walls::Stereo stereo) {
    walls::Wall wall;
    wall.viewer = {kHeadAt, kEyesApart, {1, 0, 0}};
    wall.clip = {0.1, 20};
    wall.stage = {{0, 1.1, 0}, 1.9, 40, 0};
    wall.grid = walls::Grid{1, 2, {kScreenWide, kScreenHigh}, {0.0125, 0}, kEyePixels, {-1.00625, 0.7, 0}};
    wall.tiles = walls::tilesOf(*wall.grid, wall.stereo);
    walls::Tile desk;
    desk.rank = 3;
    desk.name = "desk";
    desk.screen = {
        {-0.5, kDeskHigh, kDeskFront}, {0.5, kDeskHigh, kDeskFront}, {-0.5, kDeskHigh, kDeskFront - kScreenHigh}};
    desk.pixels = kEyePixels;
    wall.tiles.push_back(desk);
    return walls::shownIn(wall, stereo);
}

/// Returns the camera of an eye that looks at tile 0, tile 1 or the desk. It is computed without walls::viewOf() and
/// walls::eyePosition().
inline render_node::Camera cameraByHand(std::size_t tile, walls::Eye eye) {
    const double aside = eye == walls::Eye::left ? -kEyesApart / 2 : eye == walls::Eye::right ? kEyesApart / 2 : 0;
    const glm::dvec3 at(kHeadAt.x + aside, kHeadAt.y, kHeadAt.z);
    const double left = tile == 0 ? -1.00625 : tile == 1 ? 0.00625 : -0.5;
    // A desk is seen from above, so that its top edge is the far one.
    const double distance = tile == 2 ? at.y - kDeskHigh : at.z;
    const double bottom = tile == 2 ? at.z - kDeskFront : 0.7 - at.y;
    const double toNear = 0.1 / distance;
    const glm::dmat4 projection = glm::frustum((left - at.x) * toNear, (left + kScreenWide - at.x) * toNear,
                                               bottom * toNear, (bottom + kScreenHigh) * toNear, 0.1, 20.0);
    const glm::dvec3 ahead = tile == 2 ? glm::dvec3(0, -1, 0) : glm::dvec3(0, 0, -1);
    const glm::dvec3 up = tile == 2 ? glm::dvec3(0, 0, -1) : glm::dvec3(0, 1, 0);
    return {projection * glm::lookAt(at, at + ahead, up), at};
}

/// Dunes in front of the wall, a viewer, and a hand with a large tool that digs a furrow.
class GridAndDesk : public testing::Test {
protected:
    GridAndDesk() { scene_.rules.tuning.tool.radius *= 2; }
    [[nodiscard]] sand::Replica dug(int steps = 4) const {
        sand::Replica replica(scene_);
        for (int i = 0; i < steps; ++i) {
            dig(replica);
        }
        return replica;
    }
    void dig(sand::Replica& replica) const {
        const double along = 0.05 * static_cast<double>(replica.stepNumber());
        replica.apply({0, replica.stepNumber() + 1, true, {probeAt(scene_, {0.8 + along, 0.9, 0.06})}});
    }
    [[nodiscard]] glm::dmat4 sceneToRoom() const {
        return sample::sceneToRoom(gridAndDesk(walls::Stereo::mono), scene_);
    }
    [[nodiscard]] lockstep::ViewState view() const {
        lockstep::ViewState state;
        for (std::size_t i = 0; i < 3; ++i) {
            state.head.at(i) = kHeadAt[static_cast<int>(i)];
        }
        state.eyeSeparation = kEyesApart;
        for (int i = 0; i < 16; ++i) {
            state.sceneToRoom.at(static_cast<std::size_t>(i)) = sceneToRoom()[i / 4][i % 4];
        }
        return state;
    }

    std::unique_ptr<render_node::GlContext> context_ =
        render_node::makeOffscreenContext(render_node::Backend::automatic);
    scene::Scene scene_ = duneScene(128);
};

}  // namespace sample
