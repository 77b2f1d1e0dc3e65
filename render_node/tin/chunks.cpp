// SPDX-License-Identifier: Apache-2.0
#include "render_node/tin/chunks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <utility>

namespace render_node {
namespace {

constexpr double kTrianglesPerChunk = 512;
constexpr double kFewestChunksAcross = 32, kMostChunksAcross = 64;  // a coarse TIN becomes fine where sand is dug

/// Triangle of a chunk, with the order in which a chunk sorts its triangles.
struct Ordered {
    int part = 0;
    std::array<sand::tin::Vertex, 3> corner{};
    std::int32_t slot = 0;
    // clang-tidy 14 reports the 0 in the operator that it generates itself. NOLINTNEXTLINE(modernize-use-nullptr)
    friend auto operator<=>(const Ordered&, const Ordered&) = default;
};

bool overlapOnGround(const shapes::Box& a, const shapes::Box& b) {
    return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y;
}

}  // namespace

double TinChunks::sideFor(const sand::tin::Triangles& mesh) {
    const double wanted = std::ceil(std::sqrt(static_cast<double>(mesh.triangles.size()) / kTrianglesPerChunk));
    return std::max(mesh.width, mesh.depth) / std::clamp(wanted, kFewestChunksAcross, kMostChunksAcross);
}

TinChunks::TinChunks(std::int32_t width, std::int32_t depth, double side)
    : across_(static_cast<int>(width / side) + 1),
      side_(side),
      chunks_(static_cast<std::size_t>(across_) * static_cast<std::size_t>(depth / side + 1)) {}

void TinChunks::replace(shapes::TinGeometry& geometry, std::int32_t slot, const shapes::TinTriangle& now) {
    if (geometry.triangle(slot).alive()) {
        leaveChunk(slot);
    }
    geometry.triangle(slot) = now;
    if (!now.alive()) {
        return;
    }
    InChunk& in = inChunk_[static_cast<std::size_t>(slot)];
    in = homeOf(geometry, now);
    TinChunk& chunk = chunks_[static_cast<std::size_t>(in.chunk)];
    in.at = static_cast<int>(chunk.slots.size());
    chunk.slots.push_back(slot);
    chunk.changed = chunk.reshaped = chunk.partsReshaped = true;
}

TinChunks::InChunk TinChunks::homeOf(const shapes::TinGeometry& geometry, const shapes::TinTriangle& triangle) const {
    double x = 0, y = 0;  // [probe unit], sum of three corners
    for (const sand::tin::Vertex corner : triangle.corner) {
        x += geometry.vertex(corner).x;
        y += geometry.vertex(corner).y;
    }
    const double parts = kPartsAcross / (3 * side_);
    const int column = static_cast<int>(x * parts), row = static_cast<int>(y * parts);
    return {.chunk = row / kPartsAcross * across_ + column / kPartsAcross,
            .part = row % kPartsAcross * kPartsAcross + column % kPartsAcross};
}

void TinChunks::keepHome(shapes::TinGeometry& geometry, std::int32_t slot) {
    const shapes::TinTriangle same = geometry.triangle(slot);
    const InChunk &in = inChunk_[static_cast<std::size_t>(slot)], home = homeOf(geometry, same);
    if (in.chunk != home.chunk || in.part != home.part) {
        replace(geometry, slot, same);
    }
}

void TinChunks::reshape(std::int32_t slot) {
    TinChunk& chunk = chunks_[static_cast<std::size_t>(inChunk_[static_cast<std::size_t>(slot)].chunk)];
    chunk.reshaped = chunk.partsReshaped = true;
}

void TinChunks::leaveChunk(std::int32_t slot) {
    InChunk& in = inChunk_[static_cast<std::size_t>(slot)];
    TinChunk& chunk = chunks_[static_cast<std::size_t>(in.chunk)];
    const std::int32_t last = chunk.slots.back();
    chunk.slots[static_cast<std::size_t>(in.at)] = last;
    inChunk_[static_cast<std::size_t>(last)].at = in.at;
    chunk.slots.pop_back();
    chunk.changed = chunk.reshaped = chunk.partsReshaped = true;
    in = {};
}

bool TinChunks::settle(const shapes::TinGeometry& geometry, TinChunk& chunk) {
    if (!chunk.changed) {
        return false;
    }
    std::vector<Ordered> order;
    order.reserve(chunk.slots.size());
    for (const std::int32_t slot : chunk.slots) {
        order.push_back({inChunk_[static_cast<std::size_t>(slot)].part, geometry.triangle(slot).corner, slot});
    }
    std::ranges::sort(order);
    for (std::size_t i = 0; i < order.size(); ++i) {
        chunk.slots[i] = order[i].slot;
        inChunk_[static_cast<std::size_t>(chunk.slots[i])].at = static_cast<int>(i);
    }
    chunk.changed = false;
    return true;
}

const std::vector<TinChunk::Part>& TinChunks::partsOf(const shapes::TinGeometry& geometry, TinChunk& chunk) const {
    if (chunk.partsReshaped) {
        chunk.parts.clear();
        int last = -1;
        for (std::size_t i = 0; i < chunk.slots.size(); ++i) {
            const shapes::TinTriangle& one = geometry.triangle(chunk.slots[i]);
            const int number = inChunk_[static_cast<std::size_t>(chunk.slots[i])].part;
            const shapes::Box box = geometry.boxOf(one);
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

const shapes::Box& TinChunks::boxOf(const shapes::TinGeometry& geometry, TinChunk& chunk) {
    if (chunk.reshaped) {
        chunk.box = geometry.boxOf(geometry.triangle(chunk.slots.front()));
        for (const std::int32_t slot : chunk.slots) {
            chunk.box = around(chunk.box, geometry.boxOf(geometry.triangle(slot)));
        }
        chunk.reshaped = false;
    }
    return chunk.box;
}

shapes::Box TinChunks::withChunksAt(const shapes::TinGeometry& geometry, const shapes::Box& box) {
    shapes::Box all = box;
    for (TinChunk& chunk : chunks_) {
        if (!chunk.slots.empty() && overlapOnGround(boxOf(geometry, chunk), box)) {
            all = around(all, boxOf(geometry, chunk));
        }
    }
    return all;
}

}  // namespace render_node
