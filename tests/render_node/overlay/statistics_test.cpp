// SPDX-License-Identifier: Apache-2.0
#include "render_node/overlay/statistics.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "render_node/tile_painter.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/pictures/wall_painter.hpp"

namespace {

using lockstep::Overlay;
using render_node::EyeTarget;
using render_node::overlayLayout;
using render_node::OverlayLayout;
using render_node::PixelRect;
using render_node::TileFigures;
using render_node::TilePainter;
using render_node::TileStatistics;
using sample::Pixels;

constexpr std::size_t kTile = 5;  // of the tiled wall, counted from 0: rank 6, in the middle of the sand

lockstep::ViewState viewOf(const walls::Wall& wall, const scene::Scene& scene, bool statistics) {
    lockstep::ViewState view;
    const double width = scene.terrain.columns() * scene.terrain.cellSize();
    const glm::dmat4 toRoom = walls::stageToRoom(wall.stage, width, width,
                                                 static_cast<double>(scene.referenceHeight()) * scene.terrain.unit());
    for (int i = 0; i < 3; ++i) {
        view.head.at(static_cast<std::size_t>(i)) = wall.viewer.eye[i];
        view.right.at(static_cast<std::size_t>(i)) = wall.viewer.right[i];
    }
    view.eyeSeparation = wall.viewer.eyeSeparation;
    for (int i = 0; i < 16; ++i) {
        view.sceneToRoom.at(static_cast<std::size_t>(i)) = toRoom[i / 4][i % 4];
    }
    view.layers.set(Overlay::statistics, statistics);
    return view;
}

/// Returns the master's figures for a wall whose rank 5 is slow.
TileFigures figuresOf(std::uint64_t frame) {
    const double draw = 2 + static_cast<double>(frame * 7 % 5);
    const lockstep::WallFigures wall{.frameMs = 33.3,
                                     .slowest = lockstep::Drag{5, 0.97, 30.1},
                                     .agreed = frame - 1,
                                     .slowMotion = {},
                                     .dark = {},
                                     .swaps = {0, 12, 500, 7, 90, 131}};
    return {draw, 31 - draw, wall};
}

/// Returns whether every byte outside `rect` is equal. `rect` counts pixels from the bottom.
testing::AssertionResult equalOutside(const PixelRect& rect, const Pixels& a, const Pixels& b,
                                      const EyeTarget& target) {
    const int width = target.width(), height = target.height();
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const int row = height - 1 - y;
            const bool inside = x >= rect.x0 && x < rect.x1 && row >= rect.y0 && row < rect.y1;
            if (!inside && sample::pixel(a, width, x, y) != sample::pixel(b, width, x, y)) {
                return testing::AssertionFailure() << "column " << x << ", row " << y << " from the top";
            }
        }
    }
    return testing::AssertionSuccess();
}

/// One session on one tile, drawn twice: one tile shows the statistics for some time, the other never does.
class StatisticsOverlay : public testing::Test {
protected:
    void prepare(walls::Stereo stereo, int smaller) {
        wall_ = sample::reduced(walls::loadWall(sample::wallFolder() / "tiled_3x4.toml"), smaller);
        wall_.stereo = stereo;
        const walls::Tile& tile = wall_.tiles.at(kTile);
        covered_ = overlayLayout(tile.pixels).pixels(tile.pixels);
        shown_ = std::make_unique<TilePainter>(wall_, tile, scene_, "node6", sand::GridData{scene_.terrain});
        never_ = std::make_unique<TilePainter>(wall_, tile, scene_, "node6", sand::GridData{scene_.terrain});
    }
    /// Draws a frame of digging or of rest.
    void paintBoth(bool statistics, bool dig, bool oneEye = false) {
        ++frame_;
        for (sand::Replica* replica : {&first_, &second_}) {
            sand::Step step;
            step.number = replica->stepNumber() + 1;
            step.engaged = dig;
            if (dig) {
                const double along = 0.01 * static_cast<double>(frame_);
                step.path = {sample::probeAt(scene_, {0.7 + along, 0.9 + 0.3 * along, 0.03})};
            }
            replica->apply(step);
        }
        shown_->paint(first_, viewOf(wall_, scene_, statistics), frame_, oneEye, figuresOf(frame_));
        never_->paint(second_, viewOf(wall_, scene_, false), frame_, oneEye);
    }
    void expectEqualOutside(const PixelRect& rect, const std::string& when) {
        const auto a = shown_->pictures(), b = never_->pictures();
        for (std::size_t i = 0; i < a.size(); ++i) {
            EXPECT_TRUE(equalOutside(rect, a[i]->read(), b[i]->read(), *a[i])) << when << ", picture " << i;
        }
    }

    std::unique_ptr<render_node::GlContext> context_ =
        render_node::makeOffscreenContext(render_node::Backend::automatic);
    walls::Wall wall_;
    scene::Scene scene_ = sample::duneScene(128);
    sand::Replica first_{scene_}, second_{scene_};
    PixelRect covered_;
    std::uint64_t frame_ = 0;
    std::unique_ptr<TilePainter> shown_, never_;
};

TEST_F(StatisticsOverlay, LeavesTheSandAroundItAloneAndComesOffWithoutATrace) {
    prepare(walls::Stereo::passive, 4);
    ASSERT_FALSE(covered_.empty());
    for (int i = 0; i < 60; ++i) {
        const bool on = (i >= 3 && i < 25) || (i >= 40 && i < 50);
        paintBoth(on, i < 30);
        expectEqualOutside(on ? covered_ : PixelRect{}, "frame " + std::to_string(i));
        if (on) {
            const auto eyes = shown_->pictures();
            EXPECT_NE(eyes[0]->read(), never_->pictures()[0]->read()) << "nothing was shown";
        }
        ASSERT_FALSE(HasFailure());
    }
}

TEST_F(StatisticsOverlay, IsThereInThePicturesThatHoldBothEyes) {
    for (const walls::Stereo stereo : {walls::Stereo::anaglyphDubois, walls::Stereo::rowInterlaced}) {
        prepare(stereo, 4);
        for (int i = 0; i < 9; ++i) {
            const bool on = i >= 2 && i < 6;
            paintBoth(on, true);
            expectEqualOutside(on ? covered_ : PixelRect{}, "frame " + std::to_string(i));
            EXPECT_EQ(shown_->pictures().back()->read() != never_->pictures().back()->read(), on) << i;
        }
    }
}

TEST_F(StatisticsOverlay, ComesOffEachEyeThatIsShownInTurn) {
    prepare(walls::Stereo::active, 4);
    for (int i = 0; i < 20; ++i) {
        const bool on = i >= 4 && i < 9;
        paintBoth(on, i < 15, true);
        if (!on && i != 9) {  // in frame 9 one eye is not drawn yet
            expectEqualOutside({}, "frame " + std::to_string(i));
        } else {
            expectEqualOutside(covered_, "frame " + std::to_string(i));
        }
    }
}

TEST_F(StatisticsOverlay, IsTheSameForBothEyes) {
    prepare(walls::Stereo::passive, 2);
    for (int i = 0; i < 5; ++i) {
        paintBoth(true, true);
    }
    const auto eyes = shown_->pictures();
    const Pixels left = eyes[0]->read(), right = eyes[1]->read();
    ASSERT_NE(left, right);
    const int width = eyes[0]->width(), height = eyes[0]->height();
    for (int row = covered_.y0; row < covered_.y1; ++row) {
        for (int x = covered_.x0; x < covered_.x1; ++x) {
            ASSERT_EQ(sample::pixel(left, width, x, height - 1 - row),
                      sample::pixel(right, width, x, height - 1 - row));
        }
    }
}

TEST_F(StatisticsOverlay, OfAStillWallHasNoSandDrawnButWhereItWas) {
    prepare(walls::Stereo::passive, 2);
    paintBoth(false, false);
    paintBoth(false, false);
    const std::int64_t before = shown_->viewCounts().pixelsDrawn;
    for (int i = 0; i < 5; ++i) {
        paintBoth(true, false);
    }
    EXPECT_EQ(shown_->viewCounts().pixelsDrawn, before);
    paintBoth(false, false);
    EXPECT_EQ(shown_->viewCounts().pixelsDrawn, before + 2 * covered_.area());
    paintBoth(false, false);
    EXPECT_EQ(shown_->viewCounts().pixelsDrawn, before + 2 * covered_.area());
}

TEST_F(StatisticsOverlay, GivesWayToATestPattern) {
    prepare(walls::Stereo::passive, 4);
    paintBoth(true, true);
    lockstep::ViewState grid = viewOf(wall_, scene_, true), bare = viewOf(wall_, scene_, false);
    grid.pattern = bare.pattern = static_cast<std::uint8_t>(lockstep::Pattern::grid);
    shown_->paint(first_, grid, ++frame_);
    never_->paint(second_, bare, frame_);
    expectEqualOutside({}, "pattern");
    paintBoth(false, true);
    expectEqualOutside({}, "sand again");
}

TEST_F(StatisticsOverlay, WritesItsWordsInTheFontOfTheHelp) {
    prepare(walls::Stereo::passive, 1);
    for (int i = 0; i < 3; ++i) {
        paintBoth(true, false);
    }
    const OverlayLayout layout = overlayLayout(wall_.tiles.at(kTile).pixels);
    ASSERT_NE(layout.face, nullptr);
    const render_node::Face& face = *layout.face;
    const EyeTarget& eye = *shown_->pictures()[0];
    const Pixels picture = eye.read();
    // The colour behind the words is that of the panel's corner within its frame.
    const int padding = face.size / 2;
    const auto back = sample::pixel(picture, eye.width(), layout.at.x + padding / 2, layout.at.y + padding / 2);
    const std::string words = "RANK 6 r2c2 ON node6";
    render_node::Sheet sheet({render_node::textWidth(face, words), face.lineHeight}, {back[0], back[1], back[2]});
    sheet.write(face, words, {0, 0}, {235, 237, 242});
    for (int y = 0; y < sheet.size().y; ++y) {
        for (int x = 0; x < sheet.size().x; ++x) {
            const auto got = sample::pixel(picture, eye.width(), layout.at.x + padding + x, layout.at.y + padding + y);
            const auto want = sheet.rgb().subspan(3 * static_cast<std::size_t>(y * sheet.size().x + x), 3);
            for (int channel = 0; channel < 3; ++channel) {
                ASSERT_EQ(got[channel], want[static_cast<std::size_t>(channel)]) << x << ", " << y;
            }
        }
    }
}

TEST(OverlayLayout, FitsEveryTile) {
    for (const glm::ivec2 tile : {glm::ivec2(1024, 768),
                                  {96, 72},
                                  {1920, 1080},
                                  {3840, 2160},
                                  {480, 1080},
                                  {640, 90},
                                  {340, 310},
                                  {40, 30},
                                  {1, 1},
                                  {768, 1024}}) {
        const OverlayLayout layout = overlayLayout(tile);
        SCOPED_TRACE(std::to_string(tile.x) + " x " + std::to_string(tile.y));
        EXPECT_LE(layout.at.x + layout.size.x, tile.x);
        EXPECT_LE(5 * layout.size.y, 3 * tile.y);
        EXPECT_EQ(layout.pixels(tile).empty(), tile.x == 1);
    }
    EXPECT_EQ(overlayLayout({96, 72}).face, nullptr);
    const auto sizeAt = [](int width, int height) { return overlayLayout({width, height}).face->size; };
    EXPECT_EQ(sizeAt(1024, 768), 16);
    EXPECT_EQ(sizeAt(1920, 1080), 26);
    EXPECT_EQ(sizeAt(3840, 2160), 44);
    const glm::ivec2 least = (5 * overlayLayout({480, 1080}).size + 2) / 3;
    EXPECT_EQ(least, glm::ivec2(349, 332)) << "as the header and docs/operator.md say";
    EXPECT_NE(overlayLayout(least).face, nullptr);
    EXPECT_EQ(overlayLayout({least.x - 1, least.y}).face, nullptr);
    EXPECT_EQ(overlayLayout({least.x, least.y - 1}).face, nullptr);
    EXPECT_EQ(overlayLayout({96, 72}).lines, 4);
}

TEST(OverlayLayout, GraphsEndAtRoundNumbers) {
    EXPECT_EQ(render_node::axisEnd(1), 1);
    EXPECT_EQ(render_node::axisEnd(1.1), 2);
    EXPECT_EQ(render_node::axisEnd(33.3), 50);
    EXPECT_EQ(render_node::axisEnd(50), 50);
    EXPECT_EQ(render_node::axisEnd(50.1), 100);
    EXPECT_DOUBLE_EQ(render_node::axisEnd(0.1), 0.1);
    EXPECT_DOUBLE_EQ(render_node::axisEnd(0.13), 0.2);
}

/// Returns the texts on one tile of the tiled wall, after some frames.
std::vector<TileStatistics::Line> wordsOf(int rank, std::size_t letters, const lockstep::WallFigures& wall,
                                          std::size_t count = 10) {
    const walls::Wall tiled = walls::loadWall(sample::wallFolder() / "tiled_3x4.toml");
    TileStatistics statistics(tiled, tiled.tiles.at(static_cast<std::size_t>(rank - 1)), "a-host-with-a-long-name");
    for (std::uint64_t frame = 1; frame <= 200; ++frame) {
        statistics.add({31.25, 1.2, wall}, frame);
    }
    return statistics.lines(letters, count);
}

std::string joined(const std::vector<TileStatistics::Line>& lines) {
    std::string all;
    for (const TileStatistics::Line& line : lines) {
        all += line.text + "\n";
    }
    return all;
}

TEST(OverlayText, NamesTheSlowRankOnEveryTile) {
    const lockstep::WallFigures figures = figuresOf(200).wall;
    for (const int rank : {1, 5, 12}) {
        const std::string words = joined(wordsOf(rank, TileStatistics::kLetters, figures));
        EXPECT_NE(words.find("SLOWEST: RANK 5 r2c1, 97 %\nTHE WALL WAITS 30.1 MS FOR IT\n"), std::string::npos)
            << words;
    }
    EXPECT_EQ(joined(wordsOf(5, TileStatistics::kLetters, figures)),
              "RANK 5 r2c1 ON a-host-with-a-lon\n30.0 FPS, FRAME 200\nHASHES AGREED IN 199 FRAMES\n"
              "SLOWEST: RANK 5 r2c1, 97 %\nTHE WALL WAITS 30.1 MS FOR IT\n");
    EXPECT_EQ(joined(wordsOf(5, 15, figures)), "R5 30.0 FPS\nSLOWEST R5 97%\nDRAW 31.2 MS\nAGREED 199\n");
}

TEST(OverlayText, AccusesNobodyWhereNoneStandsOut) {
    lockstep::WallFigures figures = figuresOf(200).wall;
    figures.slowest.reset();
    figures.divergences = 2;
    figures.healed = 3;
    EXPECT_EQ(joined(wordsOf(5, TileStatistics::kLetters, figures)),
              "RANK 5 r2c1 ON a-host-with-a-lon\n30.0 FPS, FRAME 200\nDIFFERED IN 2 FRAMES, HEALED 3\n"
              "SLOWEST: NO RANK STANDS OUT\n");
    EXPECT_EQ(joined(wordsOf(5, 15, figures)), "R5 30.0 FPS\nSLOWEST -\nDRAW 31.2 MS\nDIFFERED 2\n");
    figures.slowest = lockstep::Drag{0, 0.5, 12};
    EXPECT_NE(joined(wordsOf(5, TileStatistics::kLetters, figures)).find("SLOWEST: THE MASTER, 50 %"),
              std::string::npos);
}

TEST(OverlayText, ShowsSlowMotionWhileTheToolIsSlowerThanTheHand) {
    lockstep::WallFigures figures = figuresOf(200).wall;
    figures.slowest.reset();
    figures.slowMotion = 1.1;
    EXPECT_EQ(joined(wordsOf(5, TileStatistics::kLetters, figures)).find("SLOW MOTION"), std::string::npos);
    figures.slowMotion = 6.34;
    EXPECT_EQ(joined(wordsOf(5, TileStatistics::kLetters, figures)),
              "RANK 5 r2c1 ON a-host-with-a-lon\n30.0 FPS, FRAME 200\nHASHES AGREED IN 199 FRAMES\n"
              "SLOW MOTION 6.3, 0 OWED\nSLOWEST: NO RANK STANDS OUT\n");
    EXPECT_EQ(joined(wordsOf(5, 15, figures)), "R5 30.0 FPS\nSLOWEST -\nSLOW 6.3\nAGREED 199\n");
    figures.unplaced = 12;
    EXPECT_NE(joined(wordsOf(5, TileStatistics::kLetters, figures))
                  .find("HASHES AGREED IN 199 FRAMES\nNO ROOM FOR SAND IN 12 STEPS\nSLOW MOTION 6.3, 0 OWED\n"),
              std::string::npos);
    figures.slowMotion.reset();
    figures.sweepsOwed = 3840;
    EXPECT_NE(joined(wordsOf(5, TileStatistics::kLetters, figures)).find("SLOW MOTION 1.0, 3840 OWED\n"),
              std::string::npos);
}

// A panel with graphs has five lines. Seven are wanted if the tool is slow, found no room, and a rank is slow.
TEST(OverlayText, LeavesOutNoWarningWhereNotAllLinesFit) {
    lockstep::WallFigures figures = figuresOf(200).wall;
    figures.unplaced = 12;
    figures.slowMotion = 6.34;
    constexpr std::size_t kFive = TileStatistics::kLongLines;
    ASSERT_EQ(overlayLayout({1024, 768}).lines, static_cast<int>(kFive));
    EXPECT_EQ(joined(wordsOf(5, TileStatistics::kLetters, figures, kFive)),
              "RANK 5 r2c1 ON a-host-with-a-lon\n30.0 FPS, FRAME 200\nNO ROOM FOR SAND IN 12 STEPS\n"
              "SLOW MOTION 6.3, 0 OWED\nSLOWEST: RANK 5 r2c1, 97 %\n");
    figures.divergences = 2;
    EXPECT_EQ(joined(wordsOf(5, TileStatistics::kLetters, figures, kFive)),
              "RANK 5 r2c1 ON a-host-with-a-lon\nDIFFERED IN 2 FRAMES, HEALED 0\nNO ROOM FOR SAND IN 12 STEPS\n"
              "SLOW MOTION 6.3, 0 OWED\nSLOWEST: RANK 5 r2c1, 97 %\n");
    figures.slowMotion.reset();
    figures.slowest.reset();
    figures.divergences = 0;
    EXPECT_EQ(joined(wordsOf(5, TileStatistics::kLetters, figures, kFive)),
              "RANK 5 r2c1 ON a-host-with-a-lon\n30.0 FPS, FRAME 200\nHASHES AGREED IN 199 FRAMES\n"
              "NO ROOM FOR SAND IN 12 STEPS\nSLOWEST: NO RANK STANDS OUT\n");
    EXPECT_EQ(joined(wordsOf(5, 15, figures, 2)), "R5 30.0 FPS\nSLOWEST -\n");
}

TEST(OverlayText, KeepsTheLast120Frames) {
    render_node::History history;
    for (int i = 0; i < 500; ++i) {
        history.add(i == 100 ? 9999 : i);
    }
    EXPECT_EQ(history.values().size(), 120U);
    EXPECT_EQ(history.values().front(), 380);
    EXPECT_EQ(history.latest(), 499);
    EXPECT_EQ(history.largest(), 499);
}

TEST(OverlayText, NamesTheDarkTileOnEveryTile) {
    lockstep::WallFigures figures = figuresOf(200).wall;
    figures.slowest.reset();
    figures.dark = {6};
    for (const int rank : {1, 6, 12}) {
        const std::string words = joined(wordsOf(rank, TileStatistics::kLetters, figures));
        EXPECT_NE(words.find("\nDARK: RANK 6 r2c2\n"), std::string::npos) << words;
    }
    figures.dark = {2, 6, 7};
    EXPECT_NE(joined(wordsOf(5, TileStatistics::kLetters, figures)).find("DARK: RANK 2 r1c2 AND 2 MORE\n"),
              std::string::npos);
    EXPECT_EQ(joined(wordsOf(5, 15, figures)), "R5 30.0 FPS\nDARK R2 R6 R7\nDRAW 31.2 MS\nAGREED 199\n");
    // With every other warning, the tile's own name is left out.
    figures.slowest = lockstep::Drag{5, 0.97, 30.1};
    figures.divergences = 2;
    figures.unplaced = 12;
    figures.slowMotion = 6.34;
    EXPECT_EQ(joined(wordsOf(5, TileStatistics::kLetters, figures, TileStatistics::kLongLines)),
              "DARK: RANK 2 r1c2 AND 2 MORE\nDIFFERED IN 2 FRAMES, HEALED 0\nNO ROOM FOR SAND IN 12 STEPS\n"
              "SLOW MOTION 6.3, 0 OWED\nSLOWEST: RANK 5 r2c1, 97 %\n");
}

}  // namespace
