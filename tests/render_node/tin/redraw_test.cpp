// SPDX-License-Identifier: Apache-2.0
// A changing TIN, drawn in parts and whole. Every frame must be equal in every byte, and only few bytes are sent to GL.
#include <gtest/gtest.h>

#include <cstdio>
#include <memory>

#include "render_node/gl/gl_context.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/pictures/sample_tin.hpp"

namespace {

using lockstep::Overlay;
using render_node::EyeTarget;
using render_node::PixelRect;
using render_node::ScenePainter;
using sample::Tin;

constexpr int kRedrawWidth = 200, kRedrawHeight = 150, kCells = 64;
constexpr double kUnit = sand::kUnitsPerCell;

/// Makes a random edit of a TIN. Vertices rise, sink, appear and are removed; edges turn; constraints are set and
/// released.
void edit(Tin& tin, std::mt19937& random, std::vector<Tin::Vertex>& added) {
    const auto any = [&](std::size_t count) { return static_cast<std::int32_t>(random() % count); };
    const auto slot = [&] {
        std::int32_t found = 0;
        do {
            found = any(tin.mesh().triangles.size());
        } while (!tin.mesh().triangles[static_cast<std::size_t>(found)].alive());
        return found;
    };
    const std::size_t edge = random() % 3;
    switch (random() % 6) {
        case 0: {  // a heap near a random vertex, which may be on the rim
            const Tin::Vertex first = any(kCells * kCells);
            for (int i = 0; i < 3; ++i) {
                tin.setHeight(first + i, tin.height(first + i) + kUnit * (static_cast<double>(any(600)) - 300) / 100);
            }
            break;
        }
        case 1: {
            const Tin::Vertex vertex = any(tin.mesh().places.size());
            if (tin.mesh().alive(vertex)) {
                tin.setHeight(vertex, tin.height(vertex) + kUnit * 4);
            }
            break;
        }
        case 2:
            added.push_back(tin.split(slot(), kUnit * static_cast<double>(any(6))));
            break;
        case 3:
            if (!added.empty()) {
                tin.join(added.back());
                added.pop_back();
            }
            break;
        case 4:
            tin.flip(slot(), edge);
            break;
        default:
            tin.constrain(slot(), edge, random() % 4 != 0);
    }
}

/// Returns the humidity of the sand in a step. It changes in the middle of the ten steps that end with a fresh view.
double humidityAt(int step) { return step < 15 ? 0 : step < 35 ? 0.5 : step < 55 ? 1 : 0; }

class TinRedraw : public testing::Test {
protected:
    /// Draws a TIN after random edits, with a tool that hovers and rests. `layers` are shown in every third ten steps.
    void play(unsigned seed, sand::Rim rim, const render_node::Camera& camera, lockstep::Overlays layers, bool flat) {
        std::mt19937 random(seed);
        scene::Scene scene = sample::duneScene(kCells);
        scene.rules.rim = rim;
        scene.look.flatShading = flat;
        Tin tin(scene.terrain);
        const Tin start = tin;
        ScenePainter view(scene, sand::TinData{tin.view()}, glm::dmat4(1));
        const EyeTarget inParts(kRedrawWidth, kRedrawHeight), whole(kRedrawWidth, kRedrawHeight);
        render_node::EyeMemory memory;
        std::vector<Tin::Vertex> added;
        int parts = 0, skipped = 0, severalParts = 0;
        for (int i = 0; i < 60; ++i) {
            for (auto edits = random() % 3; edits > 0; --edits) {
                edit(tin, random, added);
            }
            view.update(sand::TinData{tin.view()}, tin.takeChange());
            if (i % 5 == 2) {
                view.setTool(sample::probeAt(scene, {0.03 * i, 0.9, 0.1 + 0.005 * i}), i % 2 == 0);
            }
            view.setLayers(i / 10 % 3 == 1 ? layers : lockstep::Overlays{});
            view.setHumidity(humidityAt(i));
            const PixelRect drawn = view.drawIfChanged(camera, inParts, memory);
            parts += !drawn.empty() && drawn.area() < kRedrawWidth * kRedrawHeight ? 1 : 0;
            skipped += drawn.empty() ? 1 : 0;
            severalParts += view.counts().pixels < drawn.area() ? 1 : 0;
            ASSERT_TRUE(inParts.read() == sample::draw(view, camera, whole)) << "seed " << seed << ", step " << i;
            // A replica that starts here has its triangles in other slots, beginning at other corners.
            if (i % 20 == 19) {
                ScenePainter fresh(scene, sand::TinData{start.view()}, glm::dmat4(1));
                Tin other = tin;
                other.shuffle(random);
                fresh.update(sand::TinData{other.view()}, {});
                fresh.setTool(sample::probeAt(scene, {0.03 * (i - 2), 0.9, 0.1 + 0.005 * (i - 2)}), (i - 2) % 2 == 0);
                fresh.setLayers(i / 10 % 3 == 1 ? layers : lockstep::Overlays{});
                fresh.setHumidity(humidityAt(i));
                ASSERT_TRUE(inParts.read() == sample::draw(fresh, camera, whole)) << "seed " << seed << ", step " << i;
            }
        }
        std::printf("seed %u: %d views drawn in part, %d of them in several, %d skipped\n", seed, parts, severalParts,
                    skipped);
        EXPECT_GT(parts, 25);
        EXPECT_GT(skipped, 3);
        EXPECT_GT(severalParts, 3);
    }

    std::unique_ptr<render_node::GlContext> context_ =
        render_node::makeOffscreenContext(render_node::Backend::automatic);
    render_node::Camera above_ = sample::camera({1, 1, 2.4}, {1, 1, 0});
    render_node::Camera slanted_ = sample::camera({1, -0.9, 1.3}, {1, 0.9, 0});
};

TEST_F(TinRedraw, OfRandomEditsInPartsIsEqualToTheWhole) { play(1, sand::Rim::closed, slanted_, {}, false); }

TEST_F(TinRedraw, OverAnOpenRimWithWiresIsEqualToTheWhole) {
    lockstep::Overlays layers;
    layers.set(Overlay::wireframe, true);
    layers.set(Overlay::hillShade, true);
    play(2, sand::Rim::open, slanted_, layers, false);
}

TEST_F(TinRedraw, InFacetsIsEqualToTheWhole) { play(3, sand::Rim::closed, above_, {}, true); }

// An island is so far from other ground that its rise changes no normal and no light. It must still be drawn again at
// its new height.
TEST_F(TinRedraw, OfAnIslandThatRisesAsAWholeIsEqualToTheWhole) {
    const auto fromMiddle = [](double x, double y) {
        constexpr int kMiddle = kCells / 2;
        return std::max(std::abs(x / 256 - kMiddle), std::abs(y / 256 - kMiddle));  // [cell]
    };
    const scene::Scene scene = sample::flatScene(kCells, kCells);
    Tin tin(scene.terrain);
    tin.cut([&](double x, double y) { return fromMiddle(x, y) > 6 && fromMiddle(x, y) < 24; });
    (void)tin.takeChange();
    ScenePainter view(scene, sand::TinData{tin.view()}, glm::dmat4(1));
    const EyeTarget inParts(kRedrawWidth, kRedrawHeight), whole(kRedrawWidth, kRedrawHeight);
    render_node::EyeMemory memory;
    view.drawIfChanged(slanted_, inParts, memory);
    for (std::size_t i = 0; i < tin.mesh().places.size(); ++i) {
        const auto& place = tin.mesh().places[i];
        if (fromMiddle(place.x, place.y) < 8) {
            tin.setHeight(static_cast<Tin::Vertex>(i), 8 * kUnit);
        }
    }
    view.update(sand::TinData{tin.view()}, tin.takeChange());
    const PixelRect drawn = view.drawIfChanged(slanted_, inParts, memory);
    EXPECT_LT(drawn.area(), kRedrawWidth * kRedrawHeight / 2);
    EXPECT_TRUE(inParts.read() == sample::draw(view, slanted_, whole));
}

/// Counter of the bytes that GL was sent during the object's lifetime.
class SentBytes {
public:
    SentBytes() {
        bytes_ = 0;
        data_ = glad_glBufferData;
        part_ = glad_glBufferSubData;
        glad_glBufferData = [](GLenum target, GLsizeiptr size, const void* from, GLenum usage) {
            bytes_ += from != nullptr ? size : 0;
            data_(target, size, from, usage);
        };
        glad_glBufferSubData = [](GLenum target, GLintptr at, GLsizeiptr size, const void* from) {
            bytes_ += size;
            part_(target, at, size, from);
        };
    }
    SentBytes(const SentBytes&) = delete;
    SentBytes& operator=(const SentBytes&) = delete;
    ~SentBytes() {
        glad_glBufferData = data_;
        glad_glBufferSubData = part_;
    }
    [[nodiscard]] static std::int64_t take() { return std::exchange(bytes_, 0); }

private:
    static inline std::int64_t bytes_;
    static inline PFNGLBUFFERDATAPROC data_;
    static inline PFNGLBUFFERSUBDATAPROC part_;
};

// A camera sees different parts of the field in turn. Postponed changes must be visible when they come into sight.
TEST_F(TinRedraw, WithWhatIsUnseenPutOffIsEqualToTheWhole) {
    for (const unsigned seed : {5U, 6U, 7U}) {
        std::mt19937 random(seed);
        const scene::Scene scene = sample::duneScene(kCells);
        Tin tin(scene.terrain);
        ScenePainter prompt(scene, sand::TinData{tin.view()}, glm::dmat4(1)),
            late(scene, sand::TinData{tin.view()}, glm::dmat4(1));
        const EyeTarget promptly(kRedrawWidth, kRedrawHeight), lately(kRedrawWidth, kRedrawHeight);
        render_node::EyeMemory ofPrompt, ofLate;
        std::vector<Tin::Vertex> added;
        for (int i = 0; i < 150; ++i) {
            for (auto edits = random() % 3; edits > 0; --edits) {
                edit(tin, random, added);
            }
            const int stay = i / 15;
            const glm::dvec3 place(0.2 + 0.16 * (stay * 3 % 10), 0.2 + 0.16 * (stay * 7 % 10), 0);
            const render_node::Camera near = sample::camera(place + glm::dvec3(0, -0.1, 0.35), place);
            const sand::SurfaceChange change = tin.takeChange();
            prompt.update(sand::TinData{tin.view()}, change);
            late.update(sand::TinData{tin.view()}, change, {&near, 1});
            prompt.drawIfChanged(near, promptly, ofPrompt);
            late.drawIfChanged(near, lately, ofLate);
            ASSERT_TRUE(lately.read() == promptly.read()) << "seed " << seed << ", step " << i;
        }
    }
}

TEST_F(TinRedraw, SendsWhatChangedAndNothingElse) {
    scene::Scene scene = sample::flatScene(kCells, kCells);
    Tin tin(scene.terrain);
    ScenePainter view(scene, sand::TinData{tin.view()}, glm::dmat4(1));
    const EyeTarget target(kRedrawWidth, kRedrawHeight);
    render_node::EyeMemory memory;
    view.drawIfChanged(above_, target, memory);
    const SentBytes sent;
    const auto draw = [&] {
        view.update(sand::TinData{tin.view()}, tin.takeChange());
        const PixelRect drawn = view.drawIfChanged(above_, target, memory);
        return std::pair(SentBytes::take(), drawn.area());
    };
    EXPECT_EQ(draw(), std::pair(std::int64_t{0}, std::int64_t{0})) << "nothing moved";

    const Tin::Vertex vertex = 30 * (kCells + 2) + 30;
    tin.setHeight(vertex, kUnit);
    const auto [rise, pixels] = draw();
    // Sends the places that see the change, in eight directions up to ten cells away, and the normals of the vertices
    // around. Each vertex takes 20 bytes, and gaps of at most eight vertices are sent too.
    EXPECT_GT(rise, 0);
    EXPECT_LE(rise, 21 * 21 * 20);
    EXPECT_GT(pixels, 0);
    tin.setHeight(vertex, kUnit);
    EXPECT_EQ(draw(), std::pair(std::int64_t{0}, std::int64_t{0})) << "it is there already";

    const render_node::Camera elsewhere = sample::camera({1.8, 1.7, 0.3}, {1.8, 1.8, 0});
    tin.setHeight(vertex, 2 * kUnit);
    view.update(sand::TinData{tin.view()}, tin.takeChange(), {&elsewhere, 1});
    EXPECT_EQ(SentBytes::take(), 0) << "no camera sees it";
    EXPECT_GT(draw().first, 0) << "a camera sees it";

    tin.setHeight(vertex, 0);
    (void)draw();
    // The triangle from a vertex to the south-east of its quad's diagonal.
    const Tin::Vertex corner = vertex + 1;
    std::int32_t slot = 0;
    while (tin.mesh().triangles[static_cast<std::size_t>(slot)].corner !=
           std::array{corner, corner + 1, corner + kCells + 2}) {
        ++slot;
    }
    tin.flip(slot, 0);
    // On level sand the light does not change. So the triangles of one or two chunks are sent, of about 512 each.
    const auto [turn, around] = draw();
    EXPECT_GT(turn, 0);
    EXPECT_LE(turn, 2 * 512 * 12);
    EXPECT_GT(around, 0);
}

}  // namespace
