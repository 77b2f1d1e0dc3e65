// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "shapes/grid/chunk_layout.hpp"
#include "shapes/grid/hole_edges.hpp"
#include "shapes/grid/vertices.hpp"
#include "shapes/model/surface_parts.hpp"

namespace shapes {

/// The surface of a height field in parts. Each part is a row of the wall's chunks.
class GridParts final : public SurfaceParts {
public:
    explicit GridParts(const sand::GridData& data);

    /// Returns all parts at the first call, and later the parts with other vertices.
    [[nodiscard]] Change take(const sand::SurfaceData& data) override;
    [[nodiscard]] std::size_t vertices() const override { return vertices_; }
    [[nodiscard]] SurfacePart part(int number) const override;
    [[nodiscard]] std::vector<std::uint32_t> triangles(int part) const override;
    [[nodiscard]] PlaceUniforms places() const override { return surface_.places(); }
    [[nodiscard]] SandRim rim() const override { return surface_.rim(); }
    [[nodiscard]] float lowest() const override;

private:
    struct Chunk {
        std::size_t first = 0;           // number of its first vertex
        std::optional<HoleEdges> holes;  // nullopt if all cells have ground
    };
    [[nodiscard]] const Chunk& chunk(int x, int y) const {
        return chunks_[static_cast<std::size_t>(y * layout_.across + x)];
    }

    GridVertices surface_;
    ChunkLayout layout_;
    std::vector<Chunk> chunks_;  // row by row from the south-west
    std::size_t vertices_ = 0;
    bool taken_ = false;
};

}  // namespace shapes
