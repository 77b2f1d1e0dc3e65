// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>

#include "render_node/gl/gl_context.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/pictures/sample_scene.hpp"

namespace {

using render_node::EyeTarget;
using render_node::ScenePainter;
using sample::Pixels;

constexpr int kAcross = 4;  // number of tiles across
constexpr int kDown = 3;
constexpr int kTileWidth = 256;
constexpr int kTileHeight = 192;
constexpr int kWallWidth = kAcross * kTileWidth;
constexpr int kWallHeight = kDown * kTileHeight;

/// Returns for each pixel whether the scene's distance jumps nearby. At these pixels tiles may differ from the whole.
std::vector<bool> silhouettes(const EyeTarget& whole) {
    std::vector<float> depth(static_cast<std::size_t>(kWallWidth) * kWallHeight);
    glBindFramebuffer(GL_FRAMEBUFFER, whole.framebuffer());
    glReadPixels(0, 0, kWallWidth, kWallHeight, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
    const auto nearness = [&](int x, int yFromTop) {
        const std::size_t at =
            static_cast<std::size_t>(kWallHeight - 1 - yFromTop) * kWallWidth + static_cast<std::size_t>(x);
        return (30.05 - (2 * double{depth[at]} - 1) * 29.95) / (2 * 0.05 * 30);  // [1/m]
    };
    std::vector<bool> out(depth.size());
    for (int y = 0; y < kWallHeight; ++y) {
        for (int x = 0; x < kWallWidth; ++x) {
            // A plane in perspective is linear in 1/distance. A bend of more than 0.1 % is an edge.
            bool edge = false;
            for (int v = std::max(1, y - 2); v <= std::min(kWallHeight - 2, y + 2); ++v) {
                for (int u = std::max(1, x - 2); u <= std::min(kWallWidth - 2, x + 2); ++u) {
                    const double here = 2 * nearness(u, v);
                    const double bend = std::max(std::abs(nearness(u - 1, v) + nearness(u + 1, v) - here),
                                                 std::abs(nearness(u, v - 1) + nearness(u, v + 1) - here));
                    edge = edge || bend > 0.001 * here;
                }
            }
            out[static_cast<std::size_t>(y) * kWallWidth + static_cast<std::size_t>(x)] = edge;
        }
    }
    return out;
}

struct Difference {
    double share = 0;      // share of pixels that differ by more than 8 levels in some channel
    double elsewhere = 0;  // share of pixels that differ so much away from silhouettes
};

class TiledWall : public testing::Test {
protected:
    /// Returns the whole wall, assembled from its tiles. Each tile is drawn with its own view, as ranks do.
    Pixels tiled(const glm::dvec3& eye) {
        Pixels wall(3UL * kWallWidth * kWallHeight);
        const EyeTarget target(kTileWidth, kTileHeight);
        for (int row = 0; row < kDown; ++row) {
            for (int column = 0; column < kAcross; ++column) {
                ScenePainter view = makeView();
                const sample::Window window{column / double{kAcross}, 1 - (row + 1) / double{kDown},
                                            (column + 1) / double{kAcross}, 1 - row / double{kDown}};
                const Pixels tile = sample::draw(view, sample::camera(eye, eye + forward_, window), target);
                fewestChunks_ = std::min(fewestChunks_, view.counts().chunks);
                mostChunks_ = std::max(mostChunks_, view.counts().chunks);
                chunksOfField_ = view.counts().chunksOfField;
                for (int y = 0; y < kTileHeight; ++y) {
                    const auto from = tile.begin() + 3L * y * kTileWidth;
                    const auto at = 3L * ((row * kTileHeight + y) * kWallWidth + column * kTileWidth);
                    std::copy(from, from + 3 * kTileWidth, wall.begin() + at);
                }
            }
        }
        return wall;
    }
    Pixels whole(const glm::dvec3& eye, const glm::dvec2& moved = {} /* [pixel] */) {
        ScenePainter view = makeView();
        const glm::dvec2 share = moved / glm::dvec2(kWallWidth, kWallHeight);
        const sample::Window window{share.x, share.y, 1 + share.x, 1 + share.y};
        return sample::draw(view, sample::camera(eye, eye + forward_, window), wholeTarget_);
    }
    /// Returns the pixels that change when the picture is moved by a tiny distance. At these pixels rounding chooses
    /// between two levels of the grain.
    std::vector<bool> undecided(const Pixels& reference) {
        constexpr double kHair = 0.002;  // [pixel], far more than rounding errors, far less than a visible distance
        std::vector<bool> mask(static_cast<std::size_t>(kWallWidth) * kWallHeight);
        for (const glm::dvec2 hair : {glm::dvec2(kHair, kHair), {-kHair, kHair}, {kHair, -kHair}, {-kHair, -kHair}}) {
            const Pixels other = whole(leftEye_, hair);
            for (std::size_t i = 0; i < other.size(); ++i) {
                mask[i / 3] = mask[i / 3] || std::abs(int{other[i]} - int{reference[i]}) > 8;
            }
        }
        return mask;
    }
    [[nodiscard]] ScenePainter makeView() const {
        ScenePainter view(scene_, glm::dmat4(1));
        view.setTool(sample::probeAt(scene_, {1.1, 0.9, 0.06}), true);
        return view;
    }
    /// Compares with the picture that is moved `shift` pixels to the right.
    static Difference compare(const Pixels& wall, const Pixels& reference, const std::vector<bool>& edges,
                              int shift = 0) {
        int differ = 0;
        int elsewhere = 0;
        for (int y = 0; y < kWallHeight; ++y) {
            for (int x = shift; x < kWallWidth; ++x) {
                const glm::ivec3 gap = glm::abs(sample::pixel(wall, kWallWidth, x, y) -
                                                sample::pixel(reference, kWallWidth, x - shift, y));
                if (std::max({gap.r, gap.g, gap.b}) > 8) {
                    ++differ;
                    const std::size_t at = static_cast<std::size_t>(y) * kWallWidth + static_cast<std::size_t>(x);
                    elsewhere += edges[at] ? 0 : 1;
                }
            }
        }
        constexpr double kPixels = double{kWallWidth} * kWallHeight;
        return {differ / kPixels, elsewhere / kPixels};
    }

    std::unique_ptr<render_node::GlContext> context_ =
        render_node::makeOffscreenContext(render_node::Backend::automatic);
    scene::Scene scene_ = sample::duneScene(300);
    EyeTarget wholeTarget_{kWallWidth, kWallHeight};
    glm::dvec3 leftEye_{0.9675, -0.1, 0.75};
    glm::dvec3 rightEye_{1.0325, -0.1, 0.75};
    glm::dvec3 forward_{0, 1, -0.72};
    int fewestChunks_ = 1 << 30, mostChunks_ = 0, chunksOfField_ = 0;
};

TEST_F(TiledWall, EqualsTheWholeButForSilhouettes) {
    const Pixels wall = tiled(leftEye_);
    const Pixels reference = whole(leftEye_);
    std::vector<bool> edges = silhouettes(wholeTarget_);
    const auto edgePixels = std::count(edges.begin(), edges.end(), true);
    const std::vector<bool> rounded = undecided(reference);
    std::transform(edges.begin(), edges.end(), rounded.begin(), edges.begin(), std::logical_or<>());
    const auto undecidedPixels = std::count(edges.begin(), edges.end(), true) - edgePixels;
    const Difference difference = compare(wall, reference, edges);
    RecordProperty("share", std::to_string(difference.share));
    std::printf("share of pixels that differ: %.4f %%, away from silhouettes: %.4f %%\n", 100 * difference.share,
                100 * difference.elsewhere);
    EXPECT_LT(edgePixels, kWallWidth * kWallHeight / 10) << "everything counts as a silhouette";
    EXPECT_LE(difference.share, 0.01);
    EXPECT_LT(undecidedPixels, kWallWidth * kWallHeight / 2000) << "everything may be rounded";
    EXPECT_EQ(difference.elsewhere, 0);
}

TEST_F(TiledWall, DiffersFromTheWholeShiftedByAPixel) {
    const Pixels reference = whole(leftEye_);
    const std::vector<bool> edges = silhouettes(wholeTarget_);
    EXPECT_GT(compare(tiled(leftEye_), reference, edges, 1).share, 0.01);
}

TEST_F(TiledWall, DiffersFromTheWholeOfTheOtherEye) {
    const Pixels reference = whole(rightEye_);
    const std::vector<bool> edges = silhouettes(wholeTarget_);
    EXPECT_GT(compare(tiled(leftEye_), reference, edges).share, 0.01);
}

TEST_F(TiledWall, DrawsOnlyTheChunksEachTileSees) {
    (void)tiled(leftEye_);
    EXPECT_LT(mostChunks_, chunksOfField_);
    EXPECT_LT(fewestChunks_, chunksOfField_ / 4);
}

// The mesh of the box refers to the box. While the box was a member, a painter that had moved drew the box of the old
// one.
TEST_F(TiledWall, HasTheSidesOfTheSandAfterAPainterHasMoved) {
    const glm::dvec3 south(1, -1.5, 0.5);
    const render_node::Camera camera = sample::camera(south, {1, 1, 0}, {0, 0, 1, 1});
    scene_ = sample::flatScene(300, 300);
    scene_.rules.rim = sand::Rim::open;  // without boards, which hide the sides
    const scene::Scene dunes = sample::duneScene(300);
    ScenePainter first = makeView(), stays = makeView();
    ScenePainter moved(std::move(first));
    for (ScenePainter* painter : {&moved, &stays}) {
        painter->update(dunes.data(), {});
    }
    EXPECT_TRUE(sample::draw(moved, camera, wholeTarget_) == sample::draw(stays, camera, wholeTarget_));
}

TEST_F(TiledWall, LeavesOutTilesThatCannotHaveChangedAndMissesNone) {
    scene_ = sample::flatScene(300, 300, 0.03);
    sand::Replica replica(scene_);
    ScenePainter lazy = makeView();
    std::vector<EyeTarget> targets;
    std::vector<render_node::EyeMemory> memories(kAcross * kDown);
    int left = 0;
    for (int frame = 0; frame < 18; ++frame) {
        const glm::dvec3 from(0.3 + 0.2 * frame, 0.5, 0.02);
        if (frame >= 6) {  // the tool hovers and only dims the sand
            lazy.setTool(sample::probeAt(scene_, {0.2 + 0.09 * frame, 0.5 + 0.03 * frame, frame % 2 == 0 ? 0.05 : 0.5}),
                         false);
        } else if (frame != 3) {  // the tool rests in one frame
            sample::drag(replica, scene_, from, from + glm::dvec3(0.1, 0.15, 0));
            lazy.setTool(replica.probe(), frame % 2 == 0);
        }
        lazy.update(replica.surface().data(), replica.takeChange());
        const EyeTarget fresh(kTileWidth, kTileHeight);
        for (int tile = 0; tile < kAcross * kDown; ++tile) {
            if (frame == 0) {
                targets.emplace_back(kTileWidth, kTileHeight);
            }
            const int column = tile % kAcross, row = tile / kAcross;
            const double x = column / double{kAcross}, y = row / double{kDown};
            const auto camera =
                sample::camera(leftEye_, leftEye_ + forward_, {x, y, x + 1.0 / kAcross, y + 1.0 / kDown});
            const auto at = static_cast<std::size_t>(tile);
            left += lazy.drawIfChanged(camera, targets[at], memories[at]).empty() ? 1 : 0;
            ASSERT_TRUE(targets[at].read() == sample::draw(lazy, camera, fresh))
                << "frame " << frame << " tile " << tile;
        }
    }
    EXPECT_GE(left, kAcross * kDown + 10) << "all tiles of the resting frame, and those far from the hand";
}

}  // namespace
