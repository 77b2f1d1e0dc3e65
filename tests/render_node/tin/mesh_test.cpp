// SPDX-License-Identifier: Apache-2.0
// Look of a TIN: like the grid, flat or smooth, with its wires and constraints.
#include <gtest/gtest.h>

#include <cstdio>
#include <memory>
#include <set>
#include <string>

#include "render_node/gl/gl_context.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/pictures/sample_tin.hpp"

namespace {

using lockstep::Overlay;
using render_node::EyeTarget;
using render_node::ScenePainter;
using sample::layersOf;
using sample::Pixels;
using sample::Tin;

constexpr int kPictureWidth = 400, kPictureHeight = 300;

/// Shader sources that GL was asked to compile.
class CompiledShaders {
public:
    CompiledShaders() {
        all_.clear();
        original_ = glad_glShaderSource;
        glad_glShaderSource = [](GLuint shader, GLsizei count, const GLchar* const* text, const GLint* length) {
            all_ += *text;
            original_(shader, count, text, length);
        };
    }
    CompiledShaders(const CompiledShaders&) = delete;
    CompiledShaders& operator=(const CompiledShaders&) = delete;
    ~CompiledShaders() { glad_glShaderSource = original_; }
    [[nodiscard]] static bool with(std::string_view file) {
        return all_.find(render_node::shaderSource(file).text) != std::string::npos;
    }

private:
    static inline std::string all_;
    static inline PFNGLSHADERSOURCEPROC original_ = nullptr;
};

struct Unlike {
    int most = 0;      // largest difference of a channel
    double mean = 0;   // mean difference of all channels
    double share = 0;  // share of channels that differ by more than 8
};

Unlike compare(const Pixels& a, const Pixels& b) {
    Unlike found;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const int apart = std::abs(int{a[i]} - int{b[i]});
        found.most = std::max(found.most, apart);
        found.mean += apart;
        found.share += apart > 8 ? 1 : 0;
    }
    found.mean /= static_cast<double>(a.size());
    found.share /= static_cast<double>(a.size());
    return found;
}

class TinLook : public testing::Test {
protected:
    std::unique_ptr<render_node::GlContext> context_ =
        render_node::makeOffscreenContext(render_node::Backend::automatic);
    EyeTarget target_{kPictureWidth, kPictureHeight};
    render_node::Camera above_ = sample::camera({1, 1, 1.5}, {1, 1, 0});
    render_node::Camera slanted_ = sample::camera({1, -0.9, 1.3}, {1, 0.9, 0});
};

// The vertices are equal. The pictures differ by the normals, which come from the triangles around a vertex instead of
// the neighbouring cells.
TEST_F(TinLook, OfAGridsSurfaceIsThatOfTheGrid) {
    scene::Scene scene = sample::duneScene(128);
    scene.look.detail = 0;
    const Tin tin(scene.terrain);
    ScenePainter grid(scene, glm::dmat4(1)), view(scene, sand::TinData{tin.view()}, glm::dmat4(1));
    for (const bool map : {false, true}) {
        for (ScenePainter* one : {&grid, &view}) {
            one->setTool(sample::probeAt(scene, {0.8, 0.7, 0.1}), false);
            one->setLayers(map ? layersOf({Overlay::hillShade}) : layersOf({}));
        }
        const Unlike apart = compare(sample::draw(grid, slanted_, target_), sample::draw(view, slanted_, target_));
        std::printf("hill-shade %d: at most %d, %.3f in the mean, %.4f %% by more than 8\n", map, apart.most,
                    apart.mean, 100 * apart.share);
        EXPECT_LT(apart.mean, 0.3);
        EXPECT_LT(apart.share, 0.002);
        EXPECT_GT(compare(sample::draw(grid, above_, target_), sample::draw(view, slanted_, target_)).mean, 10);
    }
}

// Few large triangles under the sun of a map, without grain that would hide them.
TEST_F(TinLook, IsFlatOrSmoothAsTheSceneSays) {
    scene::Scene scene = sample::flatScene(6, 6);
    for (int i = 0; i < 36; ++i) {
        scene.terrain.setHeight(i % 6, i / 6, (3 - std::abs(i % 6 - 2)) * sand::kUnitsPerCell / 4);
    }
    const Tin tin(scene.terrain);
    const auto shades = [&](bool flat) {
        scene.look.flatShading = flat;
        ScenePainter view(scene, sand::TinData{tin.view()}, glm::dmat4(1));
        view.setLayers(layersOf({Overlay::hillShade}));
        const Pixels seen = sample::draw(view, above_, target_);
        std::set<int> found;
        for (int y = 75; y < 225; ++y) {
            for (int x = 100; x < 300; ++x) {
                const glm::ivec3 colour = sample::pixel(seen, kPictureWidth, x, y);
                found.insert(colour.r * 65536 + colour.g * 256 + colour.b);
            }
        }
        return found.size();
    };
    const std::size_t facets = shades(true), smooth = shades(false);
    std::printf("%zu shades in facets, %zu smooth\n", facets, smooth);
    EXPECT_GE(facets, 2U);
    EXPECT_LE(facets, tin.mesh().triangles.size());
    EXPECT_GT(smooth, 10 * facets);
}

int apart(const glm::ivec3& a, const glm::ivec3& b) {
    return std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b);
}

// The holes are a corner of the field and a place inside it, each some triangles wide.
TEST_F(TinLook, LeavesHolesOpenWhicheverSlotsTheirTrianglesHave) {
    scene::Scene scene = sample::duneScene(32);
    scene.look.detail = 0;
    const auto isHole = [](double x, double y) {
        return std::max(std::abs(x - 16 * 256), std::abs(y - 16 * 256)) < 2.5 * 256 || x + y < 6 * 256;
    };
    Tin tin(scene.terrain), other(scene.terrain);
    tin.cut(isHole);
    other.cut(isHole);
    std::mt19937 random(5);
    other.shuffle(random);
    ScenePainter whole(scene, sand::TinData{Tin(scene.terrain).view()}, glm::dmat4(1));
    ScenePainter view(scene, sand::TinData{tin.view()}, glm::dmat4(1)),
        again(scene, sand::TinData{other.view()}, glm::dmat4(1));
    for (ScenePainter* one : {&whole, &view, &again}) {
        one->setLayers(layersOf({Overlay::hillShade}));
    }
    const Pixels open = sample::draw(view, above_, target_), closed = sample::draw(whole, above_, target_);
    const auto colour = [](const Pixels& seen, int x, int y) { return sample::pixel(seen, kPictureWidth, x, y); };
    const glm::ivec3 wood = colour(open, 200, 150);
    EXPECT_GT(wood.r, wood.b + 40) << "the bottom of the box is seen in the middle of the hole";
    EXPECT_GT(apart(wood, colour(closed, 200, 150)), 100) << "without the hole there is sand";
    EXPECT_EQ(colour(open, 100, 150), colour(closed, 100, 150)) << "the sand beside the hole stays as it was";
    EXPECT_EQ(sample::draw(again, above_, target_), open);
    EXPECT_EQ(sample::draw(again, slanted_, target_), sample::draw(view, slanted_, target_));
}

TEST_F(TinLook, MarksConstraintsInTheWireframeAlone) {
    scene::Scene scene = sample::flatScene(16, 16);
    Tin tin(scene.terrain);
    // The edge leads from the middle of cell (7, 7) to the middle of cell (8, 7), south of the picture's middle.
    const glm::dvec2 middle(1, 0.9375);
    const auto reddest = [&](const Pixels& seen) {
        int most = -255;
        for (int i = -2; i <= 2; ++i) {
            const glm::ivec3 at = sample::pixel(seen, kPictureWidth, 200 + static_cast<int>((middle.x - 1) / 0.00375),
                                                150 - static_cast<int>((middle.y - 1) / 0.00375) + i);
            most = std::max(most, at.r - 2 * at.g);
        }
        return most;
    };
    ScenePainter view(scene, sand::TinData{tin.view()}, glm::dmat4(1));
    const Pixels without = sample::draw(view, above_, target_);
    view.setLayers(layersOf({Overlay::wireframe}));
    const Pixels wires = sample::draw(view, above_, target_);
    EXPECT_LT(reddest(wires), 0) << "ink is brown";
    const auto& places = tin.mesh().places;
    const auto at = [&](sand::tin::Vertex vertex, int x, int y) {
        return places[static_cast<std::size_t>(vertex)] == sand::tin::LatticePoint{x * 256 + 128, y * 256 + 128};
    };
    const auto constrain = [&](bool on) {
        for (std::int32_t slot = 0; slot < static_cast<std::int32_t>(tin.mesh().triangles.size()); ++slot) {
            const auto corner = tin.mesh().triangles[static_cast<std::size_t>(slot)].corner;
            for (std::size_t edge = 0; edge < 3; ++edge) {
                if (at(corner[(edge + 1) % 3], 7, 7) && at(corner[(edge + 2) % 3], 8, 7)) {
                    tin.constrain(slot, edge, on);
                }
            }
        }
        view.update(sand::TinData{tin.view()}, tin.takeChange());
    };
    constrain(true);
    EXPECT_GT(reddest(sample::draw(view, above_, target_)), 60);
    constrain(false);
    EXPECT_TRUE(sample::draw(view, above_, target_) == wires) << "released";
    constrain(true);
    view.setLayers({});
    EXPECT_TRUE(sample::draw(view, above_, target_) == without) << "no wires, no marks";
}

TEST_F(TinLook, LeavesItsShadersOutWhereNothingAsksForThem) {
    scene::Scene scene = sample::duneScene(32);
    const Tin tin(scene.terrain);
    {
        const CompiledShaders compiled;
        ScenePainter grid(scene, glm::dmat4(1));
        grid.setLayers(layersOf({Overlay::wireframe, Overlay::hillShade}));
        (void)sample::draw(grid, above_, target_);
        EXPECT_TRUE(CompiledShaders::with("wire.geom.glsl"));
        for (const auto* file : {"facet.vert.glsl", "facet.geom.glsl", "mark.geom.glsl", "mark.frag.glsl"}) {
            EXPECT_FALSE(CompiledShaders::with(file)) << file;
        }
    }
    const CompiledShaders compiled;
    ScenePainter view(scene, sand::TinData{tin.view()}, glm::dmat4(1));
    (void)sample::draw(view, above_, target_);
    EXPECT_FALSE(CompiledShaders::with("mark.frag.glsl"));
    view.setLayers(layersOf({Overlay::wireframe}));
    (void)sample::draw(view, above_, target_);
    EXPECT_TRUE(CompiledShaders::with("mark.frag.glsl"));
    EXPECT_FALSE(CompiledShaders::with("facet.geom.glsl"));
}

}  // namespace
