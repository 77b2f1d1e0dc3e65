// SPDX-License-Identifier: Apache-2.0
// Cases that are known to break triangulations, one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tests/sand/tin/mesh_checks.hpp"

namespace {

using namespace mesh_checks;

constexpr std::int32_t kWhole = 1 << 22;

/// Returns places exactly on a circle of radius 325 about `centre`: 325² = a² + b² in seven ways.
std::vector<LatticePoint> onCircle(const LatticePoint& centre) {
    std::vector<LatticePoint> places;
    for (const auto& [a, b] :
         {std::pair{36, 323}, {80, 315}, {91, 312}, {125, 300}, {165, 280}, {195, 260}, {204, 253}}) {
        for (const int sx : {-1, 1}) {
            for (const int sy : {-1, 1}) {
                places.push_back({centre.x + sx * a, centre.y + sy * b});
                places.push_back({centre.x + sx * b, centre.y + sy * a});
            }
        }
    }
    return places;
}

TEST(MeshCases, BeginsAsTwoTriangles) {
    const Mesh mesh(3, 2);
    EXPECT_EQ(whatIsWrong(mesh), "");
    EXPECT_EQ(mesh.vertexCount(), 4);
    EXPECT_EQ(trianglesOf(mesh), (std::set<LatticeTriangle>{{{{0, 0}, {3, 0}, {3, 2}}}, {{{0, 0}, {3, 2}, {0, 2}}}}));
}

TEST(MeshCases, RefusesFieldsPlacesAndVerticesThatCannotBe) {
    EXPECT_THROW(Mesh(0, 5), std::invalid_argument);
    EXPECT_THROW(Mesh(5, kWhole + 1), std::invalid_argument);
    Mesh mesh(5, 5);
    EXPECT_THROW(mesh.insert(LatticePoint{6, 0}), std::invalid_argument);
    EXPECT_THROW(mesh.insert(LatticePoint{0, -1}), std::invalid_argument);
    EXPECT_THROW(mesh.remove(4), std::invalid_argument);
    EXPECT_THROW(mesh.constrain(0, 7), std::invalid_argument);
    EXPECT_THROW(mesh.release(-1, 0), std::invalid_argument);
    EXPECT_FALSE(mesh.remove(3)) << "a corner";
    EXPECT_TRUE(mesh.constrain(2, 2).vertices.empty());
    EXPECT_EQ(whatIsWrong(mesh), "");
}

TEST(MeshCases, StopsAConstraintThatWouldNeedTooManyVertices) {
    Mesh mesh(100, 100);
    mesh.limitVertices(9);
    const Vertex south = mesh.insert(LatticePoint{50, 0}), north = mesh.insert(LatticePoint{50, 100});
    const Vertex west = mesh.insert(LatticePoint{0, 40}), east = mesh.insert(LatticePoint{100, 40});
    EXPECT_EQ(mesh.constrain(south, north).vertices.size(), 2U);
    EXPECT_EQ(mesh.constrain(west, east).vertices.size(), 3U) << "one crossing, for which there is room";
    EXPECT_EQ(mesh.vertexCount(), 9);
    const auto before = mesh.constraints();
    EXPECT_EQ(mesh.constrain(0, 2).vertices.size(), 2U) << "no room for a crossing";
    EXPECT_EQ(mesh.vertexCount(), 9);
    EXPECT_EQ(mesh.constraints(), before);
    EXPECT_EQ(whatIsWrong(mesh), "");
    EXPECT_EQ(mesh.insert(LatticePoint{50, 40}), 8) << "the vertex of the crossing";
}

TEST(MeshCases, GivesTheSmallestFreeNumber) {
    Mesh mesh(10, 10);
    for (std::int32_t i = 1; i < 6; ++i) {
        EXPECT_EQ(mesh.insert(LatticePoint{i, i}), i + 3);
    }
    EXPECT_EQ(mesh.insert(LatticePoint{3, 3}), 6) << "the vertex exists already";
    for (const Vertex vertex : {7, 5, 6}) {
        EXPECT_TRUE(mesh.remove(vertex));
    }
    EXPECT_EQ(mesh.insert(LatticePoint{9, 2}), 5);
    EXPECT_EQ(mesh.insert(LatticePoint{9, 3}), 6);
    Mesh again = restored(mesh);
    EXPECT_EQ(again.insert(LatticePoint{9, 4}), 7);
    EXPECT_EQ(mesh.insert(LatticePoint{9, 4}), 7);
    EXPECT_EQ(mesh.insert(LatticePoint{9, 5}), 9);
}

TEST(MeshCases, TakesManyAtOnceAsOneByOne) {
    std::mt19937 random(1);
    std::vector<LatticePoint> places;
    places.reserve(3000);
    for (int i = 0; i < 3000; ++i) {
        places.push_back({static_cast<std::int32_t>(random() % 50), static_cast<std::int32_t>(random() % 60)});
    }
    Mesh many(50, 60), each(50, 60);
    for (Mesh* mesh : {&many, &each}) {
        mesh->insert(LatticePoint{20, 20});
        mesh->insert(LatticePoint{21, 20});
        mesh->remove(4);
    }
    std::vector<Vertex> numbers;
    std::transform(places.begin(), places.end(), std::back_inserter(numbers), [&](auto& p) { return each.insert(p); });
    EXPECT_EQ(many.insert(places), numbers);
    EXPECT_EQ(placesOf(many), placesOf(each));
    EXPECT_EQ(trianglesOf(many), trianglesOf(each));
    EXPECT_EQ(whatIsWrong(many), "") << "seed 1";
}

TEST(MeshCases, FansCirclesOutFromTheFirstPlace) {
    Mesh mesh(1000, 1000);
    for (const LatticePoint& place : onCircle({500, 500})) {
        mesh.insert(place);
    }
    ASSERT_EQ(whatIsWrong(mesh), "");
    const LatticePoint first{500 - 323, 500 - 36};
    const auto triangles = trianglesOf(mesh);
    const auto fan = std::count_if(triangles.begin(), triangles.end(), [&first](const LatticeTriangle& triangle) {
        return triangle[0] == first;  // outside the circle, a corner of the field comes first
    });
    EXPECT_EQ(fan, 56 - 2);
}

TEST(MeshCases, TakesOutVerticesOfDegreeThreeAndFiveHundred) {
    Mesh mesh(1 << 20, 1 << 20);
    const Vertex three = mesh.insert(LatticePoint{1 << 19, 1 << 18});
    const auto before = trianglesOf(mesh);
    const Vertex inside = mesh.insert(LatticePoint{(1 << 19) + 9, 1 << 17});
    EXPECT_EQ(inside, three + 1);
    mesh.remove(inside);
    EXPECT_EQ(trianglesOf(mesh), before);
    mesh.remove(three);
    // A circle through the middle of a ring and two neighbours on the ring contains no other vertex.
    std::mt19937 random(2);
    const Vertex hub = mesh.insert(LatticePoint{1 << 19, 1 << 19});
    std::set<LatticePoint> ring;
    for (std::int32_t i = 0; ring.size() < 500; ++i) {
        const std::int32_t x = (i * 1049 + 17) % (1 << 18);
        const auto y = static_cast<std::int32_t>(std::sqrt((1LL << 36) - static_cast<std::int64_t>(x) * x));
        const std::int32_t sx = i % 2 == 0 ? 1 : -1, sy = i / 2 % 2 == 0 ? 1 : -1;
        ring.insert({(1 << 19) + sx * x, (1 << 19) + sy * y});
    }
    std::vector<LatticePoint> places(ring.begin(), ring.end());
    mesh.insert(places);
    const auto degree = [&mesh](Vertex vertex) {
        const auto& all = mesh.triangles().triangles;
        return std::count_if(all.begin(), all.end(), [vertex](const auto& triangle) {
            return std::find(triangle.corner.begin(), triangle.corner.end(), vertex) != triangle.corner.end();
        });
    };
    EXPECT_EQ(degree(hub), 500);
    ASSERT_EQ(whatIsWrong(mesh), "");
    EXPECT_TRUE(mesh.remove(hub));
    EXPECT_EQ(whatIsWrong(mesh), "");
    EXPECT_EQ(trianglesOf(mesh), trianglesOf(madeInAnotherOrder(mesh, random)));
}

TEST(MeshCases, JoinsTheRimAgain) {
    Mesh mesh(100, 50);
    const auto before = trianglesOf(mesh);
    const Vertex a = mesh.insert(LatticePoint{30, 0});
    const Vertex b = mesh.insert(LatticePoint{60, 0});
    const Vertex c = mesh.insert(LatticePoint{100, 20});
    EXPECT_EQ(whatIsWrong(mesh), "");
    EXPECT_TRUE(mesh.constraints().empty()) << "constraints() does not list the rim";
    EXPECT_TRUE(mesh.isConstrained(a, b));
    mesh.release(a, b);
    EXPECT_TRUE(mesh.isConstrained(a, b)) << "the rim stays";
    for (const Vertex vertex : {b, c, a}) {
        EXPECT_TRUE(mesh.remove(vertex));
        EXPECT_EQ(whatIsWrong(mesh), "");
    }
    EXPECT_EQ(trianglesOf(mesh), before);
}

TEST(MeshCases, ConstrainsThroughVerticesOnTheWay) {
    Mesh mesh(100, 100);
    const Vertex from = mesh.insert(LatticePoint{10, 10});
    const Vertex to = mesh.insert(LatticePoint{90, 50});
    const Vertex second = mesh.insert(LatticePoint{50, 30});
    const Vertex first = mesh.insert(LatticePoint{30, 20});
    mesh.insert(LatticePoint{50, 31});
    const auto path = mesh.constrain(from, to);
    EXPECT_EQ(path.vertices, (std::vector<Vertex>{from, first, second, to}));
    EXPECT_TRUE(path.before.empty());
    const auto back = mesh.constrain(to, first);
    EXPECT_EQ(back.vertices, (std::vector<Vertex>{to, second, first}))
        << "the second constraint overlaps the first one";
    EXPECT_EQ(back.before.size(), 2U);
    EXPECT_EQ(mesh.constraints().size(), 3U);
    const Vertex middle = mesh.insert(LatticePoint{70, 40});
    EXPECT_TRUE(mesh.isConstrained(second, middle) && mesh.isConstrained(middle, to));
    EXPECT_EQ(whatIsWrong(mesh), "");
    EXPECT_TRUE(mesh.remove(second));
    EXPECT_EQ(mesh.constraints().size(), 2U) << "the constraints that ended in the vertex are gone";
    EXPECT_EQ(whatIsWrong(mesh), "");
}

TEST(MeshCases, PutsCrossingsOnTheLattice) {
    Mesh mesh(100, 100);
    const Vertex a = mesh.insert(LatticePoint{10, 10});
    const Vertex b = mesh.insert(LatticePoint{71, 40});
    const Vertex c = mesh.insert(LatticePoint{20, 60});
    const Vertex d = mesh.insert(LatticePoint{61, 7});
    mesh.constrain(c, d);
    const std::vector<Vertex> path = mesh.constrain(a, b).vertices;
    ASSERT_EQ(path.size(), 3U);
    // 61 y = 30 x + 310 and 41 y = 3520 − 53 x: x = 45.26, y = 27.34.
    const LatticePoint& place = mesh.triangles().places[static_cast<std::size_t>(path[1])];
    EXPECT_EQ(place, (LatticePoint{45, 27}));
    EXPECT_EQ(mesh.constraints().size(), 4U);
    EXPECT_EQ(whatIsWrong(mesh), "");
}

TEST(MeshCases, LaysARingThroughAVertexAndOverARing) {
    std::mt19937 random(3);
    Mesh mesh(1000, 1000);
    for (int i = 0; i < 300; ++i) {
        mesh.insert(
            LatticePoint{static_cast<std::int32_t>(random() % 1001), static_cast<std::int32_t>(random() % 1001)});
    }
    std::vector<LatticePoint> ring = onCircle({500, 500});
    std::sort(ring.begin(), ring.end(), [](const LatticePoint& a, const LatticePoint& b) {
        const bool up = a.y > 500, other = b.y > 500;
        return up != other ? up : (up ? a.x > b.x : a.x < b.x);
    });
    mesh.insert(ring[0]);
    for (const std::int32_t shift : {0, 40, 40, 1}) {
        std::vector<Vertex> vertices;
        vertices.reserve(ring.size());
        for (const LatticePoint& place : ring) {
            vertices.push_back(mesh.insert(LatticePoint{place.x + shift, place.y}));
        }
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const auto path = mesh.constrain(vertices[i], vertices[(i + 1) % vertices.size()]).vertices;
            ASSERT_EQ(whatIsWrong(mesh), "") << "ring " << shift << ", edge " << i;
            for (std::size_t k = 0; k + 1 < path.size(); ++k) {
                ASSERT_TRUE(mesh.isConstrained(path[k], path[k + 1]));
            }
        }
    }
    EXPECT_EQ(trianglesOf(mesh), trianglesOf(restored(mesh)));
}

TEST(MeshCases, KeepsSliversUpright) {
    Mesh mesh(kWhole, kWhole);
    // Triangles of height 1 over a base of 2^22: the ratio is 2.4e-7.
    const Vertex left = mesh.insert(LatticePoint{0, 1});
    const Vertex right = mesh.insert(LatticePoint{kWhole, 1});
    mesh.constrain(left, right);
    for (const std::int32_t x : {1, 1000, kWhole / 2, kWhole - 1}) {
        mesh.insert(LatticePoint{x, 0});
        mesh.insert(LatticePoint{x + 1 - 2 * (x % 2), 2});
        ASSERT_EQ(whatIsWrong(mesh), "");
    }
    const Vertex top = mesh.insert(LatticePoint{kWhole / 3, 2});
    mesh.constrain(0, top);
    mesh.constrain(top, 1);
    EXPECT_EQ(whatIsWrong(mesh), "");
    EXPECT_EQ(trianglesOf(mesh), trianglesOf(restored(mesh)));
}

TEST(MeshCases, RestoresOnlyWhatIsAMesh) {
    using Places = std::vector<std::optional<LatticePoint>>;
    using Pairs = std::vector<std::pair<Vertex, Vertex>>;
    const Places corners{LatticePoint{0, 0}, LatticePoint{9, 0}, LatticePoint{9, 9}, LatticePoint{0, 9}};
    const auto with = [&corners](std::initializer_list<std::optional<LatticePoint>> more) {
        Places places = corners;
        places.insert(places.end(), more);
        return places;
    };
    EXPECT_NO_THROW(Mesh::restore(9, 9, with({std::nullopt, LatticePoint{3, 3}}), Pairs{{0, 5}}));
    EXPECT_THROW(Mesh::restore(9, 9, Places{}, Pairs{}), std::invalid_argument);
    EXPECT_THROW(Mesh::restore(8, 9, corners, Pairs{}), std::invalid_argument) << "other corners";
    EXPECT_THROW(Mesh::restore(9, 9, with({LatticePoint{3, 10}}), Pairs{}), std::invalid_argument) << "outside";
    EXPECT_THROW(Mesh::restore(9, 9, with({LatticePoint{3, 3}, LatticePoint{3, 3}}), Pairs{}), std::invalid_argument)
        << "two in one";
    EXPECT_THROW(Mesh::restore(9, 9, with({LatticePoint{9, 9}}), Pairs{}), std::invalid_argument) << "a corner again";
    EXPECT_THROW(Mesh::restore(9, 9, with({std::nullopt}), Pairs{{0, 4}}), std::invalid_argument)
        << "an end does not exist";
    EXPECT_THROW(Mesh::restore(9, 9, corners, Pairs{{1, 1}}), std::invalid_argument) << "both ends are one vertex";
    EXPECT_THROW(Mesh::restore(9, 9, corners, Pairs{{0, 2}, {1, 3}}), std::invalid_argument) << "the constraints cross";
    EXPECT_THROW(Mesh::restore(9, 9, with({LatticePoint{3, 3}}), Pairs{{0, 2}}), std::invalid_argument)
        << "the constraint passes through a vertex";
}

}  // namespace
