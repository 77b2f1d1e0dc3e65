// SPDX-License-Identifier: Apache-2.0
// Properties that make sand look like sand, measured in pictures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>

#include "render_node/gl/gl_context.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/pictures/sample_scene.hpp"
#include "tests/support/pictures/sample_tin.hpp"
#include "walls/projection.hpp"

namespace {

using render_node::EyeTarget;
using render_node::ScenePainter;
using sample::layersOf;
using sample::Pixels;

constexpr int kLookWidth = 400, kLookHeight = 300;

double luminance(const glm::ivec3& colour) { return 0.2126 * colour.r + 0.7152 * colour.g + 0.0722 * colour.b; }

double at(const Pixels& pixels, int x, int y) { return luminance(sample::pixel(pixels, kLookWidth, x, y)); }

double mean(const Pixels& pixels, int x0, int y0, int x1, int y1) {
    double sum = 0;
    for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; ++x) {
            sum += at(pixels, x, y);
        }
    }
    return sum / ((x1 - x0) * (y1 - y0));
}

/// Returns the root mean square difference of neighbouring pixels in some rows.
double roughness(const Pixels& pixels, int y0, int y1) {
    double sum = 0;
    for (int y = y0; y < y1; ++y) {
        for (int x = 1; x < kLookWidth; ++x) {
            sum += std::pow(at(pixels, x, y) - at(pixels, x - 1, y), 2);
        }
    }
    return std::sqrt(sum / ((kLookWidth - 1) * (y1 - y0)));
}

/// Returns the largest difference of two levels at the same place.
int mostDifference(const Pixels& a, const Pixels& b) {
    int most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        most = std::max(most, std::abs(int{a[i]} - int{b[i]}));
    }
    return most;
}

/// Returns a plane that rises to the east (slope 1 is 45 degrees), with the given seed in its rows.
scene::Scene slopeScene(double east, double north) {
    scene::Scene scene = sample::flatScene(128, 128);
    for (int row = 0; row < 128; ++row) {
        for (int column = 0; column < 128; ++column) {
            const double height = (column - 64) * east + (row - 64) * north;
            scene.terrain.setHeight(column, row, static_cast<std::int32_t>(height * sand::kUnitsPerCell));
        }
    }
    return scene;
}

class Look : public testing::Test {
protected:
    std::unique_ptr<render_node::GlContext> context_ =
        render_node::makeOffscreenContext(render_node::Backend::automatic);
    EyeTarget target_{kLookWidth, kLookHeight};
    render_node::Camera above_ = sample::camera({1, 1, 1.5}, {1, 1, 0});
};

// Sand in the plane of a screen is drawn on the same pixels wherever the head is. So its grains must be too.
TEST_F(Look, GrainStaysOnItsSandWhenTheHeadMoves) {
    ScenePainter view(sample::flatScene(128, 128), glm::dmat4(1));
    const walls::Screen screen{{0.75, 0.8, 0}, {1.25, 0.8, 0}, {0.75, 1.175, 0}};
    Pixels first;
    for (const glm::dvec3 eye : {glm::dvec3(1, 1, 0.8), {1.3, 0.7, 0.6}, {0.55, 1.3, 1.1}}) {
        const Pixels seen = sample::draw(view, {walls::viewOf(screen, eye, 0.05, 10).viewProjection, eye}, target_);
        EXPECT_GT(roughness(seen, 0, kLookHeight), 4) << "no grains to see";
        first = first.empty() ? seen : first;
        EXPECT_LE(mostDifference(seen, first), 3) << "from " << eye.x << ", " << eye.y << ", " << eye.z;
    }
}

// The camera moves away as the sand grows, so that each place of the sand stays on its pixel. So its grains must too.
// The grain changes between 2 and 3 notches of the wheel, and again after an octave.
TEST_F(Look, GrainStaysOnItsSandWhileTheViewIsZoomedWithinAnOctave) {
    ScenePainter view(sample::flatScene(128, 128), glm::dmat4(1));
    const auto zoomed = [&](double notches) {
        const double by = std::exp2(notches / 4);
        view.setSceneToRoom(glm::scale(glm::dmat4(1), glm::dvec3(by)));
        return sample::draw(view, {above_.roomToClip * glm::scale(glm::dmat4(1), glm::dvec3(1 / by)), above_.eye * by},
                            target_);
    };
    Pixels before = zoomed(-1);
    for (const double notches : {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0}) {
        const Pixels now = zoomed(notches);
        EXPECT_EQ(mostDifference(now, before) > 3, notches == 3 || notches == 7) << notches;
        before = now;
    }
}

// Grains of a large zoom are as large on the wall as those of the usual view.
TEST_F(Look, GrainIsNotMagnifiedByALargeZoom) {
    ScenePainter view(sample::flatScene(128, 128), glm::dmat4(1));
    const double usual = roughness(sample::draw(view, above_, target_), 0, kLookHeight);
    view.setSceneToRoom(glm::translate(glm::scale(glm::dmat4(1), glm::dvec3(8)), glm::dvec3(-0.875, -0.875, 0)));
    EXPECT_NEAR(roughness(sample::draw(view, above_, target_), 0, kLookHeight), usual, 0.1 * usual);
}

// Far sand must look like the average of a finer picture: a single grain must not replace its neighbours.
TEST_F(Look, GrainFadesWithTheDistanceWithoutAliasing) {
    constexpr int kFiner = 6;
    ScenePainter view(sample::flatScene(256, 256), glm::dmat4(1));
    const render_node::Camera along = sample::camera({1, -0.2, 0.35}, {1, 0.8, 0});
    const Pixels seen = sample::draw(view, along, target_);
    const Pixels fine = sample::draw(view, along, EyeTarget(kFiner * kLookWidth, kFiner * kLookHeight));
    Pixels averaged;
    for (int y = 0; y < kLookHeight; ++y) {
        for (int x = 0; x < kLookWidth; ++x) {
            glm::ivec3 sum(0);
            for (int i = 0; i < kFiner * kFiner; ++i) {
                sum += sample::pixel(fine, kFiner * kLookWidth, kFiner * x + i % kFiner, kFiner * y + i / kFiner);
            }
            for (int channel = 0; channel < 3; ++channel) {
                averaged.push_back(static_cast<std::uint8_t>(sum[channel] / (kFiner * kFiner)));
            }
        }
    }
    // Rows from far sand, away from the box's far end, to near sand.
    double before = 0;
    for (const int row : {110, 150, 190, 270}) {
        const double rough = roughness(seen, row, row + 20);
        std::printf("rows from %d: neighbours differ by %.2f, by %.2f in truth\n", row, rough,
                    roughness(averaged, row, row + 20));
        EXPECT_LT(rough, roughness(averaged, row, row + 20) + 0.7) << "row " << row;
        EXPECT_GT(rough, before) << "row " << row;
        before = rough;
    }
    EXPECT_GT(before, 3);
}

TEST_F(Look, SlidSandIsDarkerAndWarmerThanLevelSand) {
    const auto colourOf = [&](double slope) {
        // The sun is on the axis of slopes that rise to the north, so that both slopes get the same share of it.
        scene::Scene scene = slopeScene(0, slope);
        scene.look.sunDirection = {0, std::sin(0.5 * std::atan(-slope)), std::cos(0.5 * std::atan(slope))};
        ScenePainter view(scene, glm::dmat4(1));
        const Pixels pixels = sample::draw(view, above_, target_);
        glm::dvec3 sum(0);
        for (int y = 140; y < 160; ++y) {
            for (int x = 100; x < 300; ++x) {
                sum += glm::dvec3(sample::pixel(pixels, kLookWidth, x, y));
            }
        }
        return sum / 4000.0;
    };
    const glm::dvec3 level = colourOf(0), slid = colourOf(std::tan(glm::radians(34.0)));
    std::printf("level %.0f %.0f %.0f, slid %.0f %.0f %.0f\n", level.r, level.g, level.b, slid.r, slid.g, slid.b);
    EXPECT_LT(slid.g, level.g - 4);
    EXPECT_GT(slid.g, 0.8 * level.g) << "too dark for slid sand";
    EXPECT_GT(slid.r / slid.b, 1.05 * level.r / level.b);
}

/// Returns the mean colour of level sand in linear light, at a humidity. The camera is in the middle above it.
glm::dvec3 levelSand(double humidity, const render_node::Camera& camera, const EyeTarget& target, bool tin) {
    const scene::Scene scene = sample::flatScene(128, 128);
    const sample::Tin triangles(scene.terrain);
    ScenePainter view =
        tin ? ScenePainter(scene, sand::TinData{triangles.view()}, glm::dmat4(1)) : ScenePainter(scene, glm::dmat4(1));
    view.setHumidity(humidity);
    const Pixels pixels = sample::draw(view, camera, target);
    glm::dvec3 sum(0);
    for (int y = 130; y < 170; ++y) {
        for (int x = 150; x < 250; ++x) {
            const glm::dvec3 level = glm::dvec3(sample::pixel(pixels, kLookWidth, x, y)) / 255.0;
            sum += glm::pow((level + 0.055) / 1.055, glm::dvec3(2.4));  // all levels are above the linear part of sRGB
        }
    }
    return sum / 4000.0;
}

// Real wet sand reflects about half as much light as dry sand, and its colour is more saturated.
TEST_F(Look, WetSandIsDarkerAndMoreSaturatedTheWetterItIs) {
    for (const bool tin : {false, true}) {
        const glm::dvec3 dry = levelSand(0, above_, target_, tin);
        glm::dvec3 before = dry;
        for (const double humidity : {0.1, 0.2, 0.5, 1.0}) {
            const glm::dvec3 wet = levelSand(humidity, above_, target_, tin);
            std::printf("humidity %.1f: %.3f %.3f %.3f\n", humidity, wet.r, wet.g, wet.b);
            EXPECT_LT(wet.g, before.g - 0.01) << "humidity " << humidity;
            EXPECT_GT(wet.r / wet.b, before.r / before.b + 0.01) << "humidity " << humidity;
            before = wet;
        }
        EXPECT_NEAR(before.g / dry.g, 0.55, 0.1);
    }
}

// The sun is 30 degrees above the south. Its mirror image in level sand is seen from the north at 30 degrees. Dry sand
// has the same colour from both sides.
TEST_F(Look, WetSandReflectsTheSunTowardsTheEye) {
    scene::Scene scene = sample::flatScene(128, 128);
    scene.look.sunDirection = {0, -std::cos(glm::radians(30.0)), 0.5};
    ScenePainter view(scene, glm::dmat4(1));
    const auto brightness = [&](double north) {
        const auto camera = sample::camera({1, 1 + north * std::cos(glm::radians(30.0)), 0.5}, {1, 1, 0});
        return mean(sample::draw(view, camera, target_), 150, 140, 250, 160);
    };
    EXPECT_NEAR(brightness(1), brightness(-1), 1);
    view.setHumidity(1);
    EXPECT_GT(brightness(1), brightness(-1) + 10);
}

TEST_F(Look, SandThatHasDriedIsDrawnAsIfItHadNeverBeenWet) {
    const scene::Scene scene = sample::duneScene(100);
    ScenePainter never(scene, glm::dmat4(1)), dried(scene, glm::dmat4(1));
    const Pixels want = sample::draw(never, above_, target_);
    dried.setHumidity(0.7);
    EXPECT_NE(sample::draw(dried, above_, target_), want);
    dried.setHumidity(0);
    EXPECT_EQ(sample::draw(dried, above_, target_), want);
}

/// Darkening of the ground under the tool.
struct Shadow {
    double darkest = 0;
    // Number of darkened pixels, divided by the number of pixels with at least half of the largest darkening.
    double softness = 0;
};

TEST_F(Look, ToolsShadowIsDarkerAndTighterTheCloserItComes) {
    scene::Scene scene = sample::flatScene(256, 256, 0.05);
    scene.look.sunDirection = {0, 0, 1};
    ScenePainter view(scene, glm::dmat4(1));
    // Seen from the side, so that the ball does not hide the ground that it shades. The ball is in the upper half of
    // the picture.
    const auto beside = sample::camera({1, 0.2, 0.6}, {1, 1, 0});
    const Pixels ground = sample::draw(view, beside, target_);
    const auto shadowFrom = [&](double height /* [radius] */) {
        view.setTool(sample::probeAt(scene, {1, 1, 0.05 * height}), false);
        const Pixels seen = sample::draw(view, beside, target_);
        std::vector<double> darker;
        for (int y = kLookHeight / 2; y < kLookHeight; ++y) {
            for (int x = 0; x < kLookWidth; ++x) {
                darker.push_back(at(ground, x, y) - at(seen, x, y));
            }
        }
        const double darkest = *std::ranges::max_element(darker);
        const auto beyond = [&](double share) {
            return static_cast<double>(std::ranges::count_if(darker, [&](double d) { return d > share * darkest; }));
        };
        const Shadow shadow{darkest, beyond(0.1) / beyond(0.5)};
        std::printf("%4.1f radii high: darker by %.0f, softness %.2f\n", height, shadow.darkest, shadow.softness);
        return shadow;
    };
    Shadow lower = shadowFrom(1.2);
    EXPECT_GT(lower.darkest, 130);
    lower.softness = 0;  // at contact, the ball takes more skylight than the shadow's edge takes sunlight
    for (const double height : {2.5, 5.0, 10.0}) {
        const Shadow shadow = shadowFrom(height);
        EXPECT_LT(shadow.darkest, lower.darkest - 5);
        EXPECT_GT(shadow.softness, lower.softness);
        lower = shadow;
    }
    view.setTool(sample::probeAt(scene, {1, 1, 0.05 * 31}), false);  // above the visible part
    EXPECT_TRUE(sample::draw(view, beside, target_) == ground) << "a shadow from 31 radii";
}

TEST_F(Look, HillShadeIsLitFromTheNorthWestWhateverTheSun) {
    const auto shadeOf = [&](double east, double north, const std::vector<double>& sun) {
        scene::Scene scene = slopeScene(east, north);
        scene.look.sunDirection = sun;
        ScenePainter view(scene, glm::dmat4(1));
        view.setLayers(layersOf({lockstep::Overlay::hillShade}));
        return mean(sample::draw(view, above_, target_), 180, 130, 220, 170);
    };
    const std::vector<double> morning{0.6, 0, 0.8};
    const double level = shadeOf(0, 0, morning);
    EXPECT_GT(shadeOf(0.4, -0.4, morning), level + 10) << "falls to the north-west";
    EXPECT_LT(shadeOf(-0.4, 0.4, morning), level - 40) << "falls to the south-east";
    EXPECT_EQ(shadeOf(0.4, -0.4, morning), shadeOf(0.4, -0.4, {-0.6, 0, 0.8}));
    EXPECT_NEAR(shadeOf(0.4, 0.4, morning), shadeOf(-0.4, -0.4, morning), 1) << "across the light";
}

TEST_F(Look, WireframeDrawsEveryEdgeAndLeavesTheFacesAlone) {
    ScenePainter view(sample::flatScene(32, 32), glm::dmat4(1));
    const Pixels without = sample::draw(view, above_, target_);
    view.setLayers(layersOf({lockstep::Overlay::wireframe}));
    const Pixels with = sample::draw(view, above_, target_);
    // A pixel spans 3.75 mm, a cell 62.5 mm. Vertices are over the middles of cells. Cells (15, 15) and (16, 16) are
    // half a cell from the middle of the picture.
    const auto pixelAt = [](double x, double y) {
        return glm::ivec2(200 + static_cast<int>(std::floor((x - 1) / 0.00375)),
                          150 - static_cast<int>(std::ceil((y - 1) / 0.00375)));
    };
    const auto darkening = [&](double x, double y) {
        double most = 0;
        for (int i = 0; i < 9; ++i) {  // an edge may run along the border of two pixels
            const glm::ivec2 p = pixelAt(x, y) + glm::ivec2(i % 3 - 1, i / 3 - 1);
            most = std::max(most, at(without, p.x, p.y) - at(with, p.x, p.y));
        }
        return most;
    };
    constexpr double kCell = sample::kWidth / 32;
    for (int column = 10; column < 20; ++column) {
        for (int row = 11; row < 19; ++row) {
            const glm::dvec2 vertex((column + 0.5) * kCell, (row + 0.5) * kCell);
            EXPECT_GT(darkening(vertex.x + 0.3 * kCell, vertex.y), 40) << column << ", " << row;
            EXPECT_GT(darkening(vertex.x, vertex.y + 0.3 * kCell), 40) << column << ", " << row;
            EXPECT_GT(darkening(vertex.x + 0.5 * kCell, vertex.y + 0.5 * kCell), 40) << "diagonals meet the middle";
            const glm::ivec2 face = pixelAt(vertex.x + 0.5 * kCell, vertex.y + 0.22 * kCell);
            EXPECT_EQ(at(with, face.x, face.y), at(without, face.x, face.y)) << column << ", " << row;
        }
    }
}

TEST_F(Look, LayersThatAreOffLeaveNoTrace) {
    scene::Scene scene = sample::duneScene(64);
    ScenePainter view(scene, glm::dmat4(1));
    const Pixels before = sample::draw(view, above_, target_);
    view.setLayers(layersOf({lockstep::Overlay::wireframe, lockstep::Overlay::hillShade}));
    view.setForce(render_node::ForceArrow{{1, 1, 0.1}, {1, 1, 0.3}, false});
    EXPECT_FALSE(sample::draw(view, above_, target_) == before);
    view.setLayers({});
    view.setForce(std::nullopt);
    EXPECT_TRUE(sample::draw(view, above_, target_) == before);
}

}  // namespace
