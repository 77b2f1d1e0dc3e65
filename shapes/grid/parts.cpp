// SPDX-License-Identifier: Apache-2.0
#include "shapes/grid/parts.hpp"

#include <algorithm>
#include <numeric>

namespace shapes {

GridParts::GridParts(const sand::GridData& data)
    : surface_(data.field, data.ground), layout_(surface_.columns(), surface_.rows()) {
    for (int y = 0; y < layout_.down; ++y) {
        for (int x = 0; x < layout_.across; ++x) {
            const sand::CellRect vertices = layout_.vertices(x, y);
            Chunk& made = chunks_.emplace_back();
            made.first = vertices_;
            if (surface_.hasHole(vertices)) {
                made.holes.emplace(surface_, vertices);
                vertices_ += made.holes->addedCount();
            }
            vertices_ +=
                static_cast<std::size_t>(layout_.quadsAcross + 1) * static_cast<std::size_t>(layout_.quadsDown + 1);
        }
    }
}

SurfaceParts::Change GridParts::take(const sand::SurfaceData& data) {
    Change change;
    const sand::HeightField& field = std::get<sand::GridData>(data).field;
    std::vector<GridVertices::Overwritten> overwritten;
    surface_.takeOver(field, field.bounds(), overwritten);
    if (!taken_) {
        taken_ = change.whole = change.rim = true;
        change.parts.resize(static_cast<std::size_t>(layout_.down));
        std::iota(change.parts.begin(), change.parts.end(), 0);
        return change;
    }
    std::vector<bool> changed(static_cast<std::size_t>(layout_.down));
    for (const GridVertices::Overwritten& block : overwritten) {
        // Cell c lies under vertex c + 1. The outermost ring of vertices repeats the ring next to it.
        const int first = block.cells.y0 - GridVertices::kReach, last = block.cells.y1 + GridVertices::kReach + 1;
        for (int y = std::max(first / layout_.quadsDown - 1, 0); y < layout_.down && y * layout_.quadsDown <= last;
             ++y) {
            changed[static_cast<std::size_t>(y)] = true;
        }
        change.rim |= surface_.touchesRim(block.cells);
    }
    for (int y = 0; y < layout_.down; ++y) {
        if (changed[static_cast<std::size_t>(y)]) {
            change.parts.push_back(y);
        }
    }
    return change;
}

SurfacePart GridParts::part(int number) const {
    SurfacePart part;
    part.first = static_cast<std::uint32_t>(chunk(0, number).first);
    for (int x = 0; x < layout_.across; ++x) {
        std::vector<GridVertex> vertices = surface_.verticesIn(layout_.vertices(x, number));
        if (const auto& holes = chunk(x, number).holes) {
            const std::vector<GridVertex> added = holes->added(vertices);
            vertices.insert(vertices.end(), added.begin(), added.end());
        }
        for (const GridVertex& vertex : vertices) {
            part.add(vertex, vertex.column, vertex.row);
        }
    }
    return part;
}

std::vector<std::uint32_t> GridParts::triangles(int part) const {
    std::vector<std::uint32_t> all;
    for (int x = 0; x < layout_.across; ++x) {
        const auto add = [&](const HoleEdges& edges) {
            for (const std::uint32_t index : edges.indices()) {
                all.push_back(static_cast<std::uint32_t>(chunk(x, part).first) + index);
            }
        };
        const auto& holes = chunk(x, part).holes;
        holes ? add(*holes) : add(HoleEdges(surface_, layout_.vertices(x, part)));
    }
    return all;
}

float GridParts::lowest() const { return surface_.heights({0, 0, surface_.columns(), surface_.rows()}).lowest; }

}  // namespace shapes
