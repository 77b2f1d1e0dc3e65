// SPDX-License-Identifier: Apache-2.0
// Sweeps give the memory of fluxes back where sand rests. That must not change the sand.
#include <gtest/gtest.h>

#include <algorithm>

#include "sand/grid/erosion.hpp"
#include "tests/support/machine/resident.hpp"
#include "tests/support/sand/relaxing.hpp"

namespace {

using sand::HeightField;
using sand::grid::Erosion;

/// A field whose rows of blocks fill whole pages. The sand comes to rest only where it is piled up.
constexpr int kFluxColumns = 1 << 14;
constexpr int kFluxRows = 64;

void pileUpSand(HeightField& field, Erosion& erosion, int x, int y) {
    for (int row = y; row < y + 3; ++row) {
        for (int column = x; column < x + 3; ++column) {
            field.setHeight(column, row, field.height(column, row) + 20 * sand::kUnitsPerCell);
        }
    }
    erosion.touch({x, y, x + 3, y + 3});
}

// The other Erosion visits every block in every sweep, so that it keeps all its memory.
TEST(FluxMemory, GivingItBackChangesNothing) {
    HeightField field(kFluxColumns, kFluxRows, 1.0), whole = field;
    const sand::Rules rules = samples::rulesFor(field);
    Erosion erosion(field, rules);
    Erosion::Options visitsAll;
    visitsAll.skipSettled = false;
    Erosion other(whole, rules, visitsAll);
    for (int call = 0; call < 400; ++call) {
        if (call % 50 == 0) {  // in the same rows after a short rest, and after a long one
            const int y = call % 200 == 0 ? 8 : 40;
            pileUpSand(field, erosion, 100 + 7 * call, y);
            pileUpSand(whole, other, 100 + 7 * call, y);
        }
        erosion.sweep(field, sand::SweepPart::all(4));
        other.sweep(whole, sand::SweepPart::all(4));
        ASSERT_TRUE(call % 20 != 0 || sameHeights(field, whole)) << call;
        ASSERT_FALSE(erosion.amiss(field.bounds())) << call;
    }
    EXPECT_TRUE(sameHeights(field, whole));
}

// Sand that slides keeps its fluxes, even if no sweep is due for a long time.
TEST(FluxMemory, SandThatSlidesKeepsItsFluxes) {
    HeightField field(kFluxColumns, kFluxRows, 1.0), whole = field;
    const sand::Rules rules = samples::rulesFor(field);
    Erosion erosion(field, rules), other(whole, rules);
    pileUpSand(field, erosion, 100, 8);
    pileUpSand(whole, other, 100, 8);
    erosion.sweep(field, 3);
    other.sweep(whole, 3);
    for (int call = 0; call < 300; ++call) {
        erosion.sweep(field, sand::SweepPart::all(0));
    }
    erosion.sweep(field, 3);
    other.sweep(whole, 3);
    EXPECT_TRUE(sameHeights(field, whole));
}

#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
/// Returns a field whose heights have their memory. Every second column is higher by `rise` [unit].
HeightField ridges(std::int32_t rise) {
    HeightField field(kFluxColumns, 1024, 1.0);
    for (int y = 0; y < field.rows(); ++y) {
        for (int x = 0; x < field.columns(); ++x) {
            field.setHeight(x, y, 1 + x % 2 * rise);
        }
    }
    return field;
}

TEST(FluxMemory, IsNotTakenForGentleSand) {
    const sand::Rules rules = samples::rulesFor(HeightField(kFluxColumns, 1024, 1.0));
    HeightField field = ridges(rules.tuning.threshold / 2);
    const std::int64_t before = test::residentBytes();
    Erosion erosion(field, rules);
    pileUpSand(field, erosion, 100, 8);
    erosion.sweep(field, sand::SweepPart::all(8));
    EXPECT_LE(test::residentBytes() - before, 8 << 20) << "two fluxes of 64 MiB";
    EXPECT_FALSE(erosion.settled());
}

// The slopes are below the threshold, but not by much. Only a visit finds that this sand rests.
TEST(FluxMemory, IsGivenBackWhereSandRests) {
    const sand::Rules rules = samples::rulesFor(HeightField(kFluxColumns, 1024, 1.0));
    HeightField field = ridges(rules.tuning.threshold - 1);
    const std::int64_t before = test::residentBytes();
    Erosion erosion(field, rules);
    erosion.sweep(field, sand::SweepPart::all(1));
    const std::int64_t most = test::residentBytes() - before;
    EXPECT_GE(most, 100 << 20) << "two fluxes of 64 MiB";
    for (int call = 0; call < 40; ++call) {
        erosion.sweep(field, sand::SweepPart::all(1));
    }
    EXPECT_LE(test::residentBytes() - before, most / 10);
}
#endif

}  // namespace
