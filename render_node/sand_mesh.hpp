// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "render_node/frustum.hpp"
#include "render_node/gl/gl_handle.hpp"
#include "render_node/sand_surface.hpp"

namespace render_node {

/// The sand's triangles, in chunks of about 32 × 32 quads.
///
/// A software renderer is bound by vertices: only chunks that a camera sees are drawn, and only those are ever computed
/// and sent to GL; a chunk is computed again when sand in its reach has changed and somebody looks at it. Every camera
/// gets the same vertices. One thread, its context current.
class SandMesh {
public:
    struct Drawn {
        int chunks = 0;
        int triangles = 0;
    };

    explicit SandMesh(const sand::HeightField& field);

    /// Takes over the heights of these cells, which must lie within the field.
    void update(const sand::HeightField& field, const sand::Rect& cells);

    /// Draws the chunks that reach into the frustum; all of them when `culling` is off. The program must be in use.
    Drawn draw(const glm::dmat4& sceneToClip, bool culling);

    /// Counts the updates so far.
    [[nodiscard]] std::uint64_t revision() const { return revision_; }
    /// Whether sand that this camera sees, or saw, may have changed since that revision.
    [[nodiscard]] bool changedInView(const glm::dmat4& sceneToClip, std::uint64_t since) const;
    /// The lowest any sand has been [scene unit].
    [[nodiscard]] float lowestEver() const;

    [[nodiscard]] const SandSurface& surface() const { return surface_; }
    [[nodiscard]] int chunks() const { return static_cast<int>(chunks_.size()); }
    /// Bytes of vertices and indices in GL: grows as chunks come into view.
    [[nodiscard]] std::size_t bytes() const { return bytes_; }

private:
    struct Geometry {
        GlVertexArray array;
        GlBuffer vertices;
    };
    struct Chunk {
        sand::Rect vertices;            // of the vertex grid
        float lowest, highest;          // [scene unit]
        float lowestEver, highestEver;  // since the start [scene unit]
        std::uint64_t changed = 0;      // revision of the last update that touched it
        bool stale = true;              // its vertices are not those of the surface
        std::optional<Geometry> geometry;
    };
    void makeIndices();
    void measure(Chunk& chunk) const;
    [[nodiscard]] Box boxOf(const Chunk& chunk, float lowest, float highest) const;
    void refresh(Chunk& chunk);

    SandSurface surface_;
    int across_, down_;                // chunks
    int quadsAcross_, quadsDown_;      // of every chunk
    bool software_;                    // drawn by llvmpipe, whose memory must be kept small
    std::vector<Chunk> chunks_;        // row by row from the south-west
    std::vector<SandVertex> scratch_;  // one chunk
    GlBuffer indices_;                 // 16 bit, one chunk's
    std::size_t bytes_ = 0;
    std::uint64_t revision_ = 0;
};

}  // namespace render_node
