// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/tool/imprint.hpp"

#include <algorithm>
#include <cstdlib>
#include <iterator>

#include "base/fields.hpp"

namespace sand::tin {
namespace {

bool lives(const Triangles& mesh, const Imprint::Point& point) {
    return mesh.alive(point.vertex) && mesh.places[static_cast<std::size_t>(point.vertex)] == point.place;
}

void encodePoint(const ProbePoint& point, base::ByteWriter& writer) {
    writer.put(point.x);
    writer.put(point.y);
    writer.put(point.z);
}

/// Reads a number of entries. Throws if there are more than `most`, or if so many entries of at least `bytesEach` bytes
/// do not fit in the rest.
std::uint64_t decodeCount(base::ByteReader& reader, std::size_t bytesEach, std::size_t most) {
    const std::uint64_t count = reader.getVarint();
    if (count > most || count > reader.rest().size() / bytesEach) {
        throw base::FormatError("an imprint of " + std::to_string(count) + " points or edges in " +
                                std::to_string(reader.rest().size()) + " bytes");
    }
    return count;
}

Imprint::Pose decodePose(base::ByteReader& reader) {
    Imprint::Pose pose;
    pose.probe.x = reader.get<std::int32_t>();
    pose.probe.y = reader.get<std::int32_t>();
    pose.probe.z = reader.get<std::int32_t>();
    pose.tool = base::read<Tool>(reader);
    const bool near = std::min({pose.probe.x, pose.probe.y, pose.probe.z}) >= -kMaxProbe &&
                      std::max({pose.probe.x, pose.probe.y, pose.probe.z}) <= kMaxProbe;
    if (!near) {
        throw base::FormatError("an imprint with a tool out of range");
    }
    return pose;
}

/// Returns the other ends of the constraints at a vertex, except those on the rim and those in `ours`, which must be
/// sorted.
std::vector<Vertex> othersAt(const Triangles& mesh, Vertex vertex, const std::vector<std::pair<Vertex, Vertex>>& ours) {
    std::vector<Vertex> others;
    aroundVertex(mesh, vertex, [&](std::int32_t slot, int corner) {
        const Triangle& triangle = mesh.triangles[index(slot)];
        const Vertex end = triangle.corner[static_cast<std::size_t>(corner + 1) % 3];
        const std::size_t side = static_cast<std::size_t>(corner + 2) % 3;
        if (triangle.constrained[side] && triangle.neighbour[side] != kNoNumber &&
            !std::binary_search(ours.begin(), ours.end(), std::pair<Vertex, Vertex>(std::minmax(vertex, end)))) {
            others.push_back(end);
        }
    });
    return others;
}

}  // namespace

void Imprint::putInto(Mesh& mesh, const PlacedOutline& outline, int maxVertices) {
    if (mesh.vertexCount() + static_cast<int>(outline.points.size()) > maxVertices) {
        return;
    }
    std::vector<Vertex> vertices;
    for (const LatticePoint& place : outline.points) {
        const int before = mesh.vertexCount();
        vertices.push_back(mesh.insert(place));
        if (mesh.vertexCount() > before) {
            points.push_back({vertices.back(), place});
        }
    }
    const auto vertexAt = [&](const LatticePoint& place) {
        return vertices[static_cast<std::size_t>(std::find(outline.points.begin(), outline.points.end(), place) -
                                                 outline.points.begin())];
    };
    for (const auto& [from, to] : outline.edges) {
        const Vertex a = vertexAt(from), b = vertexAt(to);
        if (mesh.isConstrained(a, b)) {
            continue;
        }
        const auto [along, before] = mesh.constrain(a, b);
        for (std::size_t i = 1; i < along.size(); ++i) {
            if (const std::pair<Vertex, Vertex> edge = std::minmax(along[i - 1], along[i]);
                std::find(before.begin(), before.end(), edge) == before.end()) {
                edges.push_back(edge);
            }
        }
    }
    edges.resize(std::min(edges.size(), mostEdges(static_cast<std::size_t>(maxVertices))));
}

void Imprint::takeOutOf(Mesh& mesh) {
    // Only in a state from outside, the smaller vertex may be last.
    std::transform(edges.begin(), edges.end(), edges.begin(),
                   [](const auto& edge) { return std::pair<Vertex, Vertex>(std::minmax(edge.first, edge.second)); });
    std::sort(edges.begin(), edges.end());
    // Sorted, because a state from outside may list as many points and edges as the mesh has vertices.
    std::vector<Vertex> ours;
    std::transform(points.begin(), points.end(), std::back_inserter(ours),
                   [](const Point& point) { return point.vertex; });
    std::sort(ours.begin(), ours.end());
    const auto isOurs = [&ours](Vertex vertex) { return std::binary_search(ours.begin(), ours.end(), vertex); };
    // Edges whose ends are ours go with their ends. In a state from outside, an edge may name vertices that do not
    // exist.
    const Triangles& there = mesh.triangles();
    for (const auto& [a, b] : edges) {
        if (!isOurs(a) && !isOurs(b) && there.alive(a) && there.alive(b)) {
            mesh.release(a, b);
        }
    }
    for (const Point& point : points) {
        if (lives(there, point)) {
            const std::vector<Vertex> others = othersAt(there, point.vertex, edges);
            if (mesh.remove(point.vertex) && others.size() == 2) {
                mesh.constrain(others[0], others[1]);  // the edge of an earlier outline on which the point was
            }
        }
    }
    *this = {};
}

bool Imprint::isAnyAbove(const VertexSand& layer, double height) const {
    return std::any_of(points.begin(), points.end(), [&](const Point& point) {
        return lives(layer.triangles(), point) && layer.heights()[index(point.vertex)] > height;
    });
}

void Imprint::encode(base::ByteWriter& writer) const {
    writer.put(static_cast<std::uint8_t>(pose ? 1 : 0));
    if (!pose) {
        return;
    }
    encodePoint(pose->probe, writer);
    base::putMember(writer, pose->tool);
    writer.putVarint(points.size());
    for (const Point& point : points) {
        writer.put(point.vertex);
        writer.put(point.place.x);
        writer.put(point.place.y);
    }
    writer.putVarint(edges.size());
    for (const auto& [a, b] : edges) {
        writer.put(a);
        writer.put(b);
    }
}

Imprint Imprint::decode(base::ByteReader& reader, std::size_t most) {
    Imprint imprint;
    if (!base::read<bool>(reader)) {
        return imprint;
    }
    imprint.pose = decodePose(reader);
    for (std::uint64_t count = decodeCount(reader, 12, most); count > 0; --count) {
        Point point{};
        point.vertex = reader.get<Vertex>();
        point.place.x = reader.get<std::int32_t>();
        point.place.y = reader.get<std::int32_t>();
        imprint.points.push_back(point);
    }
    for (std::uint64_t count = decodeCount(reader, 8, mostEdges(most)); count > 0; --count) {
        const auto a = reader.get<Vertex>();
        imprint.edges.emplace_back(a, reader.get<Vertex>());
    }
    return imprint;
}

}  // namespace sand::tin
