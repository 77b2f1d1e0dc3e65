// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/mesh/mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "tests/sand/tin/mesh_checks.hpp"

namespace meshes {
namespace {

using namespace mesh_checks;

std::mt19937 seeded(std::uint32_t seed) {
    testing::Test::RecordProperty("seed", static_cast<int>(seed));
    return std::mt19937(seed);
}

/// Makes random edits and checks the mesh after each. Every tenth time, compares it with a restored mesh and with one
/// made in another order.
void editAndCheck(std::int32_t width, std::int32_t depth, int edits, int most, std::uint32_t seed) {
    std::mt19937 random = seeded(seed);
    Mesh mesh(width, depth);
    for (int i = 0; i < edits; ++i) {
        const std::string did = editAtRandom(mesh, random, most);
        ASSERT_EQ(whatIsWrong(mesh), "") << "seed " << seed << ", edit " << i << ": " << did;
        if (i % 10 == 0) {
            const Mesh again = restored(mesh);
            ASSERT_EQ(trianglesOf(mesh), trianglesOf(again)) << "seed " << seed << ", edit " << i << ": " << did;
            ASSERT_EQ(mesh.constraints(), again.constraints());
            ASSERT_EQ(trianglesOf(mesh), trianglesOf(madeInAnotherOrder(mesh, random)))
                << "seed " << seed << ", edit " << i << ": " << did;
        }
    }
}

TEST(Mesh, StaysConstrainedDelaunayWhereAllIsCollinearOrOnCircles) { editAndCheck(9, 7, 4000, 40, 1); }

TEST(Mesh, StaysConstrainedDelaunayOnAFineLattice) { editAndCheck(1 << 22, 1 << 22, 2000, 120, 2); }

TEST(Mesh, StaysConstrainedDelaunayInAStrip) { editAndCheck(1 << 22, 2, 2000, 60, 3); }

TEST(Mesh, StaysConstrainedDelaunayWhereConstraintsCrowd) { editAndCheck(60, 60, 2000, 150, 4); }

}  // namespace
}  // namespace meshes
