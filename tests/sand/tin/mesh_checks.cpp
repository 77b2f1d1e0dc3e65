// SPDX-License-Identifier: Apache-2.0
#include "tests/sand/tin/mesh_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace mesh_checks {
namespace {

using sand::tin::kNoNumber;
using sand::tin::Triangle;
using sand::tin::Wide;

Wide area(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c) {
    return static_cast<Wide>(b.x - a.x) * (c.y - a.y) - static_cast<Wide>(b.y - a.y) * (c.x - a.x);
}

/// Returns the determinant itself, without any shortcut.
Wide inCircle(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c, const LatticePoint& d) {
    const auto row = [&d](const LatticePoint& p) {
        const Wide x = p.x - d.x, y = p.y - d.y;
        return std::array<Wide, 3>{x, y, x * x + y * y};
    };
    const auto r = row(a), s = row(b), t = row(c);
    return r[0] * (s[1] * t[2] - s[2] * t[1]) - r[1] * (s[0] * t[2] - s[2] * t[0]) + r[2] * (s[0] * t[1] - s[1] * t[0]);
}

std::string edgeName(const LatticePoint& a, const LatticePoint& b) {
    return fmt::format("({}, {})-({}, {})", a.x, a.y, b.x, b.y);
}

class Check {
public:
    explicit Check(const Mesh& mesh) : vertexCount_(mesh.vertexCount()), mesh_(mesh.triangles()) {}

    std::string run() {
        checkVertices();
        for (std::size_t slot = 0; slot < mesh_.triangles.size(); ++slot) {
            if (mesh_.triangles[slot].alive()) {
                checkTriangle(static_cast<std::int32_t>(slot));
            }
        }
        const Wide field = static_cast<Wide>(mesh_.width) * mesh_.depth * 2;
        if (area_ != field) {
            fail("the triangles do not cover the field");
        }
        const int edges = (3 * faces_ + rim_) / 2;
        if (vertexCount_ - edges + faces_ != 1) {
            fail(fmt::format("{} vertices, {} edges, {} triangles", vertexCount_, edges, faces_));
        }
        return wrong_;
    }

private:
    const LatticePoint& place(Vertex vertex) const { return mesh_.places.at(static_cast<std::size_t>(vertex)); }
    void fail(const std::string& what) {
        if (wrong_.empty()) {
            wrong_ = what;
        }
    }

    void checkVertices() {
        std::set<LatticePoint> places;
        int living = 0;
        for (std::size_t i = 0; i < mesh_.places.size(); ++i) {
            const std::int32_t slot = mesh_.triangleAt.at(i);
            if (slot == kNoNumber) {
                continue;
            }
            ++living;
            if (!places.insert(mesh_.places[i]).second) {
                fail("two vertices at one place");
            }
            const Triangle& triangle = mesh_.triangles.at(static_cast<std::size_t>(slot));
            if (std::count(triangle.corner.begin(), triangle.corner.end(), static_cast<Vertex>(i)) != 1) {
                fail(fmt::format("vertex {} is not a corner of its triangle", i));
            }
        }
        if (living != vertexCount_) {
            fail(fmt::format("{} vertices, but vertexCount() returns {}", living, vertexCount_));
        }
    }

    void checkTriangle(std::int32_t slot) {
        const Triangle& triangle = mesh_.triangles[static_cast<std::size_t>(slot)];
        const Wide twice = area(place(triangle.corner[0]), place(triangle.corner[1]), place(triangle.corner[2]));
        if (twice <= 0) {
            fail(fmt::format("triangle {} is flat or runs clockwise", slot));
        }
        area_ += twice;
        ++faces_;
        for (std::size_t i = 0; i < 3; ++i) {
            checkSide(slot, triangle, i);
        }
    }

    void checkSide(std::int32_t slot, const Triangle& triangle, std::size_t i) {
        const Vertex b = triangle.corner[(i + 1) % 3];
        const Vertex c = triangle.corner[(i + 2) % 3];
        const LatticePoint& from = place(b);
        const LatticePoint& to = place(c);
        const bool rim = (from.x == to.x && (to.x == 0 || to.x == mesh_.width)) ||
                         (from.y == to.y && (to.y == 0 || to.y == mesh_.depth));
        const std::int32_t other = triangle.neighbour[i];
        if (rim != (other == kNoNumber)) {
            fail("neighbours and rim disagree at " + edgeName(from, to));
        }
        if (other == kNoNumber) {
            ++rim_;
            if (!triangle.constrained[i]) {
                fail("a rim edge that is not constrained at " + edgeName(from, to));
            }
            return;
        }
        const Triangle& there = mesh_.triangles.at(static_cast<std::size_t>(other));
        for (std::size_t j = 0; j < 3; ++j) {
            if (there.corner[(j + 1) % 3] == c && there.corner[(j + 2) % 3] == b) {
                if (there.neighbour[j] != slot || there.constrained[j] != triangle.constrained[i]) {
                    fail("neighbours disagree about " + edgeName(from, to));
                }
                checkCircle(triangle, i, place(there.corner[j]));
                return;
            }
        }
        fail("neighbours without a common edge at " + edgeName(from, to));
    }

    void checkCircle(const Triangle& triangle, std::size_t i, const LatticePoint& d) {
        if (triangle.constrained[i]) {
            return;
        }
        const LatticePoint& a = place(triangle.corner[i]);
        const LatticePoint& b = place(triangle.corner[(i + 1) % 3]);
        const LatticePoint& c = place(triangle.corner[(i + 2) % 3]);
        const Wide inside = inCircle(a, b, c, d);
        if (inside > 0) {
            fail("a vertex in the circle of " + edgeName(b, c));
        }
        if (inside == 0 && std::min({a, b, c, d}) != std::min(b, c)) {
            fail("the wrong diagonal of four places on a circle: " + edgeName(b, c));
        }
    }

    int vertexCount_;
    const Triangles& mesh_;
    std::string wrong_;
    Wide area_ = 0;
    int faces_ = 0, rim_ = 0;
};

std::size_t below(std::mt19937& random, std::size_t count) { return random() % count; }

LatticePoint anywhere(const Triangles& mesh, std::mt19937& random) {
    LatticePoint place{static_cast<std::int32_t>(below(random, static_cast<std::size_t>(mesh.width) + 1)),
                       static_cast<std::int32_t>(below(random, static_cast<std::size_t>(mesh.depth) + 1))};
    if (below(random, 8) == 0) {
        place.x = below(random, 2) == 0 ? 0 : mesh.width;
    }
    return place;
}

}  // namespace

std::string whatIsWrong(const Mesh& mesh) { return Check(mesh).run(); }

std::set<LatticeTriangle> trianglesOf(const Mesh& mesh) {
    std::set<LatticeTriangle> all;
    for (const Triangle& triangle : mesh.triangles().triangles) {
        if (triangle.alive()) {
            LatticeTriangle places;
            std::transform(triangle.corner.begin(), triangle.corner.end(), places.begin(),
                           [&](Vertex v) { return mesh.triangles().places[static_cast<std::size_t>(v)]; });
            std::rotate(places.begin(), std::min_element(places.begin(), places.end()), places.end());
            all.insert(places);
        }
    }
    return all;
}

std::set<std::pair<LatticePoint, LatticePoint>> constraintsOf(const Mesh& mesh) {
    std::set<std::pair<LatticePoint, LatticePoint>> all;
    for (const auto& [a, b] : mesh.constraints()) {
        const LatticePoint& from = mesh.triangles().places[static_cast<std::size_t>(a)];
        const LatticePoint& to = mesh.triangles().places[static_cast<std::size_t>(b)];
        all.insert({std::min(from, to), std::max(from, to)});
    }
    return all;
}

std::vector<std::optional<LatticePoint>> placesOf(const Mesh& mesh) {
    std::vector<std::optional<LatticePoint>> places;
    const Triangles& triangles = mesh.triangles();
    for (std::size_t i = 0; i < triangles.places.size(); ++i) {
        places.push_back(triangles.triangleAt[i] == kNoNumber ? std::nullopt : std::optional(triangles.places[i]));
    }
    return places;
}

Mesh restored(const Mesh& mesh) {
    return Mesh::restore(mesh.triangles().width, mesh.triangles().depth, placesOf(mesh), mesh.constraints());
}

Mesh madeInAnotherOrder(const Mesh& mesh, std::mt19937& random) {
    Mesh other(mesh.triangles().width, mesh.triangles().depth);
    std::vector<Vertex> vertices = livingVertices(mesh);
    std::shuffle(vertices.begin(), vertices.end(), random);
    std::map<Vertex, Vertex> numbers;
    for (const Vertex vertex : vertices) {
        numbers[vertex] = other.insert(mesh.triangles().places[static_cast<std::size_t>(vertex)]);
    }
    auto constraints = mesh.constraints();
    std::shuffle(constraints.begin(), constraints.end(), random);
    for (const auto& [a, b] : constraints) {
        other.constrain(numbers.at(b), numbers.at(a));
    }
    return other;
}

std::vector<Vertex> livingVertices(const Mesh& mesh) {
    std::vector<Vertex> living;
    for (std::size_t i = 0; i < mesh.triangles().places.size(); ++i) {
        if (mesh.triangles().triangleAt[i] != kNoNumber) {
            living.push_back(static_cast<Vertex>(i));
        }
    }
    return living;
}

std::string editAtRandom(Mesh& mesh, std::mt19937& random, int most) {
    const std::vector<Vertex> living = livingVertices(mesh);
    const auto any = [&] { return living[below(random, living.size())]; };
    switch (below(random, mesh.vertexCount() < most ? 8 : 16)) {
        case 0: {
            const Vertex from = any();
            const Vertex to = any();
            mesh.constrain(from, to);
            return fmt::format("constrain {} {}", from, to);
        }
        case 1:
        case 2: {
            const auto constraints = mesh.constraints();
            if (!constraints.empty()) {
                const auto [a, b] = constraints[below(random, constraints.size())];
                mesh.release(b, a);
                return fmt::format("release {} {}", a, b);
            }
            return "nothing";
        }
        case 3:
        case 4:
        case 5:
        case 6:
        case 7: {
            const LatticePoint place = anywhere(mesh.triangles(), random);
            mesh.insert(place);
            return fmt::format("insert {} {}", place.x, place.y);
        }
        default: {
            const Vertex vertex = any();
            mesh.remove(vertex);
            return fmt::format("remove {}", vertex);
        }
    }
}

}  // namespace mesh_checks
