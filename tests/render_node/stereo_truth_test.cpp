// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "render_node/gl/gl_context.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/pictures/wall_painter.hpp"

namespace {

using pictures::Image;
using walls::Eye;
using walls::Screen;
using walls::Stereo;

class StereoPicture : public testing::Test {
protected:
    std::unique_ptr<render_node::GlContext> context_ =
        render_node::makeOffscreenContext(render_node::Backend::automatic);
};

/// Returns a screen of 0.8 x 0.6 m and 800 x 600 pixels, two metres in front of the viewer.
walls::Wall plainWall() {
    walls::Wall wall;
    wall.viewer.eye = {0, 0.3, 2};
    wall.viewer.eyeSeparation = 0.065;
    wall.clip = {0.1, 20};
    walls::Tile tile;
    tile.name = "plain";
    tile.screen = {{-0.4, 0, 0}, {0.4, 0, 0}, {-0.4, 0.6, 0}};
    tile.pixels = {800, 600};
    wall.tiles = {tile};
    return walls::shownIn(wall, Stereo::passive);
}

/// Returns the middle of a ball in front of an empty background: the middle of all pixels that are not background
/// [pixel].
glm::dvec2 middleOf(const Image& image, glm::ivec3 background) {
    glm::dvec2 sum(0);
    double count = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const std::uint8_t* c = image.at(x, y);
            if (glm::ivec3(c[0], c[1], c[2]) != background) {
                sum += glm::dvec2(x + 0.5, y + 0.5);
                count += 1;
            }
        }
    }
    EXPECT_GT(count, 100) << "no ball";
    return sum / count;
}

TEST_F(StereoPicture, ShowsAPointWithTheParallaxOfItsDepth) {
    const walls::Wall wall = plainWall();
    scene::Scene scene = sample::flatScene(16, 16, 0.015);
    scene.look.backgroundColour = {0, 1, 0};
    // The scene is upright like the room. The sand is five metres below the floor, out of sight, so that only the tool
    // is visible.
    const glm::dmat4 sceneToRoom({1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, -5, 0, 1});
    render_node::ScenePainter view(scene, sceneToRoom);
    for (const double wanted : {-1.0, -0.5, 0.0, 0.5, 2.0}) {
        const sand::ProbePoint probe = sample::probeAt(scene, {0.06, wanted, 5.25});
        view.setTool(probe, true);
        // Probes are quantised, so the exact place of the tool is used, from the middle of the screen's lower edge.
        const double unit = scene.terrain.cellSize() / sand::kProbePerCell;  // [m]
        const glm::dvec3 at(probe.x * unit, probe.z * unit - 5, probe.y * unit);
        const double behind = at.z;
        const auto shown = [&](Eye eye) {
            return middleOf(sample::drawThrough(view, wall, wall.tiles[0].screen, wall.tiles[0].pixels, eye),
                            {0, 255, 0});
        };
        const glm::dvec2 left = shown(Eye::left), right = shown(Eye::right), middle = shown(Eye::middle);
        // Similar triangles give a parallax of separation * s / (s + D). A pixel is a millimetre. A point behind the
        // screen has its parallax to the right.
        const double parallax = 1000 * 0.065 * behind / (behind + 2);
        EXPECT_NEAR(right.x - left.x, parallax, 0.25) << behind << " m behind the screen";
        EXPECT_NEAR(right.y, left.y, 0.25);
        EXPECT_NEAR(middle.x, (left.x + right.x) / 2, 0.25);
        // The point itself must be on the line from the eye.
        EXPECT_NEAR(middle.x, 400 + 1000 * at.x * 2 / (behind + 2), 0.25);
        EXPECT_NEAR(middle.y, 600 - 1000 * (0.3 + (at.y - 0.3) * 2 / (behind + 2)), 0.25);
    }
}

TEST_F(StereoPicture, OfOneEyeIsTheMiddleBetweenTwo) {
    const sample::DugScene dug;
    walls::Wall mono = sample::reduced(walls::loadWall(sample::wallFolder() / "desktop.toml"), 4);
    mono.viewer.eyeSeparation = 0.065;
    ASSERT_EQ(mono.stereo, Stereo::mono);
    render_node::ScenePainter view = sample::makeView(dug, mono);
    const auto monoShown = sample::outputsOf(view, mono, mono.tiles[0]);
    ASSERT_EQ(monoShown.size(), 1U);
    walls::Wall joined = walls::shownIn(mono, Stereo::passive);
    joined.viewer.eyeSeparation = 0;
    EXPECT_EQ(sample::outputsOf(view, joined, joined.tiles[0]), std::vector(2, monoShown[0]))
        << "two eyes in one place";
    const auto apart = [&] {
        joined.viewer.eyeSeparation = 0.065;
        return sample::outputsOf(view, joined, joined.tiles[0]);
    }();
    EXPECT_NE(apart[0], monoShown[0]);
    EXPECT_NE(apart[1], monoShown[0]);
}

// In mono, every wall must show the picture from the midpoint of the eyes, whatever the mode of its file is.
TEST_F(StereoPicture, OfMonoIsTheMiddleOfTheEyesOnEveryWall) {
    const sample::DugScene dug;
    for (const std::string& name : sample::wallNames()) {
        SCOPED_TRACE(name);
        walls::Wall wall = sample::smallWall(walls::loadWall(sample::wallFolder() / (name + ".toml")), 400);
        wall.viewer.eyeSeparation = 0.065;
        render_node::ScenePainter view = sample::makeView(dug, wall);
        const walls::Wall mono = walls::shownIn(wall, Stereo::mono);
        const walls::Wall left = walls::shownIn(wall, Stereo::left);
        walls::Wall joined = left;
        joined.viewer.eyeSeparation = 0;
        bool eyesDiffer = false;
        for (std::size_t i = 0; i < wall.tiles.size(); ++i) {
            const auto shown = sample::outputsOf(view, mono, mono.tiles[i]);
            ASSERT_FALSE(shown.empty());
            EXPECT_EQ(sample::outputsOf(view, joined, joined.tiles[i]), shown) << wall.tiles[i].name;
            eyesDiffer = eyesDiffer || sample::outputsOf(view, left, left.tiles[i]) != shown;
        }
        EXPECT_TRUE(eyesDiffer) << "every picture is the same";
    }
}

TEST_F(StereoPicture, OfTheLeftEyeAloneIsThatOfTheLeftOutput) {
    const sample::DugScene dug;
    const walls::Wall wall = sample::reduced(walls::loadWall(sample::wallFolder() / "tiled_3x4.toml"), 8);
    render_node::ScenePainter view = sample::makeView(dug, wall);
    const auto both = sample::outputsOf(view, wall, wall.tiles[5]);
    for (const auto& [stereo, expected] : {std::pair{Stereo::left, 0U}, {Stereo::right, 1U}}) {
        const walls::Wall one = walls::shownIn(wall, stereo);
        EXPECT_EQ(sample::outputsOf(view, one, one.tiles[5]), std::vector{both.at(expected)});
    }
    EXPECT_NE(both[0], both[1]);
}

/// Two corners that a face shares with another face.
struct Joint {
    glm::dvec3 from, to;
};

std::optional<Joint> jointOf(const Screen& first, const Screen& second) {
    const auto corners = [](const Screen& s) {
        return std::array{s.lowerLeft, s.lowerRight, s.upperLeft, s.upperRight()};
    };
    std::vector<glm::dvec3> shared;
    for (const glm::dvec3 a : corners(first)) {
        for (const glm::dvec3 b : corners(second)) {
            if (glm::distance(a, b) < 1e-9) {
                shared.push_back(a);
            }
        }
    }
    return shared.size() == 2 ? std::optional(Joint{shared[0], shared[1]}) : std::nullopt;
}

/// Returns the pixels of a face along one of its edges. The face is moved outwards by half a pixel, so that its last
/// pixels are on the edge itself. The last pixels of the other face are there too. So both faces look along the same
/// rays.
std::vector<glm::ivec3> alongEdge(render_node::ScenePainter& view, const walls::Wall& wall, const walls::Tile& tile,
                                  const Joint& joint, Eye eye) {
    Screen screen = tile.screen;
    const glm::dvec3 middle = (screen.lowerRight + screen.upperLeft) / 2.0;
    const glm::dvec3 outwards = glm::normalize((joint.from + joint.to) / 2.0 - middle);
    const glm::dvec3 half = outwards * (0.5 * screen.width() / tile.pixels.x);
    for (glm::dvec3* corner : {&screen.lowerLeft, &screen.lowerRight, &screen.upperLeft}) {
        *corner += half;
    }
    const Image image = sample::drawThrough(view, wall, screen, tile.pixels, eye);
    const int count = static_cast<int>(std::lround(glm::distance(joint.from, joint.to) / (2 * glm::length(half))));
    std::vector<glm::ivec3> colours;
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 at = glm::mix(joint.from, joint.to, (i + 0.5) / count) - screen.lowerLeft;
        const int x = static_cast<int>(glm::dot(at, screen.right()) / screen.width() * image.width);
        const int y = static_cast<int>((1 - glm::dot(at, screen.up()) / screen.height()) * image.height);
        const std::uint8_t* c = image.at(std::clamp(x, 0, image.width - 1), std::clamp(y, 0, image.height - 1));
        colours.emplace_back(c[0], c[1], c[2]);
    }
    return colours;
}

/// Returns the mean, over the pixels that meet, of the largest difference of a channel [level].
double meanDifference(const std::vector<glm::ivec3>& a, const std::vector<glm::ivec3>& b, std::size_t shift = 0) {
    double sum = 0;
    for (std::size_t i = 0; i + shift < a.size(); ++i) {
        const glm::ivec3 d = glm::abs(a[i + shift] - b[i]);
        sum += std::max({d.r, d.g, d.b});
    }
    return sum / static_cast<double>(a.size() - shift);
}

TEST_F(StereoPicture, FacesOfACaveJoinAlongTheirEdges) {
    const sample::DugScene dug;
    const walls::Wall cave = sample::reduced(walls::loadWall(sample::wallFolder() / "flex_cave.toml"), 2);
    render_node::ScenePainter view = sample::makeView(dug, cave);
    int joints = 0;
    for (std::size_t i = 0; i < cave.tiles.size(); ++i) {
        for (std::size_t j = i + 1; j < cave.tiles.size(); ++j) {
            const auto joint = jointOf(cave.tiles[i].screen, cave.tiles[j].screen);
            if (!joint) {
                continue;
            }
            ++joints;
            for (const Eye eye : {Eye::left, Eye::right}) {
                const auto first = alongEdge(view, cave, cave.tiles[i], *joint, eye);
                const auto second = alongEdge(view, cave, cave.tiles[j], *joint, eye);
                const auto other =
                    alongEdge(view, cave, cave.tiles[j], *joint, eye == Eye::left ? Eye::right : Eye::left);
                ASSERT_EQ(first.size(), second.size());
                const std::string edge = cave.tiles[i].name + " and " + cave.tiles[j].name;
                // The remaining difference is grain: the texture is seen from another side, and another mip level is
                // used.
                EXPECT_LT(meanDifference(first, second), 0.5) << edge;
                EXPECT_GT(meanDifference(first, second, 1), 1) << edge << ", a pixel apart";
                EXPECT_GT(meanDifference(first, other), 1) << edge << ", eyes swapped";
            }
        }
    }
    EXPECT_EQ(joints, 5) << "left-front, front-right, and the floor with each";
}

}  // namespace
