// SPDX-License-Identifier: Apache-2.0
// Compares the triangulation with that of CGAL, an independent program. CGAL gets the same places and constraints and
// uses exact predicates of its own. Only for several places on a circle may its diagonals differ, because ours are
// canonical.
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <random>

#include "tests/sand/tin/mesh_checks.hpp"

namespace {

using mesh_checks::LatticePoint;
using mesh_checks::Mesh;
using sand::tin::kNoNumber;
using sand::tin::Triangle;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Oracle = CGAL::Constrained_Delaunay_triangulation_2<Kernel>;

Kernel::Point_2 pointAt(const LatticePoint& place) { return {place.x, place.y}; }

struct Edges {
    int shared = 0, onCircles = 0;
    std::vector<std::string> wrong;
};

class Comparison {
public:
    explicit Comparison(const Mesh& mesh) : mesh_(mesh.triangles()) {
        const std::array corners{LatticePoint{0, 0}, LatticePoint{mesh_.width, 0},
                                 LatticePoint{mesh_.width, mesh_.depth}, LatticePoint{0, mesh_.depth}};
        for (std::size_t i = 0; i < 4; ++i) {
            oracle_.insert_constraint(pointAt(corners[i]), pointAt(corners[(i + 1) % 4]));
        }
        for (const auto& place : mesh_checks::placesOf(mesh)) {
            if (place) {
                handles_[*place] = oracle_.insert(pointAt(*place));
            }
        }
        for (const auto& [from, to] : mesh_checks::constraintsOf(mesh)) {
            oracle_.insert_constraint(handles_.at(from), handles_.at(to));
        }
    }

    [[nodiscard]] std::size_t vertexCount() const { return oracle_.number_of_vertices(); }
    [[nodiscard]] std::size_t faceCount() const { return oracle_.number_of_faces(); }

    [[nodiscard]] Edges edges() const {
        Edges edges;
        for (const Triangle& triangle : mesh_.triangles) {
            for (std::size_t i = 0; triangle.alive() && i < 3; ++i) {
                compare(triangle, i, edges);
            }
        }
        return edges;
    }

private:
    [[nodiscard]] const LatticePoint& place(sand::tin::Vertex vertex) const {
        return mesh_.places[static_cast<std::size_t>(vertex)];
    }

    void compare(const Triangle& triangle, std::size_t i, Edges& edges) const {
        const LatticePoint &a = place(triangle.corner[i]), &b = place(triangle.corner[(i + 1) % 3]),
                           &c = place(triangle.corner[(i + 2) % 3]);
        Oracle::Face_handle face;
        int opposite = 0;
        if (oracle_.is_edge(handles_.at(b), handles_.at(c), face, opposite)) {
            ++edges.shared;
            if (oracle_.is_constrained({face, opposite}) != triangle.constrained[i]) {
                edges.wrong.push_back(
                    fmt::format("constrained in one mesh only: ({}, {})-({}, {})", b.x, b.y, c.x, c.y));
            }
            return;
        }
        ++edges.onCircles;
        const std::int32_t other = triangle.neighbour[i];
        const Triangle beyond = other == kNoNumber ? Triangle{} : mesh_.triangles[static_cast<std::size_t>(other)];
        for (std::size_t k = 0; beyond.alive() && k < 3; ++k) {
            const bool isThere = beyond.corner[(k + 1) % 3] == triangle.corner[(i + 2) % 3] &&
                                 beyond.corner[(k + 2) % 3] == triangle.corner[(i + 1) % 3];
            if (isThere &&
                CGAL::side_of_oriented_circle(pointAt(a), pointAt(b), pointAt(c), pointAt(place(beyond.corner[k]))) ==
                    CGAL::ON_ORIENTED_BOUNDARY) {
                return;
            }
        }
        edges.wrong.push_back(fmt::format("an edge that CGAL does not have: ({}, {})-({}, {})", b.x, b.y, c.x, c.y));
    }

    const sand::tin::Triangles& mesh_;
    Oracle oracle_;
    std::map<LatticePoint, Oracle::Vertex_handle> handles_;
};

/// Makes random edits, and compares the meshes after every tenth.
Edges editAndCompare(std::int32_t width, std::int32_t depth, int edits, int most, std::uint32_t seed) {
    std::mt19937 random(seed);
    Mesh mesh(width, depth);
    Edges all;
    for (int i = 1; i <= edits; ++i) {
        (void)mesh_checks::editAtRandom(mesh, random, most);
        if (i % 10 != 0) {
            continue;
        }
        const Comparison comparison(mesh);
        EXPECT_EQ(comparison.vertexCount(), static_cast<std::size_t>(mesh.vertexCount()));
        EXPECT_EQ(comparison.faceCount(), mesh_checks::trianglesOf(mesh).size());
        const Edges edges = comparison.edges();
        EXPECT_TRUE(edges.wrong.empty()) << "seed " << seed << ", edit " << i << ": " << edges.wrong.front();
        all.shared += edges.shared;
        all.onCircles += edges.onCircles;
    }
    return all;
}

TEST(DelaunayOracle, HasTheSameEdgesOnAFineLattice) {
    const Edges edges = editAndCompare(1 << 22, 1 << 22, 2000, 400, 21);
    EXPECT_GT(edges.shared, 10000);
}

TEST(DelaunayOracle, HasTheSameEdgesButOfCirclesOnACoarseLattice) {
    const Edges edges = editAndCompare(60, 60, 2000, 300, 22);
    EXPECT_GT(edges.shared, 10000);
    EXPECT_GT(edges.onCircles, 100) << "too few places on circles to show anything";
}

}  // namespace
