// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "sand/tin/tool/displacement.hpp"
#include "sand/tin/volume/vertex_sand.hpp"

namespace tin_samples {

using sand::ProbePoint;
using sand::Rim;
using sand::ToolKind;
using sand::tin::DetailRules;
using sand::tin::Displacement;
using sand::tin::Imprint;
using sand::tin::LatticePoint;
using sand::tin::Vertex;
using sand::tin::VertexSand;

/// Returns a level field of height 0 with `columns` × `rows` cells. A vertex is in the middle of every square of side
/// `spacing` [probe unit].
inline VertexSand levelLayer(int columns, int rows, std::int32_t spacing) {
    const std::int32_t width = columns * sand::kProbePerCell, depth = rows * sand::kProbePerCell;
    sand::tin::Mesh mesh(width, depth);
    std::vector<LatticePoint> places;
    for (std::int32_t y = spacing / 2; y <= depth; y += spacing) {
        for (std::int32_t x = spacing / 2; x <= width; x += spacing) {
            places.push_back({x, y});
        }
    }
    mesh.insert(places);
    VertexSand layer(std::move(mesh));
    static_cast<void>(layer.takeChange());
    return layer;
}

inline base::Bytes bytesOf(const VertexSand& layer) {
    base::ByteWriter writer;
    layer.encode(writer);
    return writer.take();
}

/// Returns the height of the linear surface [unit]. The search begins at triangle `near`, and sets `near` to the
/// triangle that it finds.
inline double heightAt(const VertexSand& layer, const LatticePoint& place, std::int32_t& near) {
    const auto found = sand::tin::locate(layer.triangles(), place, near);
    near = found.triangle;
    return layer.heightAt(found);
}
inline double heightAt(const VertexSand& layer, const LatticePoint& place) {
    std::int32_t near = sand::tin::kNoNumber;
    return heightAt(layer, place, near);
}

inline sand::ProbePoint probeAt(double x, double y, double z /* [cell] */) {
    const auto probe = [](double cells) { return static_cast<std::int32_t>(std::floor(cells * sand::kProbePerCell)); };
    return {probe(x), probe(y), probe(z)};
}

/// Returns rules with one nominal cell between the vertices where a tool works.
inline sand::tin::DetailRules fineRules() {
    sand::tin::DetailRules rules;
    rules.spacing = sand::kProbePerCell;
    return rules;
}

inline sand::Tool toolOf(sand::ToolKind kind, double radius /* [cell] */, const sand::Heading& heading = {}) {
    const auto size = static_cast<std::int32_t>(radius * sand::kProbePerCell);
    return {kind, size, sand::isRound(kind) ? 0 : static_cast<std::int32_t>(size * sand::usualWidth(kind)), heading};
}

template <class Visit>
void forEachVertex(const VertexSand& layer, const Visit& visit) {
    const auto& mesh = layer.triangles();
    for (Vertex vertex = 0; vertex < static_cast<Vertex>(mesh.triangleAt.size()); ++vertex) {
        if (mesh.alive(vertex)) {
            visit(vertex, mesh.places[static_cast<std::size_t>(vertex)],
                  layer.heights()[static_cast<std::size_t>(vertex)]);
        }
    }
}

}  // namespace tin_samples
