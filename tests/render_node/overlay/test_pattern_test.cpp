// SPDX-License-Identifier: Apache-2.0
#include "render_node/overlay/test_pattern.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <set>

#include "render_node/gl/gl_context.hpp"
#include "render_node/overlay/dot_font.hpp"
#include "tests/support/pictures/wall_painter.hpp"

namespace {

using lockstep::Pattern;
using pictures::Image;
using walls::Eye;

/// Place on the wall, from its middle [m], and the share of a line's colour there.
struct Mark {
    double u, v, weight;
};

class PatternOfAWall : public testing::Test {
protected:
    Image draw(const walls::Tile& tile, Pattern pattern, Eye eye, std::uint64_t frame = 0) const {
        const render_node::EyeTarget target(tile.pixels.x, tile.pixels.y);
        target.bind();
        glClearColor(1, 0, 1, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        render_node::TestPatternView(wall_, tile, "node").draw(pattern, eye, frame, target);
        return sample::pictureOf(target);
    }
    /// Returns the marks of one colour on all tiles; weightOf(colour) is the share of each. The tiles are moved
    /// together by the share `missing` of a bezel.
    template <class WeightOf>
    std::vector<Mark> marks(WeightOf weightOf, double missing = 0) const {
        std::vector<Mark> found;
        const walls::Grid& grid = *wall_.grid;
        const glm::dvec2 size = glm::dvec2(grid.columns, grid.rows) * (grid.tileSize + grid.bezel) - grid.bezel;
        for (const walls::Tile& tile : wall_.tiles) {
            const Image image = draw(tile, Pattern::grid, Eye::left);
            const glm::dvec2 corner = glm::dvec2(tile.screen.lowerLeft - grid.lowerLeft) - size / 2.0 -
                                      missing * grid.bezel * glm::dvec2(tile.column - 1, grid.rows - tile.row);
            // The outermost pixels belong to the frame.
            for (int y = 1; y + 1 < image.height; ++y) {
                for (int x = 1; x + 1 < image.width; ++x) {
                    const double weight = weightOf(image.at(x, y));
                    if (weight > 0) {
                        found.push_back({corner.x + (x + 0.5) / image.width * tile.screen.width(),
                                         corner.y + (image.height - y - 0.5) / image.height * tile.screen.height(),
                                         weight});
                    }
                }
            }
        }
        return found;
    }
    [[nodiscard]] double pixel() const { return wall_.grid->tileSize.x / wall_.grid->tilePixels.x; }  // [m]

    std::unique_ptr<render_node::GlContext> context_ =
        render_node::makeOffscreenContext(render_node::Backend::automatic);
    walls::Wall wall_ = sample::reduced(walls::loadWall(sample::wallFolder() / "tiled_3x4.toml"), 4);
};

double diagonalColour(const std::uint8_t* c) { return c[1] > c[0] && c[1] > c[2] ? c[1] - c[0] : 0; }
double circleColour(const std::uint8_t* c) { return c[0] > c[1] && c[1] > c[2] ? c[0] - c[2] : 0; }

/// Returns the distance of the rising diagonal from the straight line that fits it best, averaged over short pieces
/// [m].
double bend(const std::vector<Mark>& marks) {
    constexpr double kPiece = 0.05;  // [m]
    struct Sum {
        double along = 0, across = 0, weight = 0;
    };
    std::array<Sum, 80> pieces;
    for (const Mark& mark : marks) {
        const double along = (mark.u + mark.v) / std::sqrt(2.0), across = (mark.v - mark.u) / std::sqrt(2.0);
        const auto piece = static_cast<long>(std::floor(along / kPiece)) + 40;
        if (std::abs(across) < 0.03 && std::abs(along) > 0.2 && piece >= 0 && piece < 80) {
            Sum& sum = pieces.at(static_cast<std::size_t>(piece));
            sum.along += mark.weight * along;
            sum.across += mark.weight * across;
            sum.weight += mark.weight;
        }
    }
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    std::vector<glm::dvec2> points;
    for (const Sum& sum : pieces) {
        if (sum.weight > 1000) {
            points.emplace_back(sum.along / sum.weight, sum.across / sum.weight);
            const glm::dvec2 p = points.back();
            n += 1;
            x += p.x;
            y += p.y;
            xx += p.x * p.x;
            xy += p.x * p.y;
        }
    }
    EXPECT_GT(points.size(), 40U) << "from the lower to the upper edge of the wall";
    const double slope = (n * xy - x * y) / (n * xx - x * x);
    double furthest = 0;
    for (const glm::dvec2 p : points) {
        furthest = std::max(furthest, std::abs(p.y - (y + slope * (n * p.x - x)) / n));
    }
    return furthest;
}

TEST_F(PatternOfAWall, ALineCrossesBezelsStraight) {
    EXPECT_LT(bend(marks(diagonalColour)), 0.25 * pixel());
    // If the pictures are placed side by side without bezels, the measure must be large.
    EXPECT_GT(bend(marks(diagonalColour, 1)), 0.25 * pixel());
}

TEST_F(PatternOfAWall, CirclesCrossBezelsRound) {
    constexpr double kRadius = 0.8;  // every second line of 0.2 m
    constexpr int kSectors = 72;
    std::array<double, kSectors> radius{}, weight{};
    for (const Mark& mark : marks(circleColour)) {
        const double r = std::hypot(mark.u, mark.v);
        const auto sector = static_cast<std::size_t>((std::atan2(mark.v, mark.u) / 6.2831853072 + 0.5) * kSectors);
        if (std::abs(r - kRadius) < 0.1) {
            radius.at(sector % kSectors) += mark.weight * r;
            weight.at(sector % kSectors) += mark.weight;
        }
    }
    for (std::size_t i = 0; i < kSectors; ++i) {
        ASSERT_GT(weight[i], 500) << "sector " << i;
        EXPECT_NEAR(radius[i] / weight[i], kRadius, 0.25 * pixel()) << "sector " << i;
    }
}

TEST_F(PatternOfAWall, GridHasAWhiteRimOnEveryTile) {
    ASSERT_EQ(wall_.tiles.size(), 12U);
    for (const walls::Tile& tile : wall_.tiles) {
        const Image image = draw(tile, Pattern::grid, Eye::right);
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) {
                if (x == 0 || y == 0 || x == image.width - 1 || y == image.height - 1) {
                    ASSERT_EQ(image.at(x, y)[0] + image.at(x, y)[1] + image.at(x, y)[2], 765) << x << ", " << y;
                }
            }
        }
    }
}

TEST_F(PatternOfAWall, HasNothingOfThePictureBefore) {
    const walls::Tile& tile = wall_.tiles[5];
    for (int i = 1; i <= static_cast<int>(lockstep::kLastPattern); ++i) {
        const Image image = draw(tile, static_cast<Pattern>(i), Eye::left, 3);
        for (std::size_t p = 0; p < image.rgb.size(); p += 3) {
            ASSERT_FALSE(image.rgb[p] == 255 && image.rgb[p + 1] == 0 && image.rgb[p + 2] == 255)
                << lockstep::patternName(static_cast<Pattern>(i)) << " pixel " << p / 3;
        }
    }
}

TEST_F(PatternOfAWall, TellsEveryTileAndEyeApart) {
    std::vector<Image> seen;
    for (const walls::Tile& tile : wall_.tiles) {
        for (const Eye eye : {Eye::left, Eye::right, Eye::middle}) {
            const Image image = draw(tile, Pattern::tiles, eye);
            EXPECT_EQ(std::count(seen.begin(), seen.end(), image), 0) << tile.name;
            seen.push_back(image);
        }
    }
    EXPECT_EQ(seen.size(), 12U * 3);
}

TEST_F(PatternOfAWall, ShowsEachEyeItsOwnLetterInItsOwnColourAndHalf) {
    const Image left = draw(wall_.tiles[0], Pattern::eyes, Eye::left);
    const Image right = draw(wall_.tiles[0], Pattern::eyes, Eye::right);
    int leftLit = 0, rightLit = 0;
    for (int y = 4; y < left.height - 4; ++y) {  // inside the white frame
        for (int x = 4; x < left.width - 4; ++x) {
            const std::uint8_t *l = left.at(x, y), *r = right.at(x, y);
            ASSERT_EQ(l[1] + l[2], 0) << "the left eye's is red";
            ASSERT_EQ(r[0], 0) << "the right eye's is cyan";
            leftLit += l[0] > 0 ? 1 : 0;
            rightLit += r[1] > 0 ? 1 : 0;
            ASSERT_FALSE(l[0] > 0 && x >= left.width / 2);
            ASSERT_FALSE(r[1] > 0 && x < left.width / 2);
        }
    }
    EXPECT_GT(leftLit, left.width * left.height / 20);
    EXPECT_GT(rightLit, left.width * left.height / 20);
}

TEST_F(PatternOfAWall, FlashesInFourColoursAlikeOnAllTiles) {
    std::set<int> colours;
    for (std::uint64_t frame = 0; frame < 4; ++frame) {
        const Image first = draw(wall_.tiles[0], Pattern::flash, Eye::left, frame);
        EXPECT_EQ(draw(wall_.tiles[11], Pattern::flash, Eye::right, frame), first);
        colours.insert(first.rgb[0] << 16 | first.rgb[1] << 8 | first.rgb[2]);
        const Image later = draw(wall_.tiles[0], Pattern::flash, Eye::left, frame + 4);
        EXPECT_TRUE(std::equal(first.rgb.begin(), first.rgb.begin() + 3, later.rgb.begin()));
        EXPECT_NE(later, first) << "the number of the frame";
    }
    EXPECT_EQ(colours.size(), 4U);
}

TEST_F(PatternOfAWall, RampHasItsLevels) {
    const Image ramp = draw(wall_.tiles[0], Pattern::ramp, Eye::left);
    for (int step = 0; step < 17; ++step) {
        EXPECT_EQ(ramp.at((2 * step + 1) * ramp.width / 34, 3)[1], std::min(255, 16 * step));
    }
    for (int x = 0; x < ramp.width; ++x) {
        EXPECT_EQ(ramp.at(x, ramp.height - 1)[0], x) << "256 pixels wide: a level each";
    }
}

TEST_F(PatternOfAWall, WritesTheFontsDots) {
    const render_node::EyeTarget target(24, 9);
    render_node::FlatPainter painter;
    painter.addBox({0, 0}, {24, 9}, glm::vec3(0));
    painter.addText("R4?z", {1, 1}, 1, glm::vec3(1));
    painter.paint(target);
    const Image image = sample::pictureOf(target);
    const std::string shown = "R4#Z";  // '?' and '#' are boxes, lower-case letters look like capitals
    for (int letter = 0; letter < 4; ++letter) {
        const auto rows = render_node::glyphOf(shown[static_cast<std::size_t>(letter)]);
        for (int y = 0; y < 7; ++y) {
            for (int x = 0; x < 5 && 1 + 6 * letter + x < 24; ++x) {
                const int lit = (rows.at(static_cast<std::size_t>(y)) >> (4 - x)) & 1;
                EXPECT_EQ(image.at(1 + 6 * letter + x, 1 + y)[0], 255 * lit) << shown << " letter " << letter;
            }
        }
    }
}

TEST(GridSpacing, IsOneTwoOrFiveTimesAPowerOfTen) {
    EXPECT_DOUBLE_EQ(render_node::gridSpacing({4.126, 2.324}), 0.2);
    EXPECT_DOUBLE_EQ(render_node::gridSpacing({0.531, 0.299}), 0.02);
    EXPECT_DOUBLE_EQ(render_node::gridSpacing({8, 9}), 1);
    EXPECT_DOUBLE_EQ(render_node::gridSpacing({0.4, 0.8}), 0.05);
}

}  // namespace
