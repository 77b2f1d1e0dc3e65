// SPDX-License-Identifier: Apache-2.0
// Sand that no session has made: it must be refused, or else every step can be applied to it.
#include "tests/support/sand/hostile_sand.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "sand/replica.hpp"
#include "sand/tin/surface.hpp"
#include "tests/support/files/overlong.hpp"
#include "tests/support/machine/memory_limit.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/tin_scene.hpp"

namespace {

using sand::Edit;
using sand::Replica;
using sand::Step;

constexpr std::uint64_t kGiB = std::uint64_t{1} << 30;

Step stepOf(std::uint64_t number, Edit edit = Edit::none) {
    return {.epoch = 1, .number = number, .engaged = false, .path = {}, .edit = std::move(edit)};
}

/// Returns the plain bytes of a TIN: the four corners without sand, `dead` numbers without a vertex, and a vertex in
/// the middle.
base::Bytes plainWith(const sand::tin::TinStart& start, std::size_t dead) {
    base::ByteWriter plain;
    plain.put(start.width);
    plain.put(start.depth);
    plain.putVarint(4 + dead + 1);
    const auto vertex = [&plain](std::int32_t x, std::int32_t y) {
        plain.putVarint(2 * static_cast<std::uint64_t>(x) + 1);
        plain.putVarint(static_cast<std::uint64_t>(y));
        plain.putSigned(0);
    };
    vertex(0, 0);
    vertex(start.width, 0);
    vertex(start.width, start.depth);
    vertex(0, start.depth);
    for (std::size_t i = 0; i < dead; ++i) {
        plain.putVarint(0);
    }
    vertex(start.width / 2, start.depth / 2);
    plain.putVarint(0);  // no constraints
    return plain.take();
}

// A state may claim 1 GiB of plain bytes, at one byte for a vertex that does not exist. It took 20 bytes per vertex and
// more to find that out.
TEST(HostileTin, OfDeadVerticesIsRefusedBeforeTheirMemoryIsAllocated) {
    const scene::Scene scene = samples::tinScene();
    const base::Bytes dead = hostile_sand::ofDeadVertices(*scene.tin, kGiB);
    ASSERT_LT(dead.size(), 64U * 1024) << "so that it is an ordinary message of the link";
    const base::Bytes state = hostile_sand::stateWith(Replica(scene), dead);
    const std::string said = test::inTwoGiB([&] {
        Replica replica(scene);
        const std::uint64_t hash = replica.stateHash();
        try {
            replica.decodeState(state);
        } catch (const base::FormatError&) {
            if (replica.stateHash() != hash) {
                throw std::runtime_error("the replica has changed");
            }
            return;
        }
        throw std::runtime_error("the state was accepted");
    });
    EXPECT_EQ(said, "done");
}

TEST(HostileTin, OfDeadVerticesIsALoadThatIsIgnored) {
    const scene::Scene scene = samples::tinScene();
    const base::Bytes dead = hostile_sand::ofDeadVertices(*scene.tin, kGiB);
    const std::string said = test::inTwoGiB([&] {
        Replica replica(scene), other(scene);
        replica.apply(stepOf(1, Edit::loaded(dead)));
        other.apply(stepOf(1));
        if (replica.stateHash() != other.stateHash()) {
            throw std::runtime_error("the load has changed the sand");
        }
    });
    EXPECT_EQ(said, "done");
}

TEST(HostileTin, OfMoreVerticesThanTheSceneAllowsIsRefused) {
    const scene::Scene scene = samples::tinScene();
    const sand::tin::TinStart& start = *scene.tin;
    // The most vertices of a replica: those of the settings, or of the start if it has more, and 4096 for crossings.
    const std::size_t most = std::max<std::size_t>(start.places.size(), 400) + 4096;
    Replica replica(scene);
    const auto stateOf = [&](std::size_t dead) {
        return hostile_sand::stateWith(replica, hostile_sand::packedTin(plainWith(start, dead)));
    };
    EXPECT_NO_THROW(replica.decodeState(stateOf(most - 5)));
    EXPECT_THROW(replica.decodeState(stateOf(most - 4)), base::FormatError);
}

TEST(HostileTin, HasOneFormOfEachNumber) {
    const scene::Scene scene = samples::tinScene();
    const int ofSand = test::widenedNumbers(plainWith(*scene.tin, 2), [](const base::Bytes& wide) {
        base::ByteReader reader(wide);
        const auto layer = sand::tin::VertexSand::decode(reader);
        base::ByteWriter writer;
        layer.encode(writer);
        writer.putBytes(reader.rest());
        return writer.take();
    });
    EXPECT_EQ(ofSand, 1 + 5 * 3 + 2 + 1) << "counts of vertices and constraints, five vertices, and two dead ones";
    sand::tin::TinState state;
    state.imprint.pose.emplace();
    state.imprint.points.push_back({3, {4, 5}});
    state.imprint.edges.emplace_back(1, 2);
    base::ByteWriter plain;
    state.encode(plain);
    const int ofImprint = test::widenedNumbers(plain.bytes(), [](const base::Bytes& wide) {
        base::ByteReader reader(wide);
        base::ByteWriter writer;
        sand::tin::TinState::decode(reader).encode(writer);
        writer.putBytes(reader.rest());
        return writer.take();
    });
    EXPECT_EQ(ofImprint, 2) << "counts of points and edges";
}

TEST(HostileTin, WithMoreOutflowThanSandIsRefused) {
    const scene::Scene scene = samples::tinScene();
    Replica replica(scene);
    const base::Bytes sand = replica.copySand()->encode();
    for (const std::int64_t outflow :
         {std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::min()}) {
        const base::Bytes state = hostile_sand::stateWith(replica, hostile_sand::withOutflow(sand, outflow));
        EXPECT_THROW(replica.decodeState(state), base::FormatError) << outflow;
    }
    EXPECT_NO_THROW(replica.decodeState(hostile_sand::stateWith(replica, hostile_sand::withOutflow(sand, 1'000'000))));
}

TEST(HostileTin, IsDrawnFromTheSandThatReplacedTheOther) {
    const scene::Scene scene = samples::tinScene();
    sand::tin::TinSurface surface(scene.rules, scene.tin);
    surface.replace(*surface.copy());
    const sand::SurfaceData data = surface.data();
    EXPECT_EQ(&std::get<sand::TinData>(data).view.triangles, &surface.layer().triangles());
    EXPECT_EQ(&std::get<sand::TinData>(data).view.heights, &surface.layer().heights());
}

TEST(HostileTin, ThatIsIgnoredAsALoadIsReported) {
    const scene::Scene scene = samples::tinScene();
    Replica replica(scene);
    replica.apply(stepOf(1, Edit::loaded({1, 2, 3})));
    EXPECT_NE(replica.leftOut(), "");
    replica.apply(stepOf(2, Edit::loaded(replica.copySand()->encode())));
    EXPECT_EQ(replica.leftOut(), "");
}

}  // namespace
