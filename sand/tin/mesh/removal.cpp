// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/mesh/triangulation.hpp"

namespace sand::tin {

bool Triangulation::isConvex(const Side& side) const {
    const Side there = beyond(side);
    const auto [b, c] = ends(side);
    const Vertex a = triangle(side.slot).corner[side.opposite];
    const Vertex d = triangle(there.slot).corner[there.opposite];
    return area(a, b, d) > 0 && area(a, d, c) > 0;
}

/// Releases all constraints that end in the vertex, except those on the rim. `star_` must be the vertex's star, and is
/// its star afterwards.
void Triangulation::releaseAll(Vertex vertex) {
    held_.clear();
    for (std::size_t i = 0; i < star_.slots.size(); ++i) {
        const Triangle& here = triangle(star_.slots[i]);
        if (here.constrained[previous(cornerOf(here, vertex))]) {
            held_.push_back(star_.others[i]);
        }
    }
    for (const Vertex other : held_) {
        release(vertex, other);
    }
    if (!held_.empty()) {
        findStar(vertex, star_);
    }
}

/// Flips edges away from the vertex until merge() can remove it. Adds the edges that this creates to `made_`.
/// The polygon around the vertex has two ears that do not overlap. A flip can cut off an ear unless the vertex lies in
/// the ear or on its diagonal. With more than three edges at the vertex, that is so for at most one ear. The exception
/// is a vertex with four edges, two of them in a straight line.
void Triangulation::reduce(Vertex vertex) {
    std::vector<Vertex>& others = star_.others;
    const std::size_t rim = star_.atRim() ? 1 : 0;
    for (bool cut = true; cut && others.size() > 3;) {
        cut = false;
        for (std::size_t i = rim; i + rim < others.size() && others.size() > 3;) {
            const Side spoke = findEdge(vertex, others[i]);
            if (!isConvex(spoke)) {
                ++i;
                continue;
            }
            const std::size_t count = others.size();
            made_.emplace_back(others[(i + count - 1) % count], others[(i + 1) % count]);
            flip(spoke);
            others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
            cut = true;
        }
    }
}

/// Removes a vertex that has three neighbours. Also removes one that has four and lies on the line between two of
/// them; it then adds the edge between these two to `made_`.
void Triangulation::merge(Vertex vertex) {
    findStar(vertex, star_);
    const std::vector<std::int32_t>& slots = star_.slots;
    const std::vector<Vertex>& o = star_.others;
    // outside[i] lies beyond the edge from o[i] to o[i + 1]. A vertex on the rim may have three neighbours and two
    // triangles. Then outside[2] lies beyond the rim edge that replaces the vertex's two rim edges.
    std::array<Outer, 4> outside{};
    outside.fill({kNoNumber, true});
    for (std::size_t i = 0; i < slots.size(); ++i) {
        outside.at(i) = outer({slots[i], cornerOf(triangle(slots[i]), vertex)});
    }
    if (o.size() == 3) {
        put(slots[0], {o[0], o[1], o[2]}, {{outside[1], outside[2], outside[0]}});
    } else {
        const std::size_t i = area(o[0], vertex, o[2]) == 0 ? 0 : 1;
        const std::size_t j = i + 1, k = i + 2, l = (i + 3) % 4;
        touch(slots[1]);
        triangle(slots[1]).corner = {o[i], o[k], o[l]};
        put(slots[0], {o[i], o[j], o[k]}, {{outside[j], {slots[1], false}, outside[i]}});
        put(slots[1], {o[i], o[k], o[l]}, {{outside[k], outside[l], {slots[0], false}}});
        made_.emplace_back(o[i], o[k]);
    }
    for (std::size_t spare = o.size() == 3 ? 1 : 2; spare < slots.size(); ++spare) {
        bury(slots[spare]);
    }
}

void Triangulation::remove(Vertex vertex) {
    findStar(vertex, star_);
    releaseAll(vertex);
    made_.clear();
    reduce(vertex);
    merge(vertex);
    mesh_.triangleAt[static_cast<std::size_t>(vertex)] = kNoNumber;
    --vertexCount_;
    giveBack(vertex);
    improve(made_);
}

void Triangulation::release(Vertex a, Vertex b) {
    const Side side = findEdge(a, b);
    if (side.slot == kNoNumber || onRim(side) || !isConstrained(side)) {
        return;
    }
    setConstrained(side, false);
    made_.assign({{a, b}});
    improve(made_);
}

}  // namespace sand::tin
