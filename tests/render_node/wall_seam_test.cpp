// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "pictures/compare.hpp"
#include "render_node/gl/gl_context.hpp"
#include "tests/support/pictures/wall_painter.hpp"

namespace {

using pictures::Image;
using walls::Eye;
using walls::Screen;

constexpr int kSeamLevels = 8;
constexpr double kSeamMostBad = 0.01;
// Largest relative bend of the distance from pixel to pixel; a larger one is a silhouette.
constexpr double kBend = 0.001;
constexpr double kHair = 0.002;            // [pixel], far more than rounding errors, far less than a visible distance
constexpr double kMostUndecided = 0.0005;  // largest share of pixels whose grain depends on rounding
constexpr int kSeamMostPixels = 700000;

/// Screen that one camera sees as a whole, and the parts of it that are drawn separately.
struct Whole {
    Screen screen;
    glm::ivec2 pixels;
    std::vector<std::pair<Screen, walls::PixelRect>> parts;
};

/// Returns the part of a screen that shows these pixels of it.
Screen partOf(const Screen& screen, glm::ivec2 pixels, const walls::PixelRect& rect) {
    const glm::dvec3 x = (screen.lowerRight - screen.lowerLeft) / double(pixels.x);
    const glm::dvec3 y = (screen.upperLeft - screen.lowerLeft) / double(pixels.y);
    const glm::dvec3 corner = screen.lowerLeft + x * double(rect.x) + y * double(pixels.y - rect.y - rect.height);
    return {corner, corner + x * double(rect.width), corner + y * double(rect.height)};
}

/// Returns a screen in four unequal parts.
Whole inParts(const walls::Tile& tile) {
    const int x = tile.pixels.x * 2 / 5, y = tile.pixels.y * 3 / 7;
    Whole whole{tile.screen, tile.pixels, {}};
    for (const walls::PixelRect& rect : {walls::PixelRect{0, 0, x, y},
                                         {x, 0, tile.pixels.x - x, y},
                                         {0, y, x, tile.pixels.y - y},
                                         {x, y, tile.pixels.x - x, tile.pixels.y - y}}) {
        whole.parts.emplace_back(partOf(tile.screen, tile.pixels, rect), rect);
    }
    return whole;
}

/// Returns the same grid with bezels of whole pixels, so that a crop of the whole can equal a tile.
walls::Wall withWholeBezels(walls::Wall wall) {
    walls::Grid& grid = *wall.grid;
    const glm::dvec2 pixel = grid.tileSize / glm::dvec2(grid.tilePixels);
    grid.bezel = glm::round(grid.bezel / pixel) * pixel;
    wall.tiles = walls::tilesOf(grid, wall.stereo);
    return wall;
}

/// Returns the parts of a wall that one camera can see at a time. They are a grid of several tiles without its bezels,
/// and each other screen.
std::vector<Whole> wholesOf(const walls::Wall& wall) {
    std::vector<Whole> wholes;
    if (wall.grid && wall.grid->rows * wall.grid->columns > 1) {
        const walls::Wall grid = withWholeBezels(wall);
        const walls::Wall one = walls::wholeWall(grid);
        Whole whole{one.tiles[0].screen, one.tiles[0].pixels, {}};
        const walls::Canvas canvas = walls::wallCanvas(grid);
        for (std::size_t i = 0; i < grid.tiles.size(); ++i) {
            whole.parts.emplace_back(grid.tiles[i].screen, canvas.tiles[i]);
        }
        wholes.push_back(whole);
    }
    for (const walls::Tile& tile : wall.tiles) {
        if (tile.row == 0 || wall.tiles.size() == 1) {
            wholes.push_back(inParts(tile));
        }
    }
    return wholes;
}

int reductionFor(const walls::Wall& wall) {
    const walls::Canvas canvas = walls::wallCanvas(wall);
    int by = 1;
    while (std::int64_t{canvas.width} * canvas.height / (std::int64_t{by} * by) > kSeamMostPixels) {
        by *= 2;
    }
    return by;
}

struct Count {
    double pixels = 0, bad = 0, badWhenMoved = 0, badInTheOtherEye = 0, silhouettes = 0;
};

/// Returns silhouettes and sharp edges, and two pixels around them: places where the distance of the scene jumps or
/// bends. The renderer may draw such a pixel either way when it draws the same scene through another viewport. `depth`
/// is GL's; row 0 is the lowest.
pictures::Mask silhouettes(const std::vector<float>& depth, const walls::Clip& clip, glm::ivec2 size) {
    const auto at = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(x);
    };
    // A plane in perspective is linear in 1/distance.
    const auto nearness = [&](int x, int y) {
        const double z = 2.0 * double{depth[at(x, size.y - 1 - y)]} - 1;
        return (clip.far + clip.near - z * (clip.far - clip.near)) / (2 * clip.far * clip.near);
    };
    pictures::Mask mask(depth.size(), 0);
    for (int y = 1; y + 1 < size.y; ++y) {
        for (int x = 1; x + 1 < size.x; ++x) {
            const double here = 2 * nearness(x, y);
            const double bend = std::max(std::abs(nearness(x - 1, y) + nearness(x + 1, y) - here),
                                         std::abs(nearness(x, y - 1) + nearness(x, y + 1) - here));
            for (int v = std::max(0, y - 2); bend > kBend * here && v <= std::min(size.y - 1, y + 2); ++v) {
                for (int u = std::max(0, x - 2); u <= std::min(size.x - 1, x + 2); ++u) {
                    mask[at(u, v)] = 1;
                }
            }
        }
    }
    return mask;
}

/// Adds to `edges` the pixels that change when the screen is moved by a tiny distance. At these pixels rounding chooses
/// between two levels of the grain.
void addUndecided(pictures::Mask& edges, render_node::ScenePainter& view, const walls::Wall& wall, const Whole& whole,
                  const Image& picture) {
    const pictures::Mask known = edges;
    std::int64_t undecided = 0;
    for (const glm::dvec2 hair : {glm::dvec2(kHair, kHair), {-kHair, kHair}, {kHair, -kHair}, {-kHair, -kHair}}) {
        const glm::dvec3 x = (whole.screen.lowerRight - whole.screen.lowerLeft) * (hair.x / whole.pixels.x);
        const glm::dvec3 y = (whole.screen.upperLeft - whole.screen.lowerLeft) * (hair.y / whole.pixels.y);
        const Screen moved{whole.screen.lowerLeft + x + y, whole.screen.lowerRight + x + y,
                           whole.screen.upperLeft + x + y};
        const pictures::Comparison other =
            pictures::compare(picture, sample::drawThrough(view, wall, moved, whole.pixels, Eye::left), kSeamLevels);
        undecided += pictures::countOutside(other.bad, known);
        std::ranges::transform(edges, other.bad, edges.begin(),
                               [](auto a, auto b) { return a != 0 || b != 0 ? 1 : 0; });
    }
    EXPECT_LE(static_cast<double>(undecided), kMostUndecided * static_cast<double>(picture.pixels()));
}

pictures::Mask cropOf(const pictures::Mask& mask, int width, const walls::PixelRect& rect) {
    pictures::Mask part;
    for (int y = rect.y; y < rect.y + rect.height; ++y) {
        const auto row = mask.begin() + static_cast<std::ptrdiff_t>(y) * width + rect.x;
        part.insert(part.end(), row, row + rect.width);
    }
    return part;
}

class WallSeams : public testing::Test {
protected:
    /// Draws every part alone and compares it with the crop of the whole.
    static void compareParts(render_node::ScenePainter& view, const walls::Wall& wall, const Whole& whole,
                             Count& count) {
        std::vector<float> depth;
        const Image left = sample::drawThrough(view, wall, whole.screen, whole.pixels, Eye::left, &depth);
        const Image right = sample::drawThrough(view, wall, whole.screen, whole.pixels, Eye::right);
        pictures::Mask edges = silhouettes(depth, wall.clip, whole.pixels);
        addUndecided(edges, view, wall, whole, left);
        for (const auto& [screen, rect] : whole.parts) {
            const auto partOfImage = [&, at = rect](const Image& image) {
                return pictures::crop(image, at.x, at.y, at.width, at.height);
            };
            const Image got = sample::drawThrough(view, wall, screen, {rect.width, rect.height}, Eye::left);
            const Image expected = partOfImage(left);
            const pictures::Comparison same = pictures::compare(expected, got, kSeamLevels);
            EXPECT_LE(same.badShare, kSeamMostBad) << "part at " << rect.x << ", " << rect.y;
            EXPECT_EQ(pictures::countOutside(same.bad, cropOf(edges, whole.pixels.x, rect)), 0)
                << "part at " << rect.x << ", " << rect.y;
            const auto bad = [&](const Image& a, const Image& b) {
                return static_cast<double>(pictures::compare(a, b, kSeamLevels).badPixels);
            };
            count.pixels += static_cast<double>(got.pixels());
            count.bad += static_cast<double>(same.badPixels);
            count.badWhenMoved +=
                std::min(bad(expected, pictures::shifted(got, 1, 0)), bad(expected, pictures::shifted(got, 0, 1)));
            count.badInTheOtherEye += bad(partOfImage(right), got);
        }
        count.silhouettes += static_cast<double>(std::count(edges.begin(), edges.end(), 1));
    }

    std::unique_ptr<render_node::GlContext> context_ =
        render_node::makeOffscreenContext(render_node::Backend::automatic);
    sample::DugScene dug_;
};

// At most 1 % of a tile may differ by more than 8 levels from the one picture of the whole. These pixels are at
// silhouettes and between two levels of the grain. A tile that is one pixel off, or that shows the other eye, must
// fail.
TEST_F(WallSeams, EveryTileOfEverySampleIsItsPartOfTheWhole) {
    for (const std::string& name : sample::wallNames()) {
        SCOPED_TRACE(name);
        const walls::Wall full = walls::loadWall(sample::wallFolder() / (name + ".toml"));
        walls::Wall wall = sample::reduced(full, reductionFor(full));
        wall.viewer.eyeSeparation = std::max(wall.viewer.eyeSeparation, 0.06);  // a mono wall may have none
        render_node::ScenePainter view = sample::makeView(dug_, wall);
        Count count;
        for (const Whole& whole : wholesOf(wall)) {
            compareParts(view, wall, whole, count);
        }
        fmt::print(
            "{}: {:.4f} % of the pixels differ from the whole; {:.1f} % a pixel off, {:.1f} % in the other eye; "
            "{:.1f} % are silhouettes\n",
            name, 100 * count.bad / count.pixels, 100 * count.badWhenMoved / count.pixels,
            100 * count.badInTheOtherEye / count.pixels, 100 * count.silhouettes / count.pixels);
        EXPECT_GT(count.badWhenMoved, kSeamMostBad * count.pixels);
        EXPECT_GT(count.badInTheOtherEye, kSeamMostBad * count.pixels);
        EXPECT_LT(count.silhouettes, 0.25 * count.pixels) << "everything counts as a silhouette";
    }
}

}  // namespace
