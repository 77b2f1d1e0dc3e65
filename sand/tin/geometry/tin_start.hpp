// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "base/byte_stream.hpp"
#include "sand/tin/geometry/holes.hpp"
#include "sand/tin/geometry/triangles.hpp"

namespace sand::tin {

/// A field's nominal cells, with a sample in the middle of each.
[[nodiscard]] Cells nominalCells(std::int32_t width, std::int32_t depth /* [probe unit] */);

/// Heights up to this have volumes that fit, wherever the vertices lie on so many nominal cells [unit].
[[nodiscard]] double mostHeight(int columns, int rows);

inline constexpr std::uint32_t kMostPlaces = 1 << 24;  // of a start

/// How finely a TIN follows its terrain and its tools; part of what a scene computes with.
struct Settings {
    std::int32_t spacing = kLatticePerCell;  // [probe unit], between the points a tool puts into the sand
    std::int32_t widest = 0;                 // [probe unit], between points at the start; 0: as far as they like
    std::int32_t maxError = 1 << 12;         // [unit], by which coarsening may move the surface
    std::int32_t mostVertices = 1 << 18;     // the start has no more, and refinement stops there
    bool keepConstraints = false;            // of a tool that has left
    friend bool operator==(const Settings&, const Settings&) = default;
};

/// The TIN a session starts with: vertices, their heights, and edges that must be there. Its vertices stay; those that
/// a tool has put between them may go again. Computed once by whoever loads
/// the scene; every replica triangulates it alike.
struct TinStart {
    std::int32_t width = 0, depth = 0;  // [probe unit]; the first four places are the corners, as Mesh's
    std::vector<Place> places;
    std::vector<std::int32_t> heights;                   // [unit], by place
    std::vector<std::pair<Vertex, Vertex>> constraints;  // each with the smaller first
    std::int32_t meanHeight = 0;                         // [unit], under the surface: where devices hover
    std::shared_ptr<const Holes> holes;                  // nominal cells without data; null when all have some
    Settings settings;

    void encode(base::ByteWriter& writer) const;
    /// Throws base::FormatError for bytes that are none: places beside the field or twice, edges of nobody, holes out
    /// of order or on cells that are not whole.
    static TinStart decode(base::ByteReader& reader);
    /// Equal digests mean equal sand from equal steps; never 0.
    [[nodiscard]] std::uint64_t digest() const;
};

}  // namespace sand::tin
