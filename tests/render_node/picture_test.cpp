// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <memory>
#include <string>

#include "render_node/gl/gl_context.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/pictures/sample_scene.hpp"

namespace {

using render_node::EyeTarget;
using render_node::ScenePainter;
using sample::Pixels;

constexpr int kWidth = 400;
constexpr int kHeight = 300;

/// Returns the hash that picture_hash prints with `threads` threads of llvmpipe.
std::string hashWithThreads(int threads) {
    const std::string command =
        "LP_NUM_THREADS=" + std::to_string(threads) + " '" SANDWALL_BIN_DIR "/picture_hash' 2>&1";
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
    std::array<char, 256> line{};
    return pipe != nullptr && std::fgets(line.data(), line.size(), pipe.get()) != nullptr ? line.data() : "";
}

double meanLuminance(const Pixels& pixels, int x0, int y0, int x1, int y1) {
    double sum = 0;
    for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; ++x) {
            const glm::ivec3 colour = sample::pixel(pixels, kWidth, x, y);
            sum += 0.2126 * colour.r + 0.7152 * colour.g + 0.0722 * colour.b;
        }
    }
    return sum / ((x1 - x0) * (y1 - y0));
}

class Picture : public testing::Test {
protected:
    std::unique_ptr<render_node::GlContext> context_ =
        render_node::makeOffscreenContext(render_node::Backend::automatic);
    EyeTarget target_{kWidth, kHeight};
    render_node::Camera above_ = sample::camera({1, 1, 1.5}, {1, 1, 0});
};

TEST_F(Picture, NamesItsRenderer) {
    EXPECT_EQ(context_->name(), base::nameOf(render_node::kInMemory));
    EXPECT_NE(context_->renderer().find("OpenGL"), std::string::npos) << context_->renderer();
}

TEST_F(Picture, OfASandBedIsFullOfSandColouredGrains) {
    ScenePainter view(sample::flatScene(128, 128), glm::dmat4(1));
    const Pixels pixels = sample::draw(view, above_, target_);
    int sandy = 0;
    int darkest = 255;
    int brightest = 0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const glm::ivec3 colour = sample::pixel(pixels, kWidth, x, y);
            // The hue is between red and yellow, bright but not too saturated.
            sandy += colour.r > colour.g && colour.g > colour.b && colour.r > 150 && colour.b > 80 ? 1 : 0;
            darkest = std::min(darkest, colour.r);
            brightest = std::max(brightest, colour.r);
        }
    }
    EXPECT_GT(sandy, 0.98 * kWidth * kHeight);
    EXPECT_GT(brightest - darkest, 12) << "no grains to see";
}

TEST_F(Picture, OfAFurrowHasASunnyAndAShadyBank) {
    const scene::Scene scene = sample::flatScene(256, 256);
    sand::Replica replica(scene);
    ScenePainter view(scene, glm::dmat4(1));
    // The furrow runs north-south through the middle. The sun is in the west, so that the eastern slope faces it.
    sample::drag(replica, scene, {1, 0.5, 0.01}, {1, 1.5, 0.01});
    view.update(replica.surface().data(), replica.takeChange());
    const Pixels pixels = sample::draw(view, above_, target_);
    // 1.5 m over 400 pixels: 3.75 mm per pixel. The furrow is some 5 cm wide on either side of column 200.
    const double west = meanLuminance(pixels, 193, 130, 198, 170);
    const double east = meanLuminance(pixels, 202, 130, 207, 170);
    const double level = meanLuminance(pixels, 60, 130, 100, 170);
    EXPECT_GT(east, level + 5);
    EXPECT_LT(west, level - 25);
}

TEST_F(Picture, OfTheChangeAloneEqualsThatOfEverything) {
    const scene::Scene scene = sample::duneScene(150);
    sand::Replica replica(scene);
    ScenePainter partial(scene, glm::dmat4(1));
    (void)replica.takeChange();
    const auto camera = sample::camera({1, -0.4, 1.1}, {1, 0.9, 0});
    const Pixels before = sample::draw(partial, camera, target_);
    for (const double x : {0.02, 0.5, 1.3}) {  // the first touches the rim
        sample::drag(replica, scene, {x, 0.4, 0.03}, {x + 0.3, 1.2, 0.02});
        partial.update(replica.surface().data(), replica.takeChange());
        ScenePainter whole(scene, glm::dmat4(1));
        whole.update(replica.surface().data(), {});
        const Pixels got = sample::draw(partial, camera, target_);
        EXPECT_TRUE(got == sample::draw(whole, camera, target_)) << "after the furrow at " << x;
        EXPECT_FALSE(got == before);
    }
}

TEST_F(Picture, KeepsNoTraceOfTheOneBefore) {
    ScenePainter view(sample::duneScene(100), glm::dmat4(1));
    const Pixels first = sample::draw(view, above_, target_);
    sample::draw(view, sample::camera({0.3, -1, 0.4}, {1, 1, 0}), target_);
    EXPECT_TRUE(sample::draw(view, above_, target_) == first);
}

TEST_F(Picture, ShowsTheToolTrueToSize) {
    const scene::Scene scene = sample::flatScene(128, 128, 0.05);
    ScenePainter view(scene, glm::dmat4(1));
    view.setTool(sample::probeAt(scene, {1, 1, 0.5}), true);
    const Pixels with = sample::draw(view, above_, target_);
    int red = 0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const glm::ivec3 colour = sample::pixel(with, kWidth, x, y);
            red += colour.r > 2 * colour.g && colour.r > 60 ? 1 : 0;
        }
    }
    // Seen from 1 m, with 400 pixels per metre there: a disc of 20 pixels radius, with tangents r/√(d² − r²).
    const double radius = 0.05 / std::sqrt(1 - 0.05 * 0.05) * 400;
    EXPECT_NEAR(red, 3.14159 * radius * radius, 0.12 * 3.14159 * radius * radius);
}

/// Returns the middle of the pixels that are darker in `with` than in `without`, weighted by the difference [pixel].
/// Ignores the red pixels of the ball itself.
glm::dvec2 middleOfShadow(const Pixels& without, const Pixels& with) {
    glm::dvec2 sum(0);
    double weight = 0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const glm::ivec3 seen = sample::pixel(with, kWidth, x, y);
            const int darker = sample::pixel(without, kWidth, x, y).g - seen.g;
            if (darker > 0 && seen.r < 2 * seen.g) {
                sum += double(darker) * glm::dvec2(x + 0.5, y + 0.5);
                weight += darker;
            }
        }
    }
    EXPECT_GT(weight, 10'000) << "no shadow";
    return sum / weight;
}

TEST_F(Picture, ToolsShadowFallsAwayFromTheSun) {
    // [m]: height of the ball above the sand; size of a pixel on the sand.
    constexpr double kHigh = 0.3, kPixel = 1.5 / kWidth;
    for (const glm::dvec3 sun : {glm::dvec3(-0.55, 0.35, 0.6), {0.5, 0.3, 0.8}, {0.1, -0.6, 0.8}, {-0.5, -0.4, 0.8}}) {
        scene::Scene scene = sample::flatScene(128, 128, 0.05);
        scene.look.sunDirection = {sun.x, sun.y, sun.z};
        ScenePainter view(scene, glm::dmat4(1));
        const Pixels without = sample::draw(view, above_, target_);
        view.setTool(sample::probeAt(scene, {1, 1, kHigh}), true);
        // The line from the sun through the ball's middle meets the level sand here. North is up in the picture.
        const glm::dvec2 away = glm::dvec2(sun) * (-kHigh / sun.z / kPixel);
        const glm::dvec2 expected(kWidth / 2.0 + away.x, kHeight / 2.0 - away.y);
        const glm::dvec2 middle = middleOfShadow(without, sample::draw(view, above_, target_));
        // The far half of the shadow is paler (docs/look.md): by an eighth at half of its length, 21 pixels. That moves
        // its middle nearer by a quarter of their product, 0.7 pixels.
        EXPECT_LT(glm::distance(middle, expected), 1)
            << middle.x << ", " << middle.y << " instead of " << expected.x << ", " << expected.y;
    }
}

TEST_F(Picture, OfEveryFieldSizeIsDrawn) {
    for (const auto& [columns, rows] : {std::pair{1, 1}, {2, 1}, {1, 40}, {31, 33}, {63, 64}, {80, 122}, {100, 7}}) {
        ScenePainter view(sample::flatScene(columns, rows), glm::dmat4(1));
        const auto middle = glm::dvec3(1, sample::kWidth * rows / columns / 2, 0);
        const Pixels pixels = sample::draw(view, sample::camera(middle + glm::dvec3(0, 0, 1.5), middle), target_);
        const glm::ivec3 centre = sample::pixel(pixels, kWidth, kWidth / 2, kHeight / 2);
        EXPECT_GT(centre.r, centre.b + 20) << columns << " x " << rows;
        EXPECT_GT(view.counts().chunks, 0);
    }
}

TEST_F(Picture, IsTheSameForEveryNumberOfThreads) {
    const std::string one = hashWithThreads(0);
    ASSERT_EQ(one.size(), 17U) << one;
    EXPECT_EQ(hashWithThreads(1), one);
    EXPECT_EQ(hashWithThreads(2), one);
}

TEST_F(Picture, RefusesImpossibleSizes) {
    EXPECT_THROW(EyeTarget(0, 10), std::runtime_error);
    EXPECT_THROW(EyeTarget(1 << 20, 10), std::runtime_error);
}

TEST_F(Picture, NamesTheShaderThatDoesNotCompile) {
    const auto& vertex = render_node::shaderSource("solid.vert.glsl");
    const auto& light = render_node::shaderSource("light.glsl");
    try {
        const render_node::GlProgram program(vertex, light, {"broken.frag.glsl", "void main() { nonsense = 1.0; }"});
        FAIL() << "it compiled";
    } catch (const std::runtime_error& error) {
        const std::string line = error.what();
        EXPECT_EQ(line.rfind("render_node/shaders/broken.frag.glsl: ", 0), 0U) << line;
        EXPECT_NE(line.find("nonsense"), std::string::npos) << line;
        EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    }
}

}  // namespace
