// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/mesh/neighbourhood.hpp"

#include <array>
#include <bit>
#include <iterator>

namespace sand::tin {
namespace {

Box around(const std::array<LatticePoint, 3>& corners) {
    const auto& [a, b, c] = corners;
    return {std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})};
}

constexpr std::size_t kRoom = 1024;  // initial size [slot]
// Words per number up to which bits are used. Reading a word costs as much as a step of a sort.
constexpr std::size_t kWordsEach = 4;

bool overlap(const Box& a, const Box& b) { return a.x0 <= b.x1 && b.x0 <= a.x1 && a.y0 <= b.y1 && b.y0 <= a.y1; }

}  // namespace

void sortOnce(std::vector<std::int32_t>& numbers) {
    if (numbers.empty()) {
        return;
    }
    const auto [least, most] = std::minmax_element(numbers.begin(), numbers.end());
    const std::int32_t first = *least;
    const std::size_t words = static_cast<std::size_t>(*most - first) / 64 + 1;
    if (words > kWordsEach * numbers.size()) {
        std::sort(numbers.begin(), numbers.end());
        numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
        return;
    }
    std::vector<std::uint64_t> bits(words);
    for (const std::int32_t number : numbers) {
        const auto at = static_cast<std::size_t>(number - first);
        bits[at / 64] |= std::uint64_t{1} << at % 64;
    }
    std::size_t count = 0;
    for (std::size_t word = 0; word < words; ++word) {
        for (std::uint64_t rest = bits[word]; rest != 0; rest &= rest - 1) {
            numbers[count++] = first + static_cast<std::int32_t>(64 * word) + std::countr_zero(rest);
        }
    }
    numbers.resize(count);
}

// When a tool first touches the sand, no data are in a cache. Each triangle has the addresses of the next ones.
void Neighbourhood::fetchAhead(const Triangles& mesh, std::size_t next, std::size_t end) const {
    constexpr std::size_t kFar = 16, kNear = 8;  // [triangle], distance ahead of the search
    if (next + kFar < end) {
        __builtin_prefetch(&mesh.triangles[static_cast<std::size_t>(found_[next + kFar])]);
    }
    if (next + kNear < end) {
        const Triangle& soon = mesh.triangles[static_cast<std::size_t>(found_[next + kNear])];
        for (std::size_t k = 0; k < 3; ++k) {
            __builtin_prefetch(&mesh.places[static_cast<std::size_t>(soon.corner[k])]);
            seen_.fetchReserved(soon.neighbour[k]);
            __builtin_prefetch(&mesh.triangleAt[static_cast<std::size_t>(soon.corner[k])]);
        }
    }
}

// A box is convex, so that the triangles that reach into it are connected by their edges. The search continues through
// every triangle whose bounding box overlaps the box.
void Neighbourhood::look(const Triangles& mesh, const Box& wanted) {
    vertices_.clear();
    triangles_.clear();
    const Box box = box_ = wanted.clippedTo(mesh);
    if (box.empty()) {
        return;
    }
    seen_.clear();
    const LatticePoint middle{box.x0 + (box.x1 - box.x0) / 2, box.y0 + (box.y1 - box.y0) / 2};
    const auto slots = static_cast<std::int32_t>(mesh.triangles.size());
    const bool known = last_ >= 0 && last_ < slots && mesh.triangles[static_cast<std::size_t>(last_)].alive();
    last_ = locate(mesh, middle, known ? last_ : kNoNumber).triangle;
    seen_.reserve(mesh.triangles.size());
    seen_.insert(last_);
    // Writes every candidate, and counts it only if it is new. A branch would be slower, because the CPU could not
    // predict which of a triangle's neighbours are new.
    std::size_t end = 0, count = 0;
    const auto makeRoom = [](std::vector<std::int32_t>& all, std::size_t used) {
        if (all.size() < used + 3) {
            all.resize(2 * used + kRoom);
        }
    };
    makeRoom(found_, end);
    found_[end++] = last_;
    for (std::size_t next = 0; next < end; ++next) {
        fetchAhead(mesh, next, end);
        const std::int32_t slot = found_[next];
        const Triangle& triangle = mesh.triangles[static_cast<std::size_t>(slot)];
        const auto at = [&](std::size_t k) { return mesh.places[static_cast<std::size_t>(triangle.corner[k])]; };
        const std::array places{at(0), at(1), at(2)};
        if (!overlap(around(places), box)) {
            continue;
        }
        triangles_.push_back(slot);
        makeRoom(found_, end);
        makeRoom(vertices_, count);
        for (std::size_t k = 0; k < 3; ++k) {
            // Counts each vertex once, at the triangle of mesh.triangleAt. If the box contains the vertex, that
            // triangle reaches into the box, so that the search finds it.
            const bool own = mesh.triangleAt[static_cast<std::size_t>(triangle.corner[k])] == slot;
            vertices_[count] = triangle.corner[k];
            count += static_cast<std::size_t>(own) & static_cast<std::size_t>(box.holds(places[k]));
            if (triangle.neighbour[k] != kNoNumber) {
                found_[end] = triangle.neighbour[k];
                end += static_cast<std::size_t>(seen_.insertReserved(triangle.neighbour[k]));
            }
        }
    }
    vertices_.resize(count);
    sortOnce(vertices_);
}

void Neighbourhood::follow(const Triangles& mesh, const std::vector<Vertex>& changed) {
    triangles_.clear();
    stay_.clear();
    std::set_difference(vertices_.begin(), vertices_.end(), changed.begin(), changed.end(), std::back_inserter(stay_));
    come_.clear();
    std::copy_if(changed.begin(), changed.end(), std::back_inserter(come_), [&](Vertex vertex) {
        return mesh.alive(vertex) && box_.holds(mesh.places[static_cast<std::size_t>(vertex)]);
    });
    vertices_.clear();
    std::merge(stay_.begin(), stay_.end(), come_.begin(), come_.end(), std::back_inserter(vertices_));
}

void findLink(const Triangles& mesh, Vertex vertex, Link& link) {
    link.vertices.clear();
    link.constrained = link.bordered = false;
    const auto cornerOf = [&](std::int32_t slot) {
        const auto& corner = mesh.triangles[index(slot)].corner;
        return static_cast<std::size_t>(std::find(corner.begin(), corner.end(), vertex) - corner.begin());
    };
    const auto beside = [&](std::int32_t slot, std::size_t turn) {
        return mesh.triangles[index(slot)].neighbour[(cornerOf(slot) + turn) % 3];
    };
    const std::int32_t any = mesh.triangleAt[index(vertex)];
    std::int32_t first = any;  // on the rim, the first triangle counter-clockwise
    for (std::int32_t slot = beside(any, 2); slot != kNoNumber && slot != any; slot = beside(slot, 2)) {
        first = slot;
    }
    link.closed = beside(first, 2) != kNoNumber;
    first = link.closed ? any : first;
    std::int32_t slot = first;
    do {
        const Triangle& triangle = mesh.triangles[index(slot)];
        const std::size_t k = cornerOf(slot), after = (k + 1) % 3;
        link.vertices.push_back(triangle.corner[after]);
        const std::int32_t next = triangle.neighbour[after];
        if (triangle.constrained[after] && next != kNoNumber) {
            const bool border = triangle.hole != mesh.triangles[index(next)].hole;
            link.bordered = link.bordered || border;
            link.constrained = link.constrained || !border;
        }
        if (next == kNoNumber) {
            link.vertices.push_back(triangle.corner[(k + 2) % 3]);
        }
        slot = next;
    } while (slot != first && slot != kNoNumber);
    if (link.closed) {
        std::rotate(link.vertices.begin(), std::min_element(link.vertices.begin(), link.vertices.end()),
                    link.vertices.end());
    }
}

bool isNear(const LatticePoint& place, const LatticePoint& from, const LatticePoint& to, std::int32_t distance) {
    const auto squared = [](std::int64_t x, std::int64_t y) { return x * x + y * y; };
    const std::int64_t limit = std::int64_t{distance} * distance;
    const std::int64_t dx = std::int64_t{to.x} - from.x, dy = std::int64_t{to.y} - from.y;
    const std::int64_t px = std::int64_t{place.x} - from.x, py = std::int64_t{place.y} - from.y;
    const std::int64_t along = px * dx + py * dy, length = squared(dx, dy);
    if (along <= 0) {
        return squared(px, py) < limit;
    }
    if (along >= length) {
        return squared(px - dx, py - dy) < limit;
    }
    const auto across = static_cast<double>(dx * py - dy * px);
    return across * across < static_cast<double>(limit) * static_cast<double>(length);
}

}  // namespace sand::tin
