// SPDX-License-Identifier: Apache-2.0
// Properties of every display of the project, derived from the places of its viewer and screens.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/walls/sample_walls.hpp"

namespace walls {
namespace {

View viewFrom(const Wall& wall, const Tile& tile, Eye eye) {
    return viewOf(tile.screen, eyePosition(wall.viewer, eye), wall.clip.near, wall.clip.far);
}

TEST(Displays, PartTheEyesByTheFormula) {
    // The eyes are parallel to the screen, `distance` in front of it. A point `behind` the screen then has the parallax
    // separation * behind / (behind + distance), by similar triangles. It is negative in front of the screen, 0 on it,
    // and positive behind it.
    for (const std::string& name : configNames()) {
        const Wall wall = config(name);
        // In a CAVE some screens are at the side of the eyes. The first screen in front of them is compared.
        const auto front = std::ranges::find_if(wall.tiles, [&](const Tile& tile) {
            return glm::distance(wall.viewer.right, tile.screen.right()) < 1e-12;
        });
        ASSERT_NE(front, wall.tiles.end()) << name << ": no screen is parallel to the eyes";
        const Tile& tile = *front;
        const Screen& screen = tile.screen;
        const double distance = screen.distanceTo(wall.viewer.eye);
        const glm::dvec3 middle = (screen.lowerLeft + screen.upperRight()) / 2.0;
        for (const double share : {-0.5, -0.1, 0.0, 0.1, 3.0}) {
            const double behind = share * distance;
            const glm::dvec3 point = middle - screen.normal() * behind;
            const glm::dvec3 left = shownAt(screen, viewFrom(wall, tile, Eye::left), point);
            const glm::dvec3 right = shownAt(screen, viewFrom(wall, tile, Eye::right), point);
            const double parallax = glm::dot(right - left, screen.right());
            EXPECT_NEAR(parallax, wall.viewer.eyeSeparation * behind / (behind + distance), 1e-12) << name;
            EXPECT_NEAR(glm::dot(right - left, screen.up()), 0, 1e-12) << name;
            // Checks the parallax in pixels, with the view of each eye alone.
            const double pixels = parallax / screen.width() * tile.pixels.x;
            const PixelRect rect{0, 0, tile.pixels.x, tile.pixels.y};
            EXPECT_NEAR(pixelAt(rect, viewFrom(wall, tile, Eye::right), point).x -
                            pixelAt(rect, viewFrom(wall, tile, Eye::left), point).x,
                        pixels, 1e-8)
                << name;
        }
    }
}

TEST(Displays, ShowInMonoTheMiddleBetweenTheEyes) {
    for (const std::string& name : configNames()) {
        int compared = 0;
        const Wall wall = config(name);
        const Wall mono = shownIn(wall, Stereo::mono);
        ASSERT_EQ(eyesOf(mono.stereo).size(), 1U);
        EXPECT_EQ(eyePosition(mono.viewer, eyesOf(mono.stereo)[0]),
                  (eyePosition(wall.viewer, Eye::left) + eyePosition(wall.viewer, Eye::right)) / 2.0)
            << name;
        for (const Tile& tile : wall.tiles) {
            const View left = viewFrom(wall, tile, Eye::left), right = viewFrom(wall, tile, Eye::right);
            const View middle = viewFrom(mono, mono.tiles[static_cast<std::size_t>(tile.rank - 1)], Eye::middle);
            if (std::abs(glm::dot(wall.viewer.right, tile.screen.normal())) < 1e-12) {
                ++compared;
                EXPECT_NEAR(middle.left, (left.left + right.left) / 2, 1e-12) << name << " " << tile.name;
                EXPECT_NEAR(middle.right, (left.right + right.right) / 2, 1e-12) << name << " " << tile.name;
                EXPECT_NEAR(middle.top, left.top, 1e-12) << name << " " << tile.name;
            }
        }
        EXPECT_GT(compared, 0) << name << ": no screen is parallel to the eyes";
    }
}

TEST(Displays, LeadAStraightLineStraightAcrossABezel) {
    // The picture of a line on a plane is a line. Four points of it, two seen by each of two neighbours, are on one
    // line in the wall's plane, whatever the bezel hides.
    const Wall wall = config("tiled_3x4.toml");
    const glm::dvec3 from(-1.9, 0.5, 0.4), to(1.8, 2.3, -3.0);
    int bezels = 0;
    for (const Eye eye : eyesOf(wall.stereo)) {
        for (const Tile& tile : wall.tiles) {
            for (const std::size_t next :
                 {static_cast<std::size_t>(tile.rank), static_cast<std::size_t>(tile.rank + 3)}) {
                if (next >= wall.tiles.size() || (next == static_cast<std::size_t>(tile.rank) && tile.column == 4)) {
                    continue;
                }
                ++bezels;
                const Tile& other = wall.tiles[next];
                const auto shown = [&](const Tile& by, double along) {
                    return shownAt(by.screen, viewFrom(wall, by, eye), glm::mix(from, to, along));
                };
                const glm::dvec3 a = shown(tile, 0.1), b = shown(tile, 0.4), c = shown(other, 0.6),
                                 d = shown(other, 0.9);
                const glm::dvec3 line = glm::normalize(d - a);
                for (const glm::dvec3 point : {b, c}) {
                    EXPECT_LT(glm::length(glm::cross(point - a, line)), 1e-9) << tile.name << " to " << other.name;
                }
                EXPECT_GT(glm::distance(b, c), 0.1) << "the points are apart";
            }
        }
    }
    EXPECT_EQ(bezels, 2 * (3 * 3 + 2 * 4)) << "of two eyes";
}

TEST(Displays, OfTheCaveShareThePixelsOfTheirEdges) {
    // A point on the seam of left and front is in the last column of one screen and in the first column of the other.
    // Its height is the same in both.
    const Wall cave = config("flex_cave.toml");
    const Tile& left = cave.tiles[0];
    const Tile& front = cave.tiles[1];
    for (const Eye eye : eyesOf(cave.stereo)) {
        for (const double height : {0.1, 0.5, 0.93}) {
            const glm::dvec3 seam = glm::mix(front.screen.lowerLeft, front.screen.upperLeft, height);
            for (const double depth : {0.3, 1.0, 4.0}) {
                const glm::dvec3 at = eyePosition(cave.viewer, eye);
                const glm::dvec3 point = at + (seam - at) * depth;
                const glm::dvec2 onLeft = pixelAt({0, 0, 768, 768}, viewFrom(cave, left, eye), point);
                const glm::dvec2 onFront = pixelAt({0, 0, 1024, 768}, viewFrom(cave, front, eye), point);
                EXPECT_NEAR(onLeft.x, 768, 1e-6);
                EXPECT_NEAR(onFront.x, 0, 1e-6);
                EXPECT_NEAR(onLeft.y, onFront.y, 1e-6);
            }
        }
    }
}

}  // namespace
}  // namespace walls
