// SPDX-License-Identifier: Apache-2.0
// Compares the picture that each eye of a viewer sees with a picture that is drawn from the eye's place. The outputs of
// every tile are painted as a rank paints them, and separated as glasses do.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "pictures/compare.hpp"
#include "render_node/gl/window_context.hpp"
#include "render_node/tile_painter.hpp"
#include "tests/render_node/grid_and_desk.hpp"
#include "walls/stereo_change.hpp"

namespace {

using pictures::Image;
using render_node::OutputPicture;
using render_node::TilePainter;
using sample::cameraByHand;
using sample::gridAndDesk;
using sample::kEyePixels;
using walls::Eye;
using walls::Stereo;

/// Levels of channels, in the order of Image::rgb; -1 if an eye does not see the channel.
using ChannelLevels = std::vector<int>;

double lightOf(int level) {
    const double share = level / 255.0;
    return share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
}
int levelOf(double light) {
    const double share = std::clamp(light, 0.0, 1.0);
    return static_cast<int>(
        std::lround(255 * (share <= 0.0031308 ? 12.92 * share : 1.055 * std::pow(share, 1 / 2.4) - 0.055)));
}

/// The matrices of docs/stereo.md: the weights of the left eye's and the right eye's red, green, blue in each of red,
/// green, blue.
constexpr std::array<std::array<double, 6>, 3> kDubois{
    {{0.456100, 0.500484, 0.176381, -0.0434706, -0.0879388, -0.00155529},
     {-0.0400822, -0.0378246, -0.0157589, 0.378476, 0.733640, -0.0184503},
     {-0.0152161, -0.0205971, -0.00546856, -0.0721527, -0.112961, 1.22640}}};

/// Returns the level that an anaglyph must show in one channel for these pixels of the left and the right eye.
int anaglyphLevel(Stereo stereo, std::size_t channel, const std::uint8_t* left, const std::uint8_t* right) {
    if (stereo == Stereo::anaglyphDubois) {
        double sum = 0;
        for (std::size_t from = 0; from < 3; ++from) {
            sum += kDubois.at(channel).at(from) * lightOf(left[from]);
            sum += kDubois.at(channel).at(3 + from) * lightOf(right[from]);
        }
        return levelOf(sum);
    }
    if (channel == 0 && stereo == Stereo::anaglyphHalf) {
        return levelOf(0.2126 * lightOf(left[0]) + 0.7152 * lightOf(left[1]) + 0.0722 * lightOf(left[2]));
    }
    return channel == 0 ? left[0] : right[channel];
}

bool isAnaglyph(Stereo stereo) { return stereo >= Stereo::anaglyphColour; }

/// Returns whether an eye sees a pixel's channel through the glasses that a mode needs.
bool passes(Stereo stereo, Eye eye, int x, int y, std::size_t channel) {
    const bool left = eye == Eye::left;
    return stereo == Stereo::rowInterlaced  ? (y % 2 == 0) == left
           : stereo == Stereo::checkerboard ? ((x + y) % 2 == 0) == left
           : isAnaglyph(stereo)             ? (channel == 0) == left
                                            : true;
}

/// Returns the levels that an eye sees of an output through the glasses that the mode needs.
ChannelLevels seenThroughGlasses(Stereo stereo, const OutputPicture& output, Eye eye) {
    const bool right = eye == Eye::right;
    Image image = sample::pictureOf(right && output.right != nullptr ? *output.right : *output.picture);
    if (stereo == Stereo::sideBySide) {
        image = pictures::crop(image, right ? kEyePixels.x : 0, 0, kEyePixels.x, kEyePixels.y);
    } else if (stereo == Stereo::topBottom) {
        image = pictures::crop(image, 0, right ? kEyePixels.y : 0, kEyePixels.x, kEyePixels.y);
    }
    ChannelLevels levels;
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        const auto pixel = static_cast<int>(i / 3);
        levels.push_back(passes(stereo, eye, pixel % kEyePixels.x, pixel / kEyePixels.x, i % 3) ? image.rgb[i] : -1);
    }
    return levels;
}

/// Returns the levels that the eye should see there, if these are the pictures of the two eyes.
ChannelLevels levelsWanted(Stereo stereo, Eye eye, const Image& left, const Image& right) {
    ChannelLevels levels;
    const Image& own = eye == Eye::right ? right : left;
    for (std::size_t i = 0; i < own.rgb.size(); ++i) {
        const std::size_t pixel = i - i % 3;
        levels.push_back(isAnaglyph(stereo) ? anaglyphLevel(stereo, i % 3, &left.rgb[pixel], &right.rgb[pixel])
                                            : int{own.rgb[i]});
    }
    return levels;
}

/// Returns the share of the seen levels that differ by more than 8 from the right ones.
double shareOfWrong(const ChannelLevels& seen, const ChannelLevels& expected) {
    int count = 0, wrong = 0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        count += seen[i] >= 0 ? 1 : 0;
        wrong += seen[i] >= 0 && std::abs(seen[i] - expected.at(i)) > 8 ? 1 : 0;
    }
    EXPECT_GE(count, kEyePixels.x * kEyePixels.y) << "at least one of three channels";
    return static_cast<double>(wrong) / count;
}

// Limits for the share of wrong levels. A frustum that is computed in another order has other rounding errors, which
// may change a pixel at a silhouette; here they changed none. If an eye sees the other eye's picture, at least 7 % of
// the levels are wrong. If the left eye sees the picture from the middle, 2.6 % are wrong.
constexpr double kFewWrong = 0.001, kManyWrong = 0.02;

class Viewer : public sample::GridAndDesk {
protected:
    Viewer() {
        for (std::size_t tile = 0; tile < 3; ++tile) {
            for (const Eye eye : {Eye::left, Eye::right, Eye::middle}) {
                expected_.at(tile).push_back(drawn(tile, eye));
            }
        }
    }
    /// Returns the sand as an eye sees it through a tile.
    [[nodiscard]] Image drawn(std::size_t tile, Eye eye) const {
        const sand::Replica replica = dug();
        render_node::ScenePainter painter(scene_, sceneToRoom());
        painter.update(replica.surface().data(), {});
        painter.setTool(replica.probe(), true);
        const render_node::EyeTarget target(kEyePixels.x, kEyePixels.y);
        painter.draw(cameraByHand(tile, eye), target);
        return sample::pictureOf(target);
    }
    /// Checks that every eye sees its own picture on every output of the tile, and that the other eye's picture would
    /// fail.
    void expectEachEyeItsPicture(Stereo stereo, std::size_t tile, const std::vector<OutputPicture>& outputs) {
        const std::string what = "tile " + std::to_string(tile) + " in " + std::string(walls::stereoName(stereo));
        const auto pictureFor = [&](Eye eye) { return expected_.at(tile).at(static_cast<std::size_t>(eye)); };
        const bool both = walls::eyesOf(stereo).size() == 2;
        ASSERT_FALSE(outputs.empty()) << what;
        for (const Eye eye : {Eye::left, Eye::right}) {
            // If a wall shows one picture, both eyes of a viewer see it.
            const Image left = pictureFor(both ? Eye::left : walls::eyesOf(stereo)[0]);
            const Image right = both ? pictureFor(Eye::right) : left;
            const Image other = stereo == Stereo::left ? pictureFor(Eye::right) : pictureFor(Eye::left);
            for (std::size_t i = 0; i < outputs.size(); ++i) {
                if (stereo == Stereo::passive && i != static_cast<std::size_t>(eye)) {
                    continue;  // the eye's glass blocks the light of this projector
                }
                const ChannelLevels seen = seenThroughGlasses(stereo, outputs[i], eye);
                EXPECT_LT(shareOfWrong(seen, levelsWanted(stereo, eye, left, right)), kFewWrong)
                    << what << ", output " << i;
                const ChannelLevels swapped =
                    both ? levelsWanted(stereo, eye, right, left) : levelsWanted(stereo, eye, other, other);
                EXPECT_GT(shareOfWrong(seen, swapped), kManyWrong) << what << ", output " << i << ": the other eye";
                ++seen_;
            }
        }
    }

    std::array<std::vector<Image>, 3> expected_;  // for each tile, in the order of walls::Eye
    int seen_ = 0;                                // number of outputs that each eye was compared on
};

// A wall has a grid and a screen in another plane, so that several outputs of a mode are compared.
TEST_F(Viewer, SeesWithEachEyeItsPictureOnEveryOutputInEveryMode) {
    for (const auto& [stereo, name] : valuesOf(Stereo{})) {
        const walls::Wall wall = gridAndDesk(stereo);
        for (std::size_t tile = 0; tile < wall.tiles.size(); ++tile) {
            TilePainter painter(wall, wall.tiles[tile], scene_, "host", sand::GridData{scene_.terrain});
            sand::Replica replica = dug();
            painter.paint(replica, view(), 1);
            ASSERT_EQ(painter.outputs().size(), stereo == Stereo::passive ? 2U : 1U) << name;
            expectEachEyeItsPicture(stereo, tile, painter.outputs());
        }
    }
    EXPECT_EQ(seen_, static_cast<int>(valuesOf(Stereo{}).size()) * 3 * 2) << "modes, tiles and eyes";
}

// One session changes through all modes, as an operator does. Open outputs stay open.
TEST_F(Viewer, SeesWithEachEyeItsPictureOnTwoOutputsThatChangeTheirMode) {
    for (const Stereo begun : {Stereo::anaglyphColour, Stereo::passive}) {
        const walls::Wall wall = gridAndDesk(begun);
        const std::vector<Stereo> modes =
            begun == Stereo::passive
                ? std::vector{Stereo::left, Stereo::passive, Stereo::mono, Stereo::right, Stereo::passive}
                : std::vector{Stereo::checkerboard, Stereo::anaglyphDubois, Stereo::mono,   Stereo::anaglyphColour,
                              Stereo::right,        Stereo::rowInterlaced,  Stereo::active, Stereo::anaglyphHalf};
        std::array<sand::Replica, 2> terrains{dug(), dug()};
        std::vector<walls::Wall> shown(modes.size() + 1, wall);  // painters refer to them
        std::array<std::unique_ptr<TilePainter>, 2> painters;
        for (std::size_t tile = 0; tile < painters.size(); ++tile) {
            painters.at(tile) = std::make_unique<TilePainter>(shown[0], shown[0].tiles[tile], scene_, "host",
                                                              sand::GridData{scene_.terrain});
            painters.at(tile)->paint(terrains.at(tile), view(), 1);
            expectEachEyeItsPicture(begun, tile, painters.at(tile)->outputs());
        }
        for (std::size_t i = 0; i < modes.size(); ++i) {
            shown[i + 1] = walls::shownOnItsOutputs(wall, modes[i]);
            for (std::size_t tile = 0; tile < painters.size(); ++tile) {
                painters.at(tile)->showAs(shown[i + 1], shown[i + 1].tiles[tile]);
                painters.at(tile)->paint(terrains.at(tile), view(), i + 2);
                expectEachEyeItsPicture(modes[i], tile, painters.at(tile)->outputs());
            }
        }
    }
    EXPECT_EQ(seen_, 2 * 2 * 9 + 2 * (3 * 2 + 3 * 4));
}

// Without quad buffers a rank draws one eye per frame, and a window shows one eye of it. Both must choose the same eye.
TEST_F(Viewer, SeesOfEyesInTurnTheOneThatWasDrawnInThisFrame) {
    const walls::Wall wall = gridAndDesk(Stereo::active);
    TilePainter inTurn(wall, wall.tiles[0], scene_, "host", sand::GridData{scene_.terrain}),
        both(wall, wall.tiles[0], scene_, "host", sand::GridData{scene_.terrain});
    sand::Replica first = dug(), second = dug();
    std::vector<Image> shown;
    for (std::uint64_t frame = 0; frame < 8; ++frame) {
        dig(first);
        dig(second);
        inTurn.paint(first, view(), frame, true);
        both.paint(second, view(), frame);
        const auto copies = render_node::copiesOf(inTurn.outputs().at(0), false, frame);
        ASSERT_EQ(copies.size(), 1U);
        const OutputPicture eyes = both.outputs().at(0);
        const Image own = sample::pictureOf(frame % 2 == 0 ? *eyes.picture : *eyes.right);
        EXPECT_EQ(sample::pictureOf(*copies[0].picture), own) << "frame " << frame;
        EXPECT_NE(own, sample::pictureOf(frame % 2 == 0 ? *eyes.right : *eyes.picture));
        EXPECT_TRUE(shown.empty() || own != shown.back());
        shown.push_back(own);
    }
}

/// Returns the eye whose glass is in front of an eye, if the glasses are exchanged.
Eye throughSwappedGlasses(Eye eye) { return eye == Eye::left ? Eye::right : Eye::left; }

// The viewer's glasses are exchanged, so that each eye looks through the glass of the other. The wall swaps its eyes.
TEST_F(Viewer, SeesThroughExchangedGlassesItsPictureOnAWallThatSwapsEyes) {
    int compared = 0;
    for (const auto& [stereo, name] : valuesOf(Stereo{})) {
        if (walls::eyesOf(stereo).size() < 2) {
            continue;
        }
        const walls::Wall wall = walls::withSwappedEyes(gridAndDesk(stereo), true);
        TilePainter painter(wall, wall.tiles[0], scene_, "host", sand::GridData{scene_.terrain});
        sand::Replica replica = dug();
        painter.paint(replica, view(), 1);
        const Image left = expected_.at(0).at(0), right = expected_.at(0).at(1);
        for (const Eye eye : {Eye::left, Eye::right}) {
            const Eye glass = throughSwappedGlasses(eye);
            const auto outputs = painter.outputs();
            const OutputPicture& output =
                stereo == Stereo::passive ? outputs.at(static_cast<std::size_t>(glass)) : outputs.at(0);
            const ChannelLevels seen = seenThroughGlasses(stereo, output, glass);
            EXPECT_LT(shareOfWrong(seen, levelsWanted(stereo, glass, right, left)), kFewWrong) << name;
            EXPECT_GT(shareOfWrong(seen, levelsWanted(stereo, glass, left, right)), kManyWrong) << name;
            ++compared;
        }
        // Pictures of an eye are those of that eye.
        EXPECT_LT(pictures::compare(sample::pictureOf(*painter.pictures().at(0)), left, 8).badShare, kFewWrong) << name;
    }
    EXPECT_EQ(compared, 9 * 2) << "all modes but mono, left and right";
}

// Even frames show the right eye then.
TEST_F(Viewer, SeesOfSwappedEyesInTurnTheOneThatWasDrawnInThisFrame) {
    const walls::Wall wall = walls::withSwappedEyes(gridAndDesk(Stereo::active), true);
    TilePainter inTurn(wall, wall.tiles[0], scene_, "host", sand::GridData{scene_.terrain});
    sand::Replica replica = dug();
    for (std::uint64_t frame = 0; frame < 4; ++frame) {
        inTurn.paint(replica, view(), frame, true);
        const auto copies = render_node::copiesOf(inTurn.outputs().at(0), false, frame);
        const Image& own = expected_.at(0).at(frame % 2 == 0 ? 1 : 0);
        EXPECT_LT(pictures::compare(sample::pictureOf(*copies.at(0).picture), own, 8).badShare, kFewWrong) << frame;
    }
}

}  // namespace
