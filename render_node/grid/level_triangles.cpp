// SPDX-License-Identifier: Apache-2.0
#include <span>

#include "render_node/grid/levels.hpp"

namespace render_node {
namespace {

/// Returns the place of a vertex of a chunk [quad]: `along` quads along an edge, counter-clockwise, and `inward` quads
/// from it.
glm::ivec2 placeOf(glm::ivec2 quads, std::size_t edge, int along, int inward) {
    switch (edge) {
        case 0:
            return {along, inward};
        case 1:
            return {quads.x - inward, along};
        case 2:
            return {quads.x - along, quads.y - inward};
        default:
            return {inward, quads.y - along};
    }
}

int lengthOf(glm::ivec2 quads, std::size_t edge) { return edge % 2 == 0 ? quads.x : quads.y; }

class Triangulation {
public:
    Triangulation(int quadsAcross, int quadsDown, const ChunkLevels& levels)
        : quads_(quadsAcross, quadsDown), levels_(levels), stride_(1 << levels.level), across_(quadsAcross / stride_) {}

    /// Adds the quads in a part of this level's grid. Their diagonals alternate, so that ridges in both diagonal
    /// directions look alike.
    void addQuads(int west, int south, int east, int north) {
        for (int y = south; y < north; ++y) {
            for (int x = west; x < east; ++x) {
                const int southWest = y * (across_ + 1) + x;
                const int southEast = southWest + 1;
                const int northWest = southWest + across_ + 1;
                const int northEast = northWest + 1;
                if ((x + y) % 2 == 0) {
                    add(southWest, southEast, northEast);
                    add(southWest, northEast, northWest);
                } else {
                    add(southWest, southEast, northWest);
                    add(southEast, northEast, northWest);
                }
            }
        }
    }

    /// Adds the strip between an edge and the first row of vertices inside. The ends of the strip lie on the diagonals
    /// of the corner quads. So each edge's triangles depend only on the level of that edge.
    void addStrip(std::size_t edge) {
        if (levels_.edges[edge] == levels_.level) {
            addQuadsAlong(edge);
            return;
        }
        const int length = lengthOf(quads_, edge);
        const int outerStride = 1 << levels_.edges[edge];
        int outer = 0;
        int inner = stride_;
        while (outer < length || inner < length - stride_) {
            const bool outerNext =
                inner == length - stride_ || (outer < length && 2 * outer + outerStride <= 2 * inner + stride_);
            const int next = outerNext ? onEdge(edge, outer + outerStride) : within(edge, inner + stride_);
            add(onEdge(edge, outer), next, within(edge, inner));
            (outerNext ? outer : inner) += outerNext ? outerStride : stride_;
        }
    }

    [[nodiscard]] std::vector<std::uint16_t> take() { return std::move(indices_); }

private:
    /// Adds the quads along an edge as addQuads() does. Leaves out the halves of the corner quads that belong to the
    /// neighbouring edges.
    void addQuadsAlong(std::size_t edge) {
        const int last = lengthOf(quads_, edge) - stride_;
        for (int along = 0; along <= last; along += stride_) {
            const int next = along + stride_;
            const bool diagonalFromHere = along / stride_ % 2 == 0;
            add(onEdge(edge, along), onEdge(edge, next), within(edge, diagonalFromHere ? next : along));
            if (along > 0 && along < last) {
                add(within(edge, next), within(edge, along), onEdge(edge, diagonalFromHere ? along : next));
            }
        }
    }
    void add(int a, int b, int c) {
        for (const int index : {a, b, c}) {
            indices_.push_back(static_cast<std::uint16_t>(index));
        }
    }
    [[nodiscard]] int inGrid(glm::ivec2 place) const { return place.y / stride_ * (across_ + 1) + place.x / stride_; }
    [[nodiscard]] int within(std::size_t edge, int along) const {
        return inGrid(placeOf(quads_, edge, along, stride_));
    }
    [[nodiscard]] int onEdge(std::size_t edge, int along) const {
        if (along % stride_ == 0) {
            return inGrid(placeOf(quads_, edge, along, 0));
        }
        int first = (across_ + 1) * (quads_.y / stride_ + 1);
        for (std::size_t before = 0; before < edge; ++before) {
            first += lengthOf(quads_, before) + 1;
        }
        return first + along;
    }

    glm::ivec2 quads_;
    const ChunkLevels& levels_;
    int stride_, across_;  // [quad], [quad of the level]
    std::vector<std::uint16_t> indices_;
};

}  // namespace

std::vector<shapes::GridVertex> verticesOf(const shapes::GridVertices& surface, const sand::CellRect& vertices,
                                           const ChunkLevels& levels) {
    if (levels.level == 0) {
        return surface.verticesIn(vertices);
    }
    std::vector<shapes::GridVertex> out;
    const int stride = 1 << levels.level;
    out.reserve(computedVertices(vertices, {levels.level, {levels.level, levels.level, levels.level, levels.level}}));
    for (int row = vertices.y0; row < vertices.y1; row += stride) {
        for (int column = vertices.x0; column < vertices.x1; column += stride) {
            out.push_back(surface.vertex(column, row));
        }
    }
    const glm::ivec2 quads(vertices.x1 - vertices.x0 - 1, vertices.y1 - vertices.y0 - 1);
    std::size_t finer = levels.edges.size();  // edges up to the last one that is finer than the chunk
    while (finer > 0 && levels.edges[finer - 1] == levels.level) {
        --finer;
    }
    for (std::size_t edge = 0; edge < finer; ++edge) {
        const std::size_t first = out.size();
        const int length = lengthOf(quads, edge), outerStride = 1 << levels.edges[edge];
        out.resize(first + static_cast<std::size_t>(length) + 1);
        for (int along = outerStride; along < length; along += outerStride) {
            if (along % stride != 0) {  // the others are in the grid
                const glm::ivec2 place = placeOf(quads, edge, along, 0);
                out[first + static_cast<std::size_t>(along)] =
                    surface.vertex(vertices.x0 + place.x, vertices.y0 + place.y);
            }
        }
    }
    return out;
}

std::size_t computedVertices(const sand::CellRect& vertices, const ChunkLevels& levels) {
    const glm::ivec2 quads(vertices.x1 - vertices.x0 - 1, vertices.y1 - vertices.y0 - 1);
    int count = ((quads.x >> levels.level) + 1) * ((quads.y >> levels.level) + 1);
    for (std::size_t edge = 0; edge < 4; ++edge) {
        count += (lengthOf(quads, edge) >> levels.edges[edge]) - (lengthOf(quads, edge) >> levels.level);
    }
    return static_cast<std::size_t>(count);
}

std::vector<std::uint16_t> trianglesOf(int quadsAcross, int quadsDown, const ChunkLevels& levels) {
    Triangulation triangles(quadsAcross, quadsDown, levels);
    const int stride = 1 << levels.level;
    const int across = quadsAcross / stride;
    const int down = quadsDown / stride;
    if (levels.level == 0) {  // the edges then have level 0 too
        for (const shapes::TriangleBlock& block : shapes::blocksOf(quadsAcross, quadsDown)) {
            triangles.addQuads(block.quads.x0, block.quads.y0, block.quads.x1, block.quads.y1);
        }
    } else {
        // A neighbour's level changes this chunk only along the common edge, so that only the edge is drawn again.
        triangles.addQuads(1, 1, across - 1, down - 1);
        for (std::size_t edge = 0; edge < 4; ++edge) {
            triangles.addStrip(edge);
        }
    }
    return triangles.take();
}

}  // namespace render_node
