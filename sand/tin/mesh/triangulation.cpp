// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/mesh/triangulation.hpp"

#include <algorithm>
#include <functional>

#include "sand/tin/mesh/predicates.hpp"

namespace sand::tin {

Triangulation::Triangulation(std::int32_t width, std::int32_t depth, std::shared_ptr<const Holes> holes)
    : holes_(std::move(holes)) {
    mesh_.width = width;
    mesh_.depth = depth;
    mesh_.places = {{0, 0}, {width, 0}, {width, depth}, {0, depth}};
    mesh_.triangleAt = {0, 0, 0, 1};
    const std::int32_t south = newSlot();
    const std::int32_t north = newSlot();
    // The four corners lie on a circle, so that the diagonal begins at the first one.
    triangle(north).corner = {0, 2, 3};
    put(south, {0, 1, 2}, {{{kNoNumber, true}, {north, false}, {kNoNumber, true}}});
    put(north, {0, 2, 3}, {{{kNoNumber, true}, {kNoNumber, true}, {south, false}}});
}

Vertex Triangulation::takeNumber() {
    if (freeNumbers_.empty()) {
        mesh_.places.emplace_back();
        mesh_.triangleAt.push_back(kNoNumber);
        return static_cast<Vertex>(mesh_.places.size()) - 1;
    }
    std::pop_heap(freeNumbers_.begin(), freeNumbers_.end(), std::greater<>());
    const Vertex number = freeNumbers_.back();
    freeNumbers_.pop_back();
    return number;
}

void Triangulation::giveBack(Vertex number) {
    freeNumbers_.push_back(number);
    std::push_heap(freeNumbers_.begin(), freeNumbers_.end(), std::greater<>());
}

void Triangulation::reserveNumbers(std::size_t count) {
    mesh_.places.resize(count);
    mesh_.triangleAt.resize(count, kNoNumber);
}

void Triangulation::reserve(std::size_t vertices) {
    // Grows by at least half. Otherwise each of many small batches would copy the whole array.
    const auto grow = [](auto& all, std::size_t more) {
        if (all.capacity() - all.size() < more) {
            all.reserve(all.size() + std::max(more, all.size() / 2));
        }
    };
    grow(mesh_.places, vertices);
    grow(mesh_.triangleAt, vertices);
    grow(mesh_.triangles, 2 * vertices);
    changes.reserve(mesh_.triangles.capacity());
    differences.reserve(mesh_.triangles.capacity());
}

void Triangulation::touch(std::int32_t slot) {
    changes.touch(slot, mesh_);
    if (noteDifferences) {
        differences.touch(slot, mesh_);
    }
}

std::int32_t Triangulation::newSlot() {
    std::int32_t slot = 0;
    if (freeSlots_.empty()) {
        slot = static_cast<std::int32_t>(mesh_.triangles.size());
        mesh_.triangles.emplace_back();
    } else {
        slot = freeSlots_.back();
        freeSlots_.pop_back();
    }
    touch(slot);
    return slot;
}

void Triangulation::bury(std::int32_t slot) {
    touch(slot);
    triangle(slot) = Triangle();
    freeSlots_.push_back(slot);
}

Triangulation::Outer Triangulation::outer(const Side& side) const {
    const Triangle& here = triangle(side.slot);
    return {here.neighbour[side.opposite], here.constrained[side.opposite]};
}

void Triangulation::put(std::int32_t slot, const std::array<Vertex, 3>& corners, const std::array<Outer, 3>& sides) {
    touch(slot);
    Triangle& here = triangle(slot);
    here.corner = corners;
    here.hole = holes_ != nullptr && holes_->holds(place(corners[0]), place(corners[1]), place(corners[2]));
    for (std::size_t i = 0; i < 3; ++i) {
        here.neighbour[i] = sides[i].neighbour;
        here.constrained[i] = sides[i].constrained;
        mesh_.triangleAt[static_cast<std::size_t>(corners[i])] = slot;
        if (sides[i].neighbour != kNoNumber) {
            Triangle& there = triangle(sides[i].neighbour);
            // In the neighbour, the common side begins at the end of our side. It lies opposite the corner before that
            // one.
            there.neighbour[previous(cornerOf(there, corners[previous(i)]))] = slot;
        }
    }
    last_ = slot;
}

void Triangulation::makeHole(std::int32_t slot) {
    touch(slot);
    triangle(slot).hole = true;
}

void Triangulation::setConstrained(const Side& side, bool constrained) {
    touch(side.slot);
    triangle(side.slot).constrained[side.opposite] = constrained;
    const Side there = beyond(side);
    if (there.slot != kNoNumber) {
        touch(there.slot);
        triangle(there.slot).constrained[there.opposite] = constrained;
    }
}

VertexPair Triangulation::ends(const Side& side) const {
    const Triangle& here = triangle(side.slot);
    return {here.corner[next(side.opposite)], here.corner[previous(side.opposite)]};
}

Side Triangulation::beyond(const Side& side) const {
    const std::int32_t slot = triangle(side.slot).neighbour[side.opposite];
    if (slot == kNoNumber) {
        return {};
    }
    return {slot, previous(cornerOf(triangle(slot), ends(side).second))};
}

bool Triangulation::isWrong(const Side& side) const {
    const Triangle& here = triangle(side.slot);
    if (here.constrained[side.opposite]) {
        return false;
    }
    const auto [b, c] = ends(side);
    const Side there = beyond(side);
    return mustFlip(place(here.corner[side.opposite]), place(b), place(c),
                    place(triangle(there.slot).corner[there.opposite]));
}

Side Triangulation::findEdge(Vertex a, Vertex b) const {
    Side found;
    around(a, [&](const Side& side) {
        // `side` ends in the next corner. On the rim, the last edge of the fan ends in the corner before the vertex.
        const Triangle& here = triangle(side.slot);
        if (here.corner[previous(side.opposite)] == b) {
            found = side;
        } else if (here.corner[side.opposite] == b) {
            found = {side.slot, previous(side.opposite)};
        }
        return found.slot != kNoNumber;
    });
    return found;
}

bool Triangulation::isOutline(const Side& side) const {
    if (holes_ == nullptr || onRim(side) || !isConstrained(side)) {
        return false;
    }
    const auto [a, b] = ends(side);
    return holes_->borders(place(a), place(b));
}

std::vector<Vertex> Triangulation::outlineFrom(Vertex vertex) const {
    std::vector<Vertex> others;
    if (holes_ != nullptr) {
        for (const Vertex other : link(vertex)) {
            if (isOutline(findEdge(vertex, other))) {
                others.push_back(other);
            }
        }
    }
    return others;
}

Vertex Triangulation::nextAlong(Vertex vertex, const LatticePoint& to) const {
    const LatticePoint& from = place(vertex);
    for (const Vertex other : link(vertex)) {
        const LatticePoint& there = place(other);
        const auto isBetween = [](std::int32_t a, std::int32_t b, std::int32_t c) {
            return std::min(a, c) <= b && b <= std::max(a, c);
        };
        if (doubledArea(from, there, to) == 0 && isBetween(from.x, there.x, to.x) && isBetween(from.y, there.y, to.y) &&
            isConstrained(findEdge(vertex, other))) {
            return other;
        }
    }
    return kNoNumber;
}

void Triangulation::findStar(Vertex centre, Star& star) const {
    // First go back to the rim, if there is one, and then around the vertex.
    const std::int32_t start = mesh_.triangleAt[static_cast<std::size_t>(centre)];
    std::int32_t first = start;
    for (std::int32_t before = start; before != kNoNumber;) {
        first = before;
        before = triangle(first).neighbour[previous(cornerOf(triangle(first), centre))];
        if (before == start) {
            break;
        }
    }
    star.slots.clear();
    star.others.clear();
    Vertex last = kNoNumber;
    std::int32_t slot = first;
    do {
        const Triangle& here = triangle(slot);
        const std::size_t corner = cornerOf(here, centre);
        star.slots.push_back(slot);
        star.others.push_back(here.corner[next(corner)]);
        last = here.corner[previous(corner)];
        slot = here.neighbour[next(corner)];
    } while (slot != kNoNumber && slot != first);
    if (slot == kNoNumber) {
        star.others.push_back(last);
    }
}

std::vector<Vertex> Triangulation::link(Vertex centre) const {
    Star star;
    findStar(centre, star);
    return star.others;
}

void Triangulation::flip(const Side& side) {
    const Side there = beyond(side);
    const std::int32_t s = side.slot;
    const std::int32_t t = there.slot;
    const Vertex a = triangle(s).corner[side.opposite];
    const Vertex d = triangle(t).corner[there.opposite];
    const auto [b, c] = ends(side);
    const Outer ca = outer({s, next(side.opposite)});
    const Outer ab = outer({s, previous(side.opposite)});
    const Outer bd = outer({t, next(there.opposite)});
    const Outer dc = outer({t, previous(there.opposite)});
    touch(t);
    triangle(t).corner = {a, d, c};  // the first put() looks in it for their common edge
    put(s, {a, b, d}, {{bd, {t, false}, ab}});
    put(t, {a, d, c}, {{dc, ca, {s, false}}});
}

void Triangulation::split(std::int32_t slot, Vertex vertex) {
    const auto [a, b, c] = triangle(slot).corner;
    const Outer bc = outer({slot, 0});
    const Outer ca = outer({slot, 1});
    const Outer ab = outer({slot, 2});
    const std::int32_t second = newSlot();
    const std::int32_t third = newSlot();
    touch(slot);
    triangle(slot).corner = {vertex, b, c};
    triangle(second).corner = {vertex, c, a};
    triangle(third).corner = {vertex, a, b};
    put(slot, {vertex, b, c}, {{bc, {second, false}, {third, false}}});
    put(second, {vertex, c, a}, {{ca, {third, false}, {slot, false}}});
    put(third, {vertex, a, b}, {{ab, {slot, false}, {second, false}}});
    stack_ = {slot, second, third};
}

void Triangulation::splitSide(const Side& side, Vertex vertex) {
    const Side there = beyond(side);
    const std::int32_t s = side.slot;
    const std::int32_t t = there.slot;
    const Vertex a = triangle(s).corner[side.opposite];
    const auto [b, c] = ends(side);
    const bool constrained = isConstrained(side);
    const Outer ca = outer({s, next(side.opposite)});
    const Outer ab = outer({s, previous(side.opposite)});
    const std::int32_t s2 = newSlot();
    if (t == kNoNumber) {
        touch(s);
        triangle(s).corner = {vertex, a, b};
        triangle(s2).corner = {vertex, c, a};
        put(s, {vertex, a, b}, {{ab, {kNoNumber, constrained}, {s2, false}}});
        put(s2, {vertex, c, a}, {{ca, {s, false}, {kNoNumber, constrained}}});
        stack_ = {s, s2};
        return;
    }
    const Vertex d = triangle(t).corner[there.opposite];
    const Outer bd = outer({t, next(there.opposite)});
    const Outer dc = outer({t, previous(there.opposite)});
    const std::int32_t t2 = newSlot();
    touch(s);
    touch(t);
    triangle(s).corner = {vertex, a, b};
    triangle(s2).corner = {vertex, c, a};
    triangle(t).corner = {vertex, b, d};
    triangle(t2).corner = {vertex, d, c};
    put(s, {vertex, a, b}, {{ab, {t, constrained}, {s2, false}}});
    put(s2, {vertex, c, a}, {{ca, {s, false}, {t2, constrained}}});
    put(t, {vertex, b, d}, {{bd, {t2, false}, {s, constrained}}});
    put(t2, {vertex, d, c}, {{dc, {s2, constrained}, {t, false}}});
    stack_ = {s, s2, t, t2};
}

void Triangulation::improveAround(Vertex vertex) {
    while (!stack_.empty()) {
        const std::int32_t slot = stack_.back();
        stack_.pop_back();
        const Side side{slot, cornerOf(triangle(slot), vertex)};
        if (isWrong(side)) {
            const std::int32_t other = beyond(side).slot;
            flip(side);
            stack_.push_back(slot);
            stack_.push_back(other);
        }
    }
}

void Triangulation::improve(std::vector<VertexPair>& suspects) {
    while (!suspects.empty()) {
        const auto [a, b] = suspects.back();
        suspects.pop_back();
        const Side side = findEdge(a, b);
        if (side.slot == kNoNumber || !isWrong(side)) {
            continue;
        }
        const Side there = beyond(side);
        const auto [c, d] = ends(side);
        const Vertex apex = triangle(side.slot).corner[side.opposite];
        const Vertex other = triangle(there.slot).corner[there.opposite];
        flip(side);
        suspects.insert(suspects.end(), {{apex, c}, {c, other}, {other, d}, {d, apex}});
    }
}

std::size_t cornerAt(const Located& located) {
    std::size_t corner = 3;
    for (std::size_t i = 0; i < 3; ++i) {
        if (located.weights[next(i)] == 0 && located.weights[previous(i)] == 0) {
            corner = i;
        }
    }
    return corner;
}

VertexPair Triangulation::edgeAt(const Located& located) const {
    const auto* zero = std::find(located.weights.begin(), located.weights.end(), 0);
    if (zero == located.weights.end() || cornerAt(located) < 3) {
        return {kNoNumber, kNoNumber};
    }
    return ends({located.triangle, static_cast<std::size_t>(zero - located.weights.begin())});
}

Vertex Triangulation::insertAt(const Located& located, const LatticePoint& place, Vertex number) {
    last_ = located.triangle;
    if (const std::size_t corner = cornerAt(located); corner < 3) {
        return triangle(located.triangle).corner[corner];
    }
    if (number == kNoNumber) {
        number = takeNumber();
    }
    mesh_.places[static_cast<std::size_t>(number)] = place;
    ++vertexCount_;
    const auto* zero = std::find(located.weights.begin(), located.weights.end(), 0);
    if (zero == located.weights.end()) {
        split(located.triangle, number);
    } else {
        splitSide({located.triangle, static_cast<std::size_t>(zero - located.weights.begin())}, number);
    }
    improveAround(number);
    return number;
}

}  // namespace sand::tin
