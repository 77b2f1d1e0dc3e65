// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "base/byte_stream.hpp"
#include "sand/tin/mesh/neighbourhood.hpp"
#include "sand/tin/volume/vertex_sand.hpp"

namespace sand::tin {

/// How fine a TIN is while the session runs; derived once by whoever loads the scene. All zeros: the mesh stays as it
/// is, but for the tool's outline.
struct DetailRules {
    std::int32_t spacing = 0;            // [probe unit], of the lattice that is put where the tool works; 0: none
    double maxError = 0;                 // [unit], by which one removal may change the surface; 0: nothing is removed
    Vertex firstToGo = 0;                // vertices of smaller numbers stay
    std::int32_t removals = 0;           // at most so many a step
    std::int32_t maxVertices = 1 << 22;  // refinement and outlines stop here
    bool keepsConstraints = false;       // of a tool that has left

    void encode(base::ByteWriter& writer) const;
    /// Throws base::FormatError for rules that no scene gives.
    static DetailRules decode(base::ByteReader& reader);
    friend bool operator==(const DetailRules&, const DetailRules&) = default;
};

/// Where new vertices would make slivers: near these edges.
using Edges = std::vector<std::pair<Place, Place>>;

/// Puts a vertex into the middle of every square of the lattice that `wanted` wants one in (told the middle), that
/// holds none of `there`, and whose middle is no nearer than a quarter of the spacing to an edge; square by square from
/// the south-west, until the mesh has maxVertices. Returns how many came.
int refine(Mesh& mesh, const DetailRules& rules, const Box& box, const std::function<bool(const Place&)>& wanted,
           std::span<const Place> there, const Edges& edges);

/// Puts a vertex on the field's rim beside the middle of every square that reaches it within the box, where `wanted`
/// wants one (told the place on the rim) and no part of the rim in that square holds any of `there`; until the mesh has
/// maxVertices. Returns how many came. For an open rim, over which sand falls where vertices are.
int refineRim(Mesh& mesh, const DetailRules& rules, const Box& box, const std::function<bool(const Place&)>& wanted,
              std::span<const Place> there);

}  // namespace sand::tin
