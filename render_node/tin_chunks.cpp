// SPDX-License-Identifier: Apache-2.0
// Which triangles of a TIN lie close together.
#include <algorithm>

#include "render_node/tin_surface.hpp"

namespace render_node {

void TinSurface::replace(std::int32_t slot, const TinTriangle& now) {
    if (triangle(slot).alive()) {
        leaveChunk(slot);
    }
    triangle(slot) = now;
    if (!now.alive()) {
        return;
    }
    double x = 0, y = 0;  // [probe unit], three times
    for (const Vertex corner : now.corner) {
        x += vertex(corner).x;
        y += vertex(corner).y;
    }
    InChunk& in = inChunk_[static_cast<std::size_t>(slot)];
    in.chunk = static_cast<int>(y / 3 / chunkSide_) * across_ + static_cast<int>(x / 3 / chunkSide_);
    TinChunk& chunk = chunks_[static_cast<std::size_t>(in.chunk)];
    in.at = static_cast<int>(chunk.slots.size());
    chunk.slots.push_back(slot);
    chunk.changed = chunk.reshaped = true;
}

void TinSurface::leaveChunk(std::int32_t slot) {
    InChunk& in = inChunk_[static_cast<std::size_t>(slot)];
    TinChunk& chunk = chunks_[static_cast<std::size_t>(in.chunk)];
    const std::int32_t last = chunk.slots.back();
    chunk.slots[static_cast<std::size_t>(in.at)] = last;
    inChunk_[static_cast<std::size_t>(last)].at = in.at;
    chunk.slots.pop_back();
    chunk.changed = chunk.reshaped = true;
    in = {};
}

glm::dvec3 TinSurface::at(Vertex number) const {
    const TinVertex& drawn = vertices_[static_cast<std::size_t>(number)];
    return {drawn.x * probe_, drawn.y * probe_, drawn.height};
}

Box TinSurface::boxOf(const TinTriangle& triangle) const {
    const glm::dvec3 a = at(triangle.corner[0]), b = at(triangle.corner[1]), c = at(triangle.corner[2]);
    const double margin = 0.01 * cellSize_;  // for what GL's floats may round
    return {glm::min(a, glm::min(b, c)) - margin, glm::max(a, glm::max(b, c)) + margin};
}

bool TinSurface::settle(TinChunk& chunk) {
    if (!chunk.changed) {
        return false;
    }
    std::ranges::sort(chunk.slots, {}, [this](std::int32_t slot) { return triangle(slot).corner; });
    for (std::size_t i = 0; i < chunk.slots.size(); ++i) {
        inChunk_[static_cast<std::size_t>(chunk.slots[i])].at = static_cast<int>(i);
    }
    chunk.changed = false;
    return true;
}

const Box& TinSurface::boxOf(TinChunk& chunk) const {
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
