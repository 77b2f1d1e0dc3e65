// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "files/byte_stream.hpp"
#include "sand/tin/layer.hpp"
#include "sand/tin/window.hpp"

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

    void encode(files::ByteWriter& writer) const;
    /// Throws files::FormatError for rules that no scene gives.
    static DetailRules decode(files::ByteReader& reader);
    friend bool operator==(const DetailRules&, const DetailRules&) = default;
};

/// Where new vertices would make slivers: near these edges.
using Edges = std::vector<std::pair<Place, Place>>;

/// Puts a vertex into the middle of every square of the lattice that `wanted` wants one in (told the middle), that
/// holds none of `there`, and whose middle is no nearer than a quarter of the spacing to an edge; square by square from
/// the south-west, until the mesh has maxVertices. Returns how many came.
int refine(Mesh& mesh, const DetailRules& rules, const Box& box, const std::function<bool(const Place&)>& wanted,
           std::span<const Place> there, const Edges& edges);

/// Takes out vertices where the surface is flat again: those with no constraint and not on the rim, in order of number
/// from `next` on, which goes round; at most rules.removals, of sixteen times as many that are looked at.
///
/// One goes when all around it and itself lie so near to one plane that neither the other triangles nor the remap
/// moves the surface anywhere by more than maxError. The sand stays, to the last unit; errors of removals one after
/// the other add up. `keepOut`: where the tool works. Returns how many went.
int coarsen(Layer& layer, const DetailRules& rules, Vertex& next, const Box& keepOut);

/// The same, step by step, for nothing once all were looked at in vain and nothing has changed since. What it knows is
/// no state: without it a step does and leaves the same.
class Coarsening {
public:
    void wake() { inVain_ = 0; }  // mesh or sand are others now
    int step(Layer& layer, const DetailRules& rules, Vertex& next, const Box& keepOut);

private:
    std::int64_t inVain_ = 0;  // vertices looked at one after the other of which none could go
    Box keepOut_;
};

}  // namespace sand::tin
