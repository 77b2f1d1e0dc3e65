// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "base/byte_stream.hpp"
#include "sand/model/step.hpp"
#include "sand/model/tool.hpp"
#include "sand/tin/mesh/mesh.hpp"
#include "sand/tin/tool/outline.hpp"
#include "sand/tin/volume/vertex_sand.hpp"

namespace sand::tin {

/// The points and edges that the tool in the sand has added to the mesh, until it moves on or leaves. They are part of
/// the state, like the layer.
struct Imprint {
    struct Point {
        Vertex vertex;
        LatticePoint place;  // shows whether the number has passed to another vertex
        friend bool operator==(const Point&, const Point&) = default;
    };
    /// Position of the outline, and the tool that it belongs to.
    struct Pose {
        ProbePoint probe;
        Tool tool;
        friend bool operator==(const Pose&, const Pose&) = default;
    };
    std::optional<Pose> pose;                      // nullopt if no tool is in the sand
    std::vector<Point> points;                     // that were not vertices before
    std::vector<std::pair<Vertex, Vertex>> edges;  // that were not constrained before

    /// Adds the outline to the mesh, unless the mesh would then have more than `maxVertices`. Lists at most
    /// mostEdges(maxVertices) edges; further ones stay in the mesh when the tool leaves.
    void putInto(Mesh& mesh, const PlacedOutline& outline, int maxVertices);
    /// Removes the points and edges that putInto() has added. Edges that another outline has bent to its own edges
    /// stay.
    void takeOutOf(Mesh& mesh);

    /// Returns whether one of the points is a vertex that is higher than `height` [unit].
    [[nodiscard]] bool isAnyAbove(const VertexSand& layer, double height) const;

    void encode(base::ByteWriter& writer) const;
    /// Throws base::FormatError if the bytes are not an imprint, or list more than `most` points or mostEdges(most)
    /// edges.
    static Imprint decode(base::ByteReader& reader, std::size_t most = VertexSand::kMostNumbers);
    static constexpr std::size_t mostEdges(std::size_t vertices) { return 4 * vertices; }
    friend bool operator==(const Imprint&, const Imprint&) = default;
};

}  // namespace sand::tin
