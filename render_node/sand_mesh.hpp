// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "render_node/frustum.hpp"
#include "render_node/gl/gl_handle.hpp"
#include "render_node/sand_damage.hpp"
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

    /// Draws the chunks that reach into the frustum; all of them when `culling` is off. The program must be in use, or
    /// `before` choose one by the box of each chunk.
    Drawn draw(const glm::dmat4& sceneToClip, bool culling, const std::function<void(const Box&)>& before = {});

    /// Counts the updates that changed something.
    [[nodiscard]] std::uint64_t revision() const { return revision_; }
    /// Where the picture of the sand has changed since that revision. Good until the next update().
    [[nodiscard]] std::span<const SandDamage::Part> damageSince(std::uint64_t revision) const {
        return damage_.since(revision);
    }
    /// The lowest and the highest that any sand has been.
    [[nodiscard]] HeightRange heightsEver() const { return ever_; }

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
        sand::Rect vertices;  // of the vertex grid
        HeightRange heights;
        bool stale = true;  // its vertices are not those of the surface
        std::optional<Geometry> geometry;
    };
    /// Part of an update.
    struct Change {
        sand::Rect vertices;  // that may look different, with their triangles
        HeightRange before;
    };
    void makeIndices();
    [[nodiscard]] std::vector<Change> changesOf(const sand::HeightField& field, const sand::Rect& cells) const;
    [[nodiscard]] Box boxOf(const sand::Rect& vertices, const HeightRange& heights) const;
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
    SandDamage damage_;
    HeightRange ever_;
};

}  // namespace render_node
