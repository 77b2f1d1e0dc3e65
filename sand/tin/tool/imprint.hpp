// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "base/byte_stream.hpp"
#include "sand/model/step.hpp"
#include "sand/model/tool_shape.hpp"
#include "sand/tin/mesh/mesh.hpp"
#include "sand/tin/tool/outline.hpp"

namespace sand::tin {

/// What the tool that stands in the sand has put into the mesh, until it moves on or leaves: state, as the layer is.
struct Imprint {
    struct Point {
        Vertex vertex;
        Place place;  // a number may be another's by now
        friend bool operator==(const Point&, const Point&) = default;
    };
    /// Where the outline stands, of which tool.
    struct Stand {
        ProbePoint at;
        ToolShape shape;
        Heading heading;
        friend bool operator==(const Stand&, const Stand&) = default;
    };
    std::optional<Stand> stand;                    // nothing while no tool stands in the sand
    std::vector<Point> points;                     // that were not there before
    std::vector<std::pair<Vertex, Vertex>> edges;  // that were not constrained before

    /// Puts the outline in, unless the mesh would then have more than `maxVertices`.
    void putInto(Mesh& mesh, const PlacedOutline& outline, int maxVertices);
    /// Takes out what it has put in. What another outline has bent to its edges stays.
    void takeOutOf(Mesh& mesh);

    void encode(base::ByteWriter& writer) const;
    /// Throws base::FormatError for what no tool has put into a mesh.
    static Imprint decode(base::ByteReader& reader);
    friend bool operator==(const Imprint&, const Imprint&) = default;
};

}  // namespace sand::tin
