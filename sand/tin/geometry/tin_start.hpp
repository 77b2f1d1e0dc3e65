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

/// Returns the nominal cells of a field, with a sample in the middle of each.
[[nodiscard]] Cells nominalCells(std::int32_t width, std::int32_t depth /* [probe unit] */);

/// Returns the largest height whose volumes fit in a TIN of `columns` × `rows` nominal cells, wherever its vertices
/// are [unit].
[[nodiscard]] double mostHeight(int columns, int rows);

inline constexpr std::uint32_t kMostPlaces = 1 << 24;  // most vertices of a start

/// Largest sum of the magnitudes of all volumes of a TIN [unit · probe unit² / 6]. It is a little below 2^62. Volume,
/// outflow, and their sum therefore fit in 64 bits.
inline constexpr std::int64_t kMostSand = 4'600'000'000'000'000'000;

/// Settings that decide how finely a TIN follows its terrain and its tools. The state of the sand depends on these
/// settings.
struct Settings {
    std::int32_t spacing = kLatticePerCell;  // distance of the points that a tool puts into the sand [probe unit]
    std::int32_t widest = 0;                 // largest distance of points at the start [probe unit]; 0: no limit
    std::int32_t maxError = 1 << 12;         // largest change of the surface by coarsening [unit]
    std::int32_t mostVertices = 1 << 18;     // limit for the start; refinement stops there
    bool keepConstraints = false;            // whether the constraints of a tool stay after it has left
    friend bool operator==(const Settings&, const Settings&) = default;
};

/// TIN that a session starts with: vertices, their heights, and edges that must be in the mesh. Its vertices stay.
/// Vertices that a tool adds between them can be removed again. The program that loads the scene computes the start
/// once. Every replica makes the same triangulation of it.
struct TinStart {
    std::int32_t width = 0, depth = 0;                   // size [probe unit]
    std::vector<Place> places;                           // the first four are the corners, in the order of Mesh
    std::vector<std::int32_t> heights;                   // by place [unit]
    std::vector<std::pair<Vertex, Vertex>> constraints;  // each with the smaller vertex first
    std::int32_t meanHeight = 0;                         // of the surface [unit]; devices hover above it
    std::shared_ptr<const Holes> holes;                  // nominal cells without data; null if all cells have data
    Settings settings;

    void encode(base::ByteWriter& writer) const;
    /// Throws base::FormatError if the bytes are not a TinStart. Examples are a place outside the field, two vertices
    /// in one place, and a constraint between vertices out of order. Other examples are holes out of order, holes in a
    /// field of cells that are not whole, and heights whose volumes could exceed kMostSand.
    static TinStart decode(base::ByteReader& reader);
    /// Returns the most vertices that a replica of this start ever has. Refinement stops at Settings::mostVertices. The
    /// surplus is for vertices where the outline of a tool crosses constraints.
    [[nodiscard]] std::size_t mostVertices() const;
    /// Returns a number that is never 0. Equal digests mean that equal steps lead to equal sand.
    [[nodiscard]] std::uint64_t digest() const;
};

}  // namespace sand::tin
