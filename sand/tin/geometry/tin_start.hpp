// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/field_forms.hpp"
#include "sand/model/units.hpp"
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
    std::vector<LatticePoint> places;                    // the first four are the corners, in the order of Mesh
    std::vector<std::int32_t> heights;                   // by place [unit]
    std::vector<std::pair<Vertex, Vertex>> constraints;  // each with the smaller vertex first
    std::int32_t meanHeight = 0;                         // of the surface [unit]; devices hover above it
    std::shared_ptr<const Holes> holes;                  // nominal cells without data; null if all cells have data
    Settings settings;

    void encode(base::ByteWriter& writer) const;
    /// Throws base::FormatError if the bytes are not a TinStart.
    static TinStart decode(base::ByteReader& reader);

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit);
    /// Returns which vertices or constraints are impossible, or an empty text. Examples are a place outside the field,
    /// two vertices in one place, heights whose volumes could exceed kMostSand, and a constraint between vertices out
    /// of order.
    [[nodiscard]] std::string refusal() const;
    /// Returns the most vertices that a replica of this start ever has. Refinement stops at Settings::mostVertices. The
    /// surplus is for vertices where the outline of a tool crosses constraints.
    [[nodiscard]] std::size_t mostVertices() const;
    /// Returns a number that is never 0. Equal digests mean that equal steps lead to equal sand.
    [[nodiscard]] std::uint64_t digest() const;
};

/// Form of the vertices of a start: their number, then place and height of each.
template <class Start>
struct StartVertices {
    Start& start;
    void put(base::ByteWriter& writer) const {
        base::putMember(writer, static_cast<std::uint64_t>(start.places.size()));
        for (std::size_t i = 0; i < start.places.size(); ++i) {
            base::putMember(writer, start.places[i].x);
            base::putMember(writer, start.places[i].y);
            base::putMember(writer, start.heights[i]);
        }
    }
    void get(base::ByteReader& reader) const requires(!std::is_const_v<Start>) {
        const auto count = base::read<std::uint64_t>(reader);
        if (count > kMostPlaces) {
            throw base::FormatError("are " + std::to_string(count) + "; at most " + std::to_string(kMostPlaces) +
                                    " are allowed");
        }
        start.places.clear();
        start.heights.clear();
        for (std::uint64_t i = 0; i < count; ++i) {
            LatticePoint& place = start.places.emplace_back();
            base::getMember(reader, place.x);
            base::getMember(reader, place.y);
            base::getMember(reader, start.heights.emplace_back());
        }
    }
};

/// Returns the holes of `start` that consist of `runs`. Throws base::FormatError if they are out of order or out of the
/// field, or if the field has cells that are not whole.
[[nodiscard]] std::shared_ptr<const Holes> holesOf(const TinStart& start, std::vector<Holes::Run> runs);

/// Form of the holes of a start that has holes.
template <class Start>
struct StartHoles {
    Start& start;
    void put(base::ByteWriter& writer) const {
        base::upTo<std::uint64_t>(start.holes->runs(), kMostPlaces).put(writer);
    }
    void get(base::ByteReader& reader) const requires(!std::is_const_v<Start>) {
        std::vector<Holes::Run> runs;
        base::upTo<std::uint64_t>(runs, kMostPlaces).get(reader);
        start.holes = holesOf(start, std::move(runs));
    }
};

template <class Self, class Visit>
void TinStart::fields(Self& it, Visit& visit) {
    constexpr std::int32_t kLongest = kMaxSide * kLatticePerCell;
    visit("width", base::limited(it.width, 1, kLongest));
    visit("depth", base::limited(it.depth, 1, kLongest));
    visit("mean_height", base::limited(it.meanHeight, -kMaxHeight, kMaxHeight));
    visit("spacing", base::limited(it.settings.spacing, 1, kLongest));
    visit("widest", base::limited(it.settings.widest, 0, kLongest));
    visit("max_error", base::limited(it.settings.maxError, 0, kMaxHeight));
    visit("most_vertices", base::limited(it.settings.mostVertices, 4, std::int32_t{kMostPlaces}));
    bool hasHoles = it.holes != nullptr;
    visit("keeps_constraints", base::flags<std::int32_t>(it.settings.keepConstraints, hasHoles));
    visit("vertices", StartVertices<Self>{it});
    visit("constraints", base::upTo<std::uint64_t>(it.constraints, kMostPlaces));
    if (hasHoles) {
        visit("holes", StartHoles<Self>{it});
    }
}

}  // namespace sand::tin
