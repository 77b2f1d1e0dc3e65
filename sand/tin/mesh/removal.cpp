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

/// The vertex holds no constraint but the rim's any more. `star_` is its star, before and after.
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

/// Flips edges away from the vertex until merge() can take it out; the edges that come of it are added to `made_`.
///
/// The polygon around it has two ears that do not overlap. A flip cuts one off, unless the vertex lies in it or on its
/// diagonal: one ear at most when more than three edges go out, but for four of which two make a straight line.
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

/// Takes out a vertex with three neighbours, or with four of which it lies between two; the edge between them is added
/// to `made_`.
void Triangulation::merge(Vertex vertex) {
    findStar(vertex, star_);
    const std::vector<std::int32_t>& slots = star_.slots;
    const std::vector<Vertex>& o = star_.others;
    // From o[i] to o[i + 1]; of three on the rim the third is what its rim edges join to.
    std::array<Outer, 4> outside{};
    outside.fill({kNobody, true});
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
    mesh_.triangleAt[static_cast<std::size_t>(vertex)] = kNobody;
    --vertexCount_;
    giveBack(vertex);
    improve(made_);
}

void Triangulation::release(Vertex a, Vertex b) {
    const Side side = findEdge(a, b);
    if (side.slot == kNobody || onRim(side) || !isConstrained(side)) {
        return;
    }
    setConstrained(side, false);
    made_.assign({{a, b}});
    improve(made_);
}

}  // namespace sand::tin
