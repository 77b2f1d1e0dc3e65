// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "tests/sand/tin/mesh_checks.hpp"
#include "tests/support/sand/relaxing.hpp"

namespace {

using namespace mesh_checks;
using sand::tin::kNoNumber;
using sand::tin::Located;
using sand::tin::Triangle;

/// All data of a slot's triangle, whichever corner is first in the slot.
using Seen = std::vector<std::array<std::int32_t, 4>>;

Seen seen(const Mesh& mesh, std::size_t slot) {
    Seen corners;
    if (slot >= mesh.triangles().triangles.size() || !mesh.triangles().triangles[slot].alive()) {
        return corners;
    }
    const Triangle& triangle = mesh.triangles().triangles[slot];
    for (std::size_t i = 0; i < 3; ++i) {
        const LatticePoint& place = mesh.triangles().places[static_cast<std::size_t>(triangle.corner[i])];
        corners.push_back({triangle.corner[i], place.x, place.y, triangle.constrained[i] ? 1 : 0});
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    return corners;
}

/// The triangles of each vertex.
using Stars = std::map<Vertex, std::set<Seen>>;

Stars starsOf(const Mesh& mesh) {
    Stars stars;
    for (std::size_t slot = 0; slot < mesh.triangles().triangles.size(); ++slot) {
        Seen here = seen(mesh, slot);
        for (auto& corner : here) {
            corner[3] = 0;  // constraints are not part of a star
        }
        for (const auto& corner : here) {
            stars[corner[0]].insert(here);
        }
    }
    return stars;
}

TEST(MeshChange, NamesExactlyWhatDiffers) {
    std::mt19937 random(1);
    Mesh mesh(40, 30);
    EXPECT_EQ(mesh.takeChange().triangles, (std::vector<std::int32_t>{0, 1}))
        << "all triangles of a new mesh have changed";
    EXPECT_TRUE(mesh.takeChange().vertices.empty());
    for (int i = 0; i < (samples::kSlowBuild ? 500 : 2000); ++i) {
        std::vector<Seen> before;
        for (std::size_t slot = 0; slot < mesh.triangles().triangles.size(); ++slot) {
            before.push_back(seen(mesh, slot));
        }
        const Stars stars = starsOf(mesh);
        for (std::uint32_t edits = 1 + random() % 4; edits > 0; --edits) {
            editAtRandom(mesh, random, 60);
        }
        Mesh::Change expected;
        before.resize(mesh.triangles().triangles.size());
        for (std::size_t slot = 0; slot < before.size(); ++slot) {
            if (before[slot] != seen(mesh, slot)) {
                expected.triangles.push_back(static_cast<std::int32_t>(slot));
            }
        }
        const Stars now = starsOf(mesh);
        for (Vertex vertex = 0; vertex < static_cast<Vertex>(mesh.triangles().places.size()); ++vertex) {
            const auto old = stars.find(vertex), here = now.find(vertex);
            const std::set<Seen> none;
            if ((old == stars.end() ? none : old->second) != (here == now.end() ? none : here->second)) {
                expected.vertices.push_back(vertex);
            }
        }
        const Mesh::Change change = mesh.takeChange();
        ASSERT_EQ(change.triangles, expected.triangles) << "seed 1, round " << i;
        ASSERT_EQ(change.vertices, expected.vertices) << "seed 1, round " << i;
    }
}

TEST(Locate, FindsTheFirstOfAllTrianglesThatHoldAPlaceFromWherever) {
    std::mt19937 random(2);
    Mesh mesh(20, 15);
    for (int i = 0; i < 120; ++i) {
        editAtRandom(mesh, random, 60);
    }
    const auto& triangles = mesh.triangles();
    const auto sorted = [&](std::int32_t slot) {
        auto corners = triangles.triangles[static_cast<std::size_t>(slot)].corner;
        std::sort(corners.begin(), corners.end());
        return corners;
    };
    for (std::int32_t y = -2; y <= 17; ++y) {
        for (std::int32_t x = -2; x <= 22; ++x) {
            const LatticePoint inside{std::clamp(x, 0, 20), std::clamp(y, 0, 15)};
            std::int32_t expected = kNoNumber;
            for (std::int32_t slot = 0; slot < static_cast<std::int32_t>(triangles.triangles.size()); ++slot) {
                const Triangle& triangle = triangles.triangles[static_cast<std::size_t>(slot)];
                if (!triangle.alive()) {
                    continue;
                }
                const auto at = [&](std::size_t i) {
                    return triangles.places[static_cast<std::size_t>(triangle.corner[i])];
                };
                const bool holds = sand::tin::doubledArea(at(0), at(1), inside) >= 0 &&
                                   sand::tin::doubledArea(at(1), at(2), inside) >= 0 &&
                                   sand::tin::doubledArea(at(2), at(0), inside) >= 0;
                if (holds && (expected == kNoNumber || sorted(slot) < sorted(expected))) {
                    expected = slot;
                }
            }
            for (const std::int32_t from : {kNoNumber, 0, 7, 1'000'000, static_cast<std::int32_t>(random() % 50)}) {
                const Located found = locate(triangles, {x, y}, from);
                ASSERT_EQ(found.triangle, expected) << x << ", " << y << " from " << from;
            }
        }
    }
}

}  // namespace
