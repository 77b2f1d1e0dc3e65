// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sand/tin/mesh/neighbourhood.hpp"
#include "sand/tin/refine/refinement.hpp"
#include "sand/tin/volume/vertex_sand.hpp"

namespace sand::tin {

/// Takes out vertices where the surface is flat again: those with no constraint and not on the rim, in order of number
/// from `next` on, which goes round; at most rules.removals, of sixteen times as many that are looked at.
///
/// One goes when all around it and itself lie so near to one plane that neither the other triangles nor the remap
/// moves the surface anywhere by more than maxError. The sand stays, to the last unit; errors of removals one after
/// the other add up. `keepOut`: where the tool works. Returns how many went.
int coarsen(VertexSand& layer, const DetailRules& rules, Vertex& next, const Box& keepOut);

/// The same, step by step, and nobody is looked at again around whom nothing has changed since it was in vain: most of
/// what has been dug is too rough for good. What it knows is no state: without it a step does and leaves the same, as
/// long as it is told of all that changes and, until it forgets, asked with one layer and one maxError. Not
/// thread-safe.
class Coarsening {
public:
    /// As Mesh's.
    void reserve(std::size_t vertices) { known_.reserve(vertices); }
    /// These have another height.
    void touch(const Triangles& mesh, std::span<const Vertex> vertices);
    /// The mesh is another there, and some heights too. What step() takes out it knows itself.
    void touch(const Triangles& mesh, const Mesh::Change& change);
    void forget() { known_.clear(); }
    int step(VertexSand& layer, const DetailRules& rules, Vertex& next, const Box& keepOut);

private:
    void lookAgain(const Triangle& triangle);

    // Bits by vertex; a vertex beyond its end has none. Where a vertex within the field has kNoneInVain, neither it nor
    // any around it has kInVain. On the rim, where nobody can go, that may not hold; and it outlasts a vertex, for one
    // that comes back has triangles that are all new.
    static constexpr std::uint8_t kInVain = 1;  // it could not go, and nothing around has changed since
    static constexpr std::uint8_t kNoneInVain = 2;
    std::vector<std::uint8_t> known_;
};

}  // namespace sand::tin
