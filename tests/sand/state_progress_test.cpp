// SPDX-License-Identifier: Apache-2.0
// A program that writes or reads a large state learns how far it is.
#include <gtest/gtest.h>

#include <cstddef>

#include "sand/replica.hpp"
#include "tests/support/sand/sand_samples.hpp"
#include "tests/support/sand/tin_scene.hpp"

namespace state_progress {
namespace {

using sand::Replica;
using sand::StateCopy;

constexpr int kLargeSide = 1500;  // [cell], of sand with several stripes

/// Returns how often the encoding of `copy` calls its function.
std::size_t callsOf(const StateCopy& copy) {
    std::size_t calls = 0;
    (void)copy.encode([&calls] { ++calls; });
    return calls;
}

/// Digs into the sand, so that it moves and a stroke is kept.
void dig(Replica& sand) {
    sand.apply({.number = sand.stepNumber() + 1, .path = {{0, 0, 0}}});
    sand.apply({.number = sand.stepNumber() + 1,
                .engaged = true,
                .path = {{20 * sand::kProbePerCell, 20 * sand::kProbePerCell, -3 * sand::kProbePerCell}}});
}

TEST(StateProgress, HasTheNumberOfStripesBeforeTheyAreWritten) {
    Replica sand(samples::flatScene(kLargeSide, kLargeSide));
    for (const bool moves : {false, true}) {
        if (moves) {
            dig(sand);
        }
        const StateCopy whole = sand.copyState(), begun = sand.beginCopy();
        while (sand.continueCopy(100'000)) {
        }
        for (const StateCopy* copy : {&whole, &begun}) {
            EXPECT_EQ(copy->beforeStroke != nullptr, moves);
            EXPECT_EQ(copy->stripes(), callsOf(*copy)) << moves;
            // Three stripes of heights. Sand that moves has two fluxes. The sand before the stroke was at rest.
            EXPECT_EQ(copy->stripes(), moves ? 4 * 3 : 3);
        }
    }
    const Replica tin(samples::tinScene());
    EXPECT_EQ(tin.copyState().stripes(), callsOf(tin.copyState()));
}

TEST(StateProgress, CountsTheBytesThatWereRead) {
    const scene::Scene scene = samples::flatScene(kLargeSide, kLargeSide);
    Replica sand(scene);
    dig(sand);
    const base::Bytes state = sand.encodeState(), bytes = scene.encode();
    std::size_t calls = 0, sum = 0;
    const auto count = [&](std::size_t more) {
        ++calls;
        sum += more;
    };
    Replica other(scene);
    other.decodeState(state, count);
    EXPECT_EQ(other.stateHash(), sand.stateHash());
    EXPECT_EQ(calls, 4U * 3);
    EXPECT_LE(sum, state.size());
    EXPECT_GT(sum + 3000, state.size()) << "all but the movement of tiles, the tool and the lengths of blocks";
    calls = sum = 0;
    (void)scene::Scene::decode(bytes, scene::Scene::Keep::heights, count);
    EXPECT_EQ(calls, 3U);
    EXPECT_LE(sum, bytes.size());
    EXPECT_GT(sum + 1000, bytes.size());
}

}  // namespace
}  // namespace state_progress
