// SPDX-License-Identifier: Apache-2.0
#include "render_node/stereo_composer.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <vector>

#include "pictures/stereo_packing.hpp"

namespace {

using pictures::Image;
using render_node::EyeTarget;
using render_node::StereoComposer;
using walls::Stereo;

/// Returns random levels. One half of the picture is dark, where light has more steps than there are levels.
Image noise(int width, int height, unsigned seed) {
    std::mt19937 random(seed);
    Image image(width, height);
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        image.rgb[i] = static_cast<std::uint8_t>(i < image.rgb.size() / 2 ? random() : random() % 24);
    }
    return image;
}

void fill(const EyeTarget& target, const Image& image) {
    std::vector<std::uint8_t> fromBelow;
    for (int y = image.height - 1; y >= 0; --y) {
        fromBelow.insert(fromBelow.end(), image.at(0, y), image.at(0, y) + 3L * image.width);
    }
    glBindTexture(GL_TEXTURE_2D, target.colour());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, image.width, image.height, GL_RGB, GL_UNSIGNED_BYTE, fromBelow.data());
}

Image pictureOf(const EyeTarget& target) {
    Image image(target.width(), target.height());
    image.rgb = target.read();
    return image;
}

walls::Tile tileOf(Stereo stereo, int width, int height) {
    walls::Tile tile;
    tile.name = "only";
    tile.pixels = {width, height};
    tile.outputs = walls::outputsOf(stereo, tile.name);
    return tile;
}

/// Returns all modes that put both eyes into one picture.
std::vector<Stereo> packedModes() {
    std::vector<Stereo> modes;
    for (const auto& mode : valuesOf(Stereo{})) {
        if (walls::packsEyes(mode.value)) {
            modes.push_back(mode.value);
        }
    }
    EXPECT_GE(modes.size(), 7U);
    return modes;
}

class Composer : public testing::Test {
protected:
    /// Returns the targets of a mode's eyes, with each eye's picture in them.
    std::vector<EyeTarget> eyesOf(Stereo stereo) const {
        std::vector<EyeTarget> targets;
        for (const walls::Eye eye : walls::eyesOf(stereo)) {
            targets.emplace_back(left_.width, left_.height);
            fill(targets.back(), eye == walls::Eye::right ? right_ : left_);
        }
        return targets;
    }
    void setSize(int width, int height) {
        left_ = noise(width, height, 1);
        right_ = noise(width, height, 2);
    }

    std::unique_ptr<render_node::GlContext> context_ =
        render_node::makeOffscreenContext(render_node::Backend::automatic);
    Image left_, right_;
};

TEST_F(Composer, EqualsTheReferenceInEveryModeAndSize) {
    for (const auto& [width, height] : {std::pair{1, 1}, {7, 5}, {64, 48}, {33, 2}, {255, 131}}) {
        setSize(width, height);
        for (const Stereo stereo : packedModes()) {
            const std::vector<EyeTarget> eyes = eyesOf(stereo);
            StereoComposer composer(stereo, tileOf(stereo, width, height));
            // GL state that is left from drawing sand must not matter.
            glEnable(GL_DEPTH_TEST);
            glEnable(GL_CULL_FACE);
            composer.compose(eyes);
            const auto shown = composer.shown(eyes);
            ASSERT_EQ(shown.size(), 1U);
            EXPECT_EQ(shown[0].right, nullptr);
            EXPECT_EQ(pictureOf(*shown[0].picture), pictures::packStereo(stereo, left_, right_))
                << walls::stereoName(stereo) << " of " << width << " x " << height;
            EXPECT_EQ(pictureOf(eyes[0]), left_) << "an eye's own picture must stay";
            EXPECT_EQ(pictureOf(eyes[1]), right_);
        }
    }
}

// A rectangle of each eye has changed. The output must equal the whole composition, and pixels that the rectangle does
// not reach must not be touched.
TEST_F(Composer, PutsOnlyTheChangedRectangleTogether) {
    setSize(61, 47);
    const render_node::PixelRect changed{10, 7, 33, 20};  // rows counted from the bottom
    for (const Stereo stereo : packedModes()) {
        std::vector<EyeTarget> eyes = eyesOf(stereo);
        StereoComposer composer(stereo, tileOf(stereo, left_.width, left_.height));
        composer.compose(eyes);
        const Image before = left_;
        Image left = left_;
        Image right = right_;
        for (int row = changed.y0; row < changed.y1; ++row) {
            for (int x = changed.x0; x < changed.x1; ++x) {
                const int y = left.height - 1 - row;
                std::fill_n(left.at(x, y), 3, std::uint8_t{200});
                std::fill_n(right.at(x, y), 3, std::uint8_t{90});
            }
        }
        fill(eyes[0], left);
        fill(eyes[1], right);
        composer.compose(eyes, changed);
        EXPECT_EQ(pictureOf(*composer.shown(eyes)[0].picture), pictures::packStereo(stereo, left, right))
            << walls::stereoName(stereo);

        // Now every pixel differs, but only the rectangle is composed. All other pixels must stay unchanged.
        fill(eyes[0], right_);
        fill(eyes[1], before);
        composer.compose(eyes, changed);
        const Image part = pictureOf(*composer.shown(eyes)[0].picture);
        EXPECT_NE(part, pictures::packStereo(stereo, right_, before)) << walls::stereoName(stereo);
        EXPECT_NE(part, pictures::packStereo(stereo, left, right)) << walls::stereoName(stereo);
    }
}

TEST_F(Composer, ShowsOneEyeFromItsOwnTarget) {
    setSize(6, 4);
    for (const Stereo stereo : {Stereo::mono, Stereo::left, Stereo::right}) {
        const std::vector<EyeTarget> eyes = eyesOf(stereo);
        ASSERT_EQ(eyes.size(), 1U) << "a wall that shows one eye has the memory of one";
        StereoComposer composer(stereo, tileOf(stereo, 6, 4));
        composer.compose(eyes);
        const auto shown = composer.shown(eyes);
        ASSERT_EQ(shown.size(), 1U);
        EXPECT_EQ(shown[0].picture, eyes.data());
        EXPECT_EQ(shown[0].right, nullptr);
        EXPECT_EQ(composer.bytes(), 0);
    }
}

TEST_F(Composer, GivesEachPolarisedOutputItsEye) {
    setSize(6, 4);
    const std::vector<EyeTarget> eyes = eyesOf(Stereo::passive);
    walls::Tile tile = tileOf(Stereo::passive, 6, 4);
    const StereoComposer composer(Stereo::passive, tile);
    EXPECT_EQ(composer.shown(eyes).at(0).picture, &eyes[0]);
    EXPECT_EQ(composer.shown(eyes).at(1).picture, &eyes[1]);
    EXPECT_EQ(composer.bytes(), 0);
    std::swap(tile.outputs[0], tile.outputs[1]);
    EXPECT_EQ(StereoComposer(Stereo::passive, tile).shown(eyes).at(0).picture, &eyes[1]);
}

TEST_F(Composer, GivesAnActiveOutputBothEyes) {
    setSize(6, 4);
    const std::vector<EyeTarget> eyes = eyesOf(Stereo::active);
    const StereoComposer composer(Stereo::active, tileOf(Stereo::active, 6, 4));
    ASSERT_EQ(composer.shown(eyes).size(), 1U);
    EXPECT_EQ(composer.shown(eyes)[0].picture, &eyes[0]);
    EXPECT_EQ(composer.shown(eyes)[0].right, &eyes[1]);
    EXPECT_EQ(composer.bytes(), 0);
}

TEST_F(Composer, TakesNoDepthForWhatItPutsTogether) {
    const auto bytes = [](Stereo stereo) { return StereoComposer(stereo, tileOf(stereo, 40, 30)).bytes(); };
    EXPECT_EQ(EyeTarget(40, 30).bytes(), 40 * 30 * 8);
    EXPECT_EQ(bytes(Stereo::checkerboard), 40 * 30 * 4);
    EXPECT_EQ(bytes(Stereo::sideBySide), 80 * 30 * 4);
    EXPECT_EQ(bytes(Stereo::anaglyphDubois), 40 * 30 * 4);
}

// The reference packs the two pictures in the other order. The eyes' own pictures stay.
TEST_F(Composer, PacksSwappedEyesInTheOtherOrder) {
    setSize(33, 22);
    for (const Stereo stereo : packedModes()) {
        const std::vector<EyeTarget> eyes = eyesOf(stereo);
        walls::Tile tile = tileOf(stereo, 33, 22);
        tile.outputs = walls::outputsOf(stereo, tile.name, true);
        StereoComposer composer(stereo, tile);
        composer.compose(eyes);
        EXPECT_EQ(pictureOf(*composer.shown(eyes).at(0).picture), pictures::packStereo(stereo, right_, left_))
            << walls::stereoName(stereo);
        EXPECT_EQ(pictureOf(eyes[0]), left_);
    }
}

}  // namespace
