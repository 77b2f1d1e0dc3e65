// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "render_node/gl/gl_handle.hpp"
#include "render_node/gl/triangle_pace.hpp"
#include "render_node/surface/change_history.hpp"
#include "render_node/surface/drawn_surface.hpp"
#include "render_node/tin/backlog.hpp"
#include "render_node/tin/vertices.hpp"
#include "sand/model/surface_data.hpp"

namespace render_node {

/// Triangles of a TIN in GL. Vertices are stored by number, triangles by chunk.
///
/// Only changed vertices are sent to GL. A chunk's triangles are sent if one of them has changed and a camera sees the
/// chunk. All cameras get all triangles, because the sand itself decides how fine the TIN is.
class TinMesh final : public DrawnSurface {
public:
    TinMesh(const sand::tin::SurfaceView& tin, double cellSize /* [scene unit] */);

    /// Postpones changes that no camera sees.
    [[nodiscard]] bool update(const sand::SurfaceData& data, const sand::SurfaceChange& change,
                              std::span<const glm::dmat4> cameras) override;
    void prepare(const GlProgram& program) const override;
    Drawn draw(const glm::dmat4& sceneToClip, bool culling, const LevelRule& rule,
               const ProgramChoice& choose) override;
    /// Draws the constraints.
    void drawMarks(const glm::dmat4& sceneToClip, bool culling,
                   const std::function<void(const GlProgram&)>& prepare) override;
    [[nodiscard]] DrawnLevels levelsWithin(const glm::dmat4&, const LevelRule&) override { return {}; }
    [[nodiscard]] std::vector<shapes::Box> changesSince(std::uint64_t revision, DrawnLevels&,
                                                        const LevelRule&) override;
    [[nodiscard]] std::uint64_t revision() const override { return revision_; }
    [[nodiscard]] shapes::HeightRange heightsEver() const override { return surface_.heightsEver(); }
    [[nodiscard]] shapes::SandRim rim() const override { return surface_.rim(); }
    [[nodiscard]] int chunks() const override { return static_cast<int>(buffers_.size()); }
    [[nodiscard]] std::size_t bytes() const override { return bytes_; }
    [[nodiscard]] std::int64_t placesRead() const override { return placesRead_; }

private:
    /// Buffers of a chunk, made when a camera first sees it.
    struct Buffers {
        std::optional<GlBuffer> triangles, marks;
        std::size_t sent = 0;    // number of triangles in `triangles`
        std::size_t marked = 0;  // number of edges in `marks`
        bool marksStale = true;
    };
    template <class Visit>  // void(std::size_t chunk)
    void visitSeen(const glm::dmat4& sceneToClip, bool culling, const Visit& visit);
    [[nodiscard]] bool takeOver(const TinVertices::Change& change);
    void sendAllVertices();
    void sendVertices(std::span<const sand::tin::Vertex> changed);
    void sendTriangles(std::size_t chunk);
    void sendMarks(std::size_t chunk);

    TinVertices surface_;
    TinBacklog backlog_;
    float probe_;      // [scene unit]
    glm::vec2 field_;  // [probe unit]
    GlVertexArray array_;
    GlBuffer vertices_;
    std::size_t room_ = 0;                  // room in vertices_ [vertex]
    std::vector<Buffers> buffers_;          // by chunk
    std::optional<GlProgram> markProgram_;  // made when marks are first drawn
    std::size_t bytes_ = 0;
    std::int64_t placesRead_ = 0;
    std::uint64_t revision_ = 0;
    ChangeHistory<shapes::Box> changes_;
    TrianglePace pace_;
};

}  // namespace render_node
