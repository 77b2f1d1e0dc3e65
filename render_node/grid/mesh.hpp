// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "render_node/gl/triangle_pace.hpp"
#include "render_node/grid/chunk_geometry.hpp"
#include "render_node/grid/index_lists.hpp"
#include "render_node/grid/levels.hpp"
#include "render_node/grid/triangle_batch.hpp"
#include "render_node/grid/vertex_pages.hpp"
#include "render_node/surface/change_history.hpp"
#include "render_node/surface/drawn_surface.hpp"
#include "shapes/grid/chunk_layout.hpp"
#include "shapes/grid/hole_edges.hpp"
#include "shapes/grid/vertices.hpp"
#include "shapes/model/box.hpp"
#include "shapes/model/sharpening.hpp"

namespace render_node {

/// Vertices of the grid that may look different, and the heights of all triangles of any level at these vertices,
/// before and after the change.
struct ChangedVertices {
    sand::CellRect vertices;
    shapes::HeightRange heights;
    friend ChangedVertices around(const ChangedVertices& a, const ChangedVertices& b) {
        return {a.vertices.joinedWith(b.vertices), shapes::around(a.heights, b.heights)};
    }
};

/// Triangles of a height field, in chunks of about 16 × 16 quads, or of 32 × 32 quads if a large field has five levels.
///
/// The time of a software renderer depends on the number of vertices. So only chunks that a camera sees are drawn, each
/// at the coarsest level that the camera's rule allows. Only these chunks are computed and sent to GL. They share
/// vertex buffers, so that one call draws many of them. A chunk is computed again when the sand in its reach has
/// changed and a camera sees it. If vertices take much memory, the vertices of chunks that were not drawn lately are
/// removed.
class GridMesh final : public DrawnSurface {
public:
    /// `sun` points towards the sun and has length 1.
    GridMesh(const sand::GridData& data, const glm::vec3& sun, int stepsPerSecond);

    [[nodiscard]] bool update(const sand::SurfaceData& data, const sand::SurfaceChange& change,
                              std::span<const glm::dmat4> cameras) override;
    void prepare(const GlProgram& program) const override;
    Drawn draw(const glm::dmat4& sceneToClip, bool culling, const LevelRule& rule,
               const ProgramChoice& choose) override;
    [[nodiscard]] DrawnLevels levelsWithin(const glm::dmat4& sceneToClip, const LevelRule& rule) override;
    [[nodiscard]] std::vector<shapes::Box> changesSince(std::uint64_t revision, DrawnLevels& levels,
                                                        const LevelRule& rule) override;
    [[nodiscard]] bool moves() const override { return movingTiles_ > 0 && layout_.coarsest > 0; }
    [[nodiscard]] std::uint64_t revision() const override { return revision_; }
    [[nodiscard]] shapes::HeightRange heightsEver() const override { return ever_; }
    [[nodiscard]] shapes::SandRim rim() const override { return surface_.rim(); }
    [[nodiscard]] int chunks() const override { return static_cast<int>(chunks_.size()); }
    [[nodiscard]] std::size_t bytes() const override { return pages_.bytes() + lists_.bytes(); }
    [[nodiscard]] std::int64_t placesRead() const override { return surface_.placesRead(); }
    [[nodiscard]] Work work() const override { return work_; }

private:
    struct Indices {
        int first, count;                           // in lists_
        std::vector<shapes::TriangleBlock> blocks;  // of level 0
    };
    struct Chunk {
        sand::CellRect vertices;  // of the vertex grid
        shapes::HeightRange heights;
        std::uint64_t marked = 0;    // last revision that changed its vertices
        std::uint64_t revision = 0;  // last revision that changed its vertices or `moving`
        bool moving = false;         // whether sand that it depends on counts as moving
        struct Measured {
            std::optional<int> from;  // finest level of `errors`; nullopt unless they belong to the current surface
            LevelErrors errors;
        };
        // The errors asked for last, and those before with another finest level. Two eyes may differ in it.
        std::array<Measured, 2> measured;
        std::uint64_t chosenFor = 0;  // value of choice_ for which `level` was chosen
        int level = 0;
        std::vector<ChunkGeometry> geometries;
        std::optional<shapes::HoleEdges> holes;  // nullopt if all cells have ground; otherwise the level is 0
        std::optional<Indices> indices;          // of holes, made when the chunk is first drawn
    };
    /// Vertices and triangles that a drawing shows of a chunk.
    struct Shown {
        const Chunk* chunk;
        const ChunkGeometry* geometry;
        const Indices* indices;
    };
    /// Neighbouring chunks that are culled together, so that few chunks are tested one by one.
    struct Group {
        sand::CellRect chunks;  // columns and rows of chunks
        sand::CellRect vertices;
        shapes::HeightRange heights;
        std::uint64_t revision = 0;
    };
    void makeChunks();
    /// Keeps the levels of the last choice if rule and sand are the same, because a frame asks for them three times.
    void beginChoice(const LevelRule& rule);
    void makeGroups();
    [[nodiscard]] shapes::HeightRange heightsUnder(const sand::CellRect& vertices) const {
        return surface_.heights(surface_.cellsUnder(vertices));
    }
    [[nodiscard]] sand::CellRect verticesOver(const sand::CellRect& cells) const;
    [[nodiscard]] sand::CellRect chunksAround(const sand::CellRect& vertices) const;
    [[nodiscard]] std::vector<sand::CellRect> changedTiles(
        std::span<const shapes::GridVertices::Overwritten> overwritten) const;
    void markChanged(const sand::CellRect& chunks, const sand::CellRect& vertices);
    /// Returns the hash tiles that have begun or ceased to count as moving.
    [[nodiscard]] std::vector<int> followMovement(const sand::Movement& movement);
    void markMoving(int tile);
    [[nodiscard]] bool dependsOnMoving(const sand::CellRect& vertices) const;
    [[nodiscard]] Group& groupOf(int x, int y);
    [[nodiscard]] shapes::Box boxOf(const sand::CellRect& vertices, const shapes::HeightRange& heights) const;
    [[nodiscard]] Chunk& chunk(int x, int y) { return chunks_[static_cast<std::size_t>(y * layout_.across + x)]; }
    template <class Visit>  // void(int x, int y), with column and row of a chunk
    void visitSeen(const glm::dmat4& sceneToClip, bool culling, const Visit& visit);
    [[nodiscard]] int levelOf(int x, int y, const LevelRule& rule);
    [[nodiscard]] int chooseLevel(Chunk& asked, const LevelRule& rule);
    [[nodiscard]] const LevelErrors& errorsOfChunk(Chunk& chunk, int finest);
    /// Returns the longest side of a triangle of any level along an axis [cell].
    [[nodiscard]] int longestStride() const { return 1 << layout_.coarsest; }
    [[nodiscard]] int strideAround(const sand::CellRect& vertices, const DrawnLevels& levels) const;
    [[nodiscard]] shapes::Box boxAround(const sand::CellRect& vertices, const shapes::HeightRange& heights,
                                        int margin) const;
    void updateLevels(DrawnLevels& levels, std::uint64_t revision, const LevelRule& rule,
                      std::vector<shapes::Box>& changed);
    [[nodiscard]] bool mayMatter(int x, int y, const LevelRule& rule) const;
    [[nodiscard]] ChunkLevels levelsOf(int x, int y, const LevelRule& rule);
    [[nodiscard]] ChunkGeometry& geometryOf(Chunk& chunk, const ChunkLevels& levels);
    [[nodiscard]] const Indices& indicesOf(const ChunkLevels& levels);
    [[nodiscard]] const Indices& indicesOf(Chunk& chunk, const ChunkLevels& levels);
    /// Adds the blocks that reach into `frustum`, or all blocks if it is null. Returns the number of triangles.
    int addTriangles(const Shown& shown, const GlProgram* program, const glm::dmat4* frustum,
                     TriangleBatch& batch) const;
    void dropUnused();

    shapes::GridVertices surface_;
    glm::vec3 sun_;
    shapes::ChunkLayout layout_;
    std::vector<Chunk> chunks_;  // row by row from the south-west
    std::vector<Group> groups_;
    shapes::Sharpening sharpening_;
    sand::CellRect tiles_;              // columns and rows of hash tiles
    std::vector<std::uint8_t> moving_;  // 1 for each hash tile that counts as moving
    std::ptrdiff_t movingTiles_ = 0;    // number of these
    VertexPages pages_;
    IndexLists lists_;
    std::map<ChunkLevels, Indices> indices_;
    std::uint64_t revision_ = 0;
    // Number of the current choice of levels, and what it was made for. Levels are chosen again after it changes.
    std::uint64_t choice_ = 0, chosenRevision_ = 0;
    std::optional<LevelRule> chosenBy_;
    std::uint64_t draws_ = 0;
    ChangeHistory<ChangedVertices> changes_;
    std::vector<Shown> shown_;  // by the current draw()
    TrianglePace pace_;
    Work work_;
    shapes::HeightRange ever_;
};

}  // namespace render_node
