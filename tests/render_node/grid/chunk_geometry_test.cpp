// SPDX-License-Identifier: Apache-2.0
#include "render_node/grid/chunk_geometry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <vector>

#include "render_node/gl/gl_context.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/pictures/wall_painter.hpp"

namespace {

using render_node::ChunkGeometry;
using render_node::ChunkLevels;
using shapes::GridVertex;

constexpr sand::CellRect kChunk{16, 16, 33, 33};  // 16 × 16 quads

class SentChunk : public testing::Test {
protected:
    /// Returns whether GL has every vertex that triangles of these levels use.
    [[nodiscard]] bool hasVerticesOf(const ChunkLevels& levels) {
        const std::vector<GridVertex> wanted = render_node::verticesOf(surface_, kChunk, levels);
        pages_.send();
        std::vector<GridVertex> sent(static_cast<std::size_t>(geometry_.range().count()));
        geometry_.range().bind(0);
        GLint buffer = 0;
        glGetVertexAttribiv(0, GL_VERTEX_ATTRIB_ARRAY_BUFFER_BINDING, &buffer);
        glBindBuffer(GL_ARRAY_BUFFER, static_cast<GLuint>(buffer));
        glGetBufferSubData(GL_ARRAY_BUFFER, render_node::bytesOf<GridVertex>(geometry_.range().first()),
                           render_node::bytesOf<GridVertex>(sent.size()), sent.data());
        const auto used = render_node::trianglesOf(16, 16, levels);
        return std::ranges::all_of(used, [&](std::uint16_t i) {
            using Bytes = std::array<std::uint8_t, sizeof(GridVertex)>;
            return i < sent.size() && std::bit_cast<Bytes>(sent[i]) == std::bit_cast<Bytes>(wanted.at(i));
        });
    }
    std::unique_ptr<render_node::GlContext> context_ =
        render_node::makeOffscreenContext(render_node::Backend::automatic);
    scene::Scene scene_ = sample::duneScene(64);
    shapes::GridVertices surface_{scene_.terrain};
    render_node::VertexPages pages_{1000};
    ChunkGeometry geometry_{kChunk, 2};
};

TEST_F(SentChunk, GetsTheVerticesOfAnEdgeThatBecomesFiner) {
    const ChunkLevels alike{2, {2, 2, 2, 2}};
    geometry_.refresh(surface_, alike, nullptr, pages_);
    EXPECT_TRUE(hasVerticesOf(alike));
    for (std::size_t edge = 0; edge < 4; ++edge) {
        for (const int level : {1, 0}) {
            ChunkLevels finer = alike;
            finer.edges.at(edge) = level;
            EXPECT_FALSE(hasVerticesOf(finer)) << "edge " << edge << ", level " << level;
            geometry_.refresh(surface_, finer, nullptr, pages_);
            EXPECT_TRUE(hasVerticesOf(finer)) << "edge " << edge << ", level " << level;
        }
    }
}

TEST_F(SentChunk, KeepsTheVerticesOfAnEdgeThatBecomesCoarser) {
    geometry_.refresh(surface_, {2, {0, 1, 0, 2}}, nullptr, pages_);
    for (const ChunkLevels& coarser : {ChunkLevels{2, {1, 1, 0, 2}}, ChunkLevels{2, {2, 2, 2, 2}}}) {
        geometry_.refresh(surface_, coarser, nullptr, pages_);
        EXPECT_TRUE(hasVerticesOf(coarser));
    }
}

}  // namespace
