// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sand/tin/mesh/neighbourhood.hpp"
#include "sand/tin/refine/refinement.hpp"
#include "sand/tin/volume/vertex_sand.hpp"

namespace sand::tin {

/// Removes vertices where the surface is flat again. Examines vertex numbers in ascending order, cyclically from
/// `next` on. Vertices with a constraint, on the border of a hole or in `keepOut` stay, and with rules.keepsRim, those
/// on the rim; `keepOut` is the area in which the tool works. Removes at most rules.removals vertices, and examines at
/// most sixteen times as many. Returns the number of removed vertices.
///
/// A vertex is removed if it and its neighbours are close to one plane. They must be so close that the other triangles
/// and the remap move the surface nowhere by more than rules.maxError. The volume stays exact. The errors of
/// successive removals add up.
int coarsen(VertexSand& layer, const DetailRules& rules, Vertex& next, const Box& keepOut);

/// Does the work of coarsen() in steps, and skips a vertex whose removal has failed until something around it changes.
/// Most sand that a tool has dug stays too rough for removals.
///
/// The object's memory is not part of the state, because a step has the same result without it. This holds if touch()
/// is called for every change, and if layer and maxError stay the same until forget(). Not thread-safe.
class Coarsening {
public:
    /// Reserves memory for `vertices` vertices in all.
    void reserve(std::size_t vertices) { known_.reserve(vertices); }
    /// Call this after the heights of `vertices` have changed.
    void touch(const Triangles& mesh, std::span<const Vertex> vertices);
    /// Call this after the mesh or heights have changed, also for the removals of step().
    void touch(const Triangles& mesh, const Mesh::Change& change);
    void forget() {
        known_.clear();
        looked_ = 0;
        done_ = false;
    }
    /// Does the work of one call of coarsen(). Returns the number of removed vertices.
    int step(VertexSand& layer, const DetailRules& rules, Vertex& next, const Box& keepOut);
    /// Returns whether step() has examined every vertex since the last change, and could remove none.
    [[nodiscard]] bool done() const { return done_; }

private:
    /// Makes step() examine the corners of a triangle again.
    void lookAgain(const Triangle& triangle);

    // Bits by vertex; a vertex beyond the end has none. If a vertex has kNoneFailed, neither it nor a vertex around it
    // has kFailed. The bits outlast their vertex. This does no harm, because a vertex that comes back has only new
    // triangles.
    static constexpr std::uint8_t kFailed = 1;  // removal failed, and nothing around the vertex has changed since
    static constexpr std::uint8_t kNoneFailed = 2;
    std::vector<std::uint8_t> known_;
    std::int64_t looked_ = 0;  // vertices that step() has examined since the last change
    bool done_ = false;
};

}  // namespace sand::tin
