// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "sand/tin/mesh/neighbourhood.hpp"
#include "sand/tin/volume/vertex_sand.hpp"

namespace sand::tin {

/// Rules that decide how fine a TIN is while the session runs. They follow from the Settings of the TinStart. With all
/// rules 0, only the tool's outline changes the mesh.
struct DetailRules {
    std::int32_t spacing = 0;            // lattice of vertices that is added at the tool [probe unit]; 0: no lattice
    double maxError = 0;                 // largest change of the surface by one removal [unit]; 0: no removals
    Vertex firstToGo = 0;                // vertices with smaller numbers stay
    std::int32_t removals = 0;           // most removals per step
    std::int32_t maxVertices = 1 << 22;  // limit for refinement and outlines
    bool keepsConstraints = false;       // whether the constraints of a tool stay after it has left
    bool keepsRim = true;                // whether vertices on the rim stay, as those of an open rim do
};

/// Edges near which new vertices would make slivers.
using Edges = std::vector<std::pair<LatticePoint, LatticePoint>>;

/// Adds a vertex in the middle of each square of the lattice in `box` that fulfils three conditions. `wanted` must be
/// true for the middle. The square must contain no place of `there`. The middle must be at least a quarter of the
/// spacing away from all `edges`.
///
/// Goes from square to square, beginning in the south-west, until the mesh has rules.maxVertices. Returns the number
/// of added vertices.
int refine(Mesh& mesh, const DetailRules& rules, const Box& box, const std::function<bool(const LatticePoint&)>& wanted,
           std::span<const LatticePoint> there, const Edges& edges);

/// Adds a vertex on the field's rim beside the middle of each square that reaches the rim within `box`. `wanted` must
/// be true for the place on the rim. The square's part of the rim must contain no place of `there`. Stops when the
/// mesh has rules.maxVertices. Returns the number of added vertices. Without vertices on the rim, sand would neither
/// fall over an open rim nor lie against a closed one as in a mirror.
int refineRim(Mesh& mesh, const DetailRules& rules, const Box& box,
              const std::function<bool(const LatticePoint&)>& wanted, std::span<const LatticePoint> there);

/// Does the same on the borders of the mesh's holes, at least a quarter of the spacing away from their corners.
int refineHoles(Mesh& mesh, const DetailRules& rules, const Box& box,
                const std::function<bool(const LatticePoint&)>& wanted, std::span<const LatticePoint> there);

}  // namespace sand::tin
