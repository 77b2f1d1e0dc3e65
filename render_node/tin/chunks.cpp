// SPDX-License-Identifier: Apache-2.0
// Assigns the triangles of a TIN to chunks and parts of triangles that are close together.
#include <algorithm>
#include <compare>
#include <utility>

#include "render_node/tin/vertices.hpp"

namespace render_node {
namespace {

/// Triangle of a chunk, with the order in which a chunk sorts its triangles.
struct Ordered {
    int part = 0;
    std::array<sand::tin::Vertex, 3> corner{};
    std::int32_t slot = 0;
    // clang-tidy 14 reports the 0 in the operator that it generates itself. NOLINTNEXTLINE(modernize-use-nullptr)
    friend auto operator<=>(const Ordered&, const Ordered&) = default;
};

}  // namespace

void TinVertices::replace(std::int32_t slot, const TinTriangle& now) {
    if (triangle(slot).alive()) {
        leaveChunk(slot);
    }
    triangle(slot) = now;
    if (!now.alive()) {
        return;
    }
    InChunk& in = inChunk_[static_cast<std::size_t>(slot)];
    in = homeOf(now);
    TinChunk& chunk = chunks_[static_cast<std::size_t>(in.chunk)];
    in.at = static_cast<int>(chunk.slots.size());
    chunk.slots.push_back(slot);
    chunk.changed = chunk.reshaped = chunk.partsReshaped = true;
}

TinVertices::InChunk TinVertices::homeOf(const TinTriangle& triangle) const {
    double x = 0, y = 0;  // [probe unit], sum of three corners
    for (const Vertex corner : triangle.corner) {
        x += vertices_[static_cast<std::size_t>(corner)].x;
        y += vertices_[static_cast<std::size_t>(corner)].y;
    }
    const double parts = kPartsAcross / (3 * chunkSide_);
    const int column = static_cast<int>(x * parts), row = static_cast<int>(y * parts);
    return {.chunk = row / kPartsAcross * across_ + column / kPartsAcross,
            .part = row % kPartsAcross * kPartsAcross + column % kPartsAcross};
}

/// Moves a triangle to the right chunk and part after its corners have moved. Its corners still have the same numbers,
/// because a removed vertex's number can be given to a vertex at another place.
void TinVertices::keepHome(std::int32_t slot) {
    const TinTriangle same = triangle(slot);
    const InChunk &in = inChunk_[static_cast<std::size_t>(slot)], home = homeOf(same);
    if (in.chunk != home.chunk || in.part != home.part) {
        replace(slot, same);
    }
}

void TinVertices::leaveChunk(std::int32_t slot) {
    InChunk& in = inChunk_[static_cast<std::size_t>(slot)];
    TinChunk& chunk = chunks_[static_cast<std::size_t>(in.chunk)];
    const std::int32_t last = chunk.slots.back();
    chunk.slots[static_cast<std::size_t>(in.at)] = last;
    inChunk_[static_cast<std::size_t>(last)].at = in.at;
    chunk.slots.pop_back();
    chunk.changed = chunk.reshaped = chunk.partsReshaped = true;
    in = {};
}

glm::dvec3 TinVertices::at(Vertex number) const {
    const TinVertex& drawn = vertices_[static_cast<std::size_t>(number)];
    return {drawn.x * probe_, drawn.y * probe_, drawn.height};
}

Box TinVertices::boxOf(const TinTriangle& triangle) const {
    const glm::dvec3 a = at(triangle.corner[0]), b = at(triangle.corner[1]), c = at(triangle.corner[2]);
    const double margin = 0.01 * cellSize_;  // for rounding of GL's floats
    return {glm::min(a, glm::min(b, c)) - margin, glm::max(a, glm::max(b, c)) + margin};
}

bool TinVertices::settle(TinChunk& chunk) {
    if (!chunk.changed) {
        return false;
    }
    std::vector<Ordered> order;
    order.reserve(chunk.slots.size());
    for (const std::int32_t slot : chunk.slots) {
        order.push_back({inChunk_[static_cast<std::size_t>(slot)].part, triangle(slot).corner, slot});
    }
    std::ranges::sort(order);
    for (std::size_t i = 0; i < order.size(); ++i) {
        chunk.slots[i] = order[i].slot;
        inChunk_[static_cast<std::size_t>(chunk.slots[i])].at = static_cast<int>(i);
    }
    chunk.changed = false;
    return true;
}

const std::vector<TinChunk::Part>& TinVertices::partsOf(TinChunk& chunk) const {
    if (chunk.partsReshaped) {
        chunk.parts.clear();
        int last = -1;
        for (std::size_t i = 0; i < chunk.slots.size(); ++i) {
            const TinTriangle& one = triangles_[static_cast<std::size_t>(chunk.slots[i])];
            const int number = inChunk_[static_cast<std::size_t>(chunk.slots[i])].part;
            const Box box = boxOf(one);
            if (std::exchange(last, number) != number) {
                chunk.parts.push_back({i, i, box});
            }
            TinChunk::Part& part = chunk.parts.back();
            part.end = i + 1;
            part.box = around(part.box, box);
        }
        chunk.partsReshaped = false;
    }
    return chunk.parts;
}

const Box& TinVertices::boxOf(TinChunk& chunk) const {
    if (chunk.reshaped) {
        chunk.box = boxOf(triangles_[static_cast<std::size_t>(chunk.slots.front())]);
        for (const std::int32_t slot : chunk.slots) {
            chunk.box = around(chunk.box, boxOf(triangles_[static_cast<std::size_t>(slot)]));
        }
        chunk.reshaped = false;
    }
    return chunk.box;
}

}  // namespace render_node
