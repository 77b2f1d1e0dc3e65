// SPDX-License-Identifier: Apache-2.0
// Every part of a TIN's sand shows in its hash, and corrupted memory of any part shows after one round of the audit.
#include "sand/tin/tile_hash.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "tests/support/sand/distinct_hashes.hpp"
#include "tests/support/sand/tin_piles.hpp"

namespace tin_hash {
namespace {

using sand::tin::LatticePoint;
using sand::tin::Mesh;
using sand::tin::TileHash;
using sand::tin::TinState;
using sand::tin::Vertex;
using sand::tin::VertexSand;
using test::DistinctHashes;

constexpr std::int32_t kSide = 2560;  // [probe unit]

std::uint64_t hashOf(const VertexSand& layer, const TinState& state = {}) { return TileHash(layer).update(state); }

/// Returns sand with further vertices at `places`, and with the volume 1000 in vertex 4, the first of them.
VertexSand layerWith(const std::vector<LatticePoint>& places) {
    Mesh mesh(kSide, kSide);
    static_cast<void>(mesh.insert(places));
    VertexSand layer(std::move(mesh));
    layer.add(4, 1000);
    return layer;
}

// Vertices, volumes and constraints are the same. Only the place of one vertex is another.
TEST(TinHash, TellsThePlaceOfAVertex) {
    DistinctHashes hashes;
    hashes.add("here", hashOf(layerWith({{1000, 1200}})));
    hashes.add("farther east", hashOf(layerWith({{1001, 1200}})));
    hashes.add("farther north", hashOf(layerWith({{1000, 1201}})));
    hashes.add("mirrored", hashOf(layerWith({{1200, 1000}})));
    EXPECT_EQ(hashOf(layerWith({{1000, 1200}})), hashOf(layerWith({{1000, 1200}})));
}

TEST(TinHash, TellsWhichVertexHasWhichPlaceAndVolume) {
    DistinctHashes hashes;
    hashes.add("one", hashOf(layerWith({{1000, 1200}})));
    hashes.add("one and one", hashOf(layerWith({{1000, 1200}, {300, 400}})));
    hashes.add("places exchanged", hashOf(layerWith({{300, 400}, {1000, 1200}})));
    VertexSand layer = layerWith({{1000, 1200}, {300, 400}});
    layer.add(4, -1000);
    layer.add(5, 1000);
    hashes.add("volumes exchanged", hashOf(layer));
    layer.add(5, 1);
    hashes.add("a unit more", hashOf(layer));
    layer.add(5, -1 + (std::int64_t{1} << 40));
    hashes.add("much more", hashOf(layer));
}

TEST(TinHash, TellsEveryConstraint) {
    const auto constrained = [](Vertex from, Vertex to) {
        VertexSand layer = layerWith({{1000, 1200}, {1400, 1500}, {700, 1800}});
        layer.constrain(from, to);
        return hashOf(layer);
    };
    DistinctHashes hashes;
    hashes.add("none", hashOf(layerWith({{1000, 1200}, {1400, 1500}, {700, 1800}})));
    hashes.add("4 to 5", constrained(4, 5));
    hashes.add("4 to 6", constrained(4, 6));
    hashes.add("5 to 6", constrained(5, 6));
    EXPECT_EQ(constrained(5, 4), constrained(4, 5));
}

TEST(TinHash, TellsOutflowAndCoarseningAndTheToolsImprint) {
    const VertexSand layer = layerWith({{1000, 1200}});
    const auto with = [&layer](const std::function<void(TinState&)>& change) {
        TinState state;
        state.imprint.pose.emplace();
        state.imprint.pose->tool = {sand::ToolKind::ellipse, 500, 200};
        state.imprint.points = {{4, {1000, 1200}}};
        state.imprint.edges = {{0, 4}};
        change(state);
        return hashOf(layer, state);
    };
    DistinctHashes hashes;
    hashes.add("nothing", hashOf(layer));
    hashes.add("an imprint", with([](TinState&) {}));
    hashes.add("outflow", with([](TinState& state) { state.outflow = 1; }));
    hashes.add("the next to go", with([](TinState& state) { state.nextToGo = 1; }));
    hashes.add("x", with([](TinState& state) { state.imprint.pose->probe.x = 1; }));
    hashes.add("y", with([](TinState& state) { state.imprint.pose->probe.y = 1; }));
    hashes.add("z", with([](TinState& state) { state.imprint.pose->probe.z = 1; }));
    hashes.add("kind", with([](TinState& state) { state.imprint.pose->tool.kind = sand::ToolKind::footprint; }));
    hashes.add("radius", with([](TinState& state) { state.imprint.pose->tool.radius = 501; }));
    hashes.add("width", with([](TinState& state) { state.imprint.pose->tool.halfWidth = 201; }));
    hashes.add("heading", with([](TinState& state) { state.imprint.pose->tool.heading = *sand::headingOf(1); }));
    hashes.add("mirrored", with([](TinState& state) { state.imprint.pose->tool.heading.mirrored = true; }));
    hashes.add("no point", with([](TinState& state) { state.imprint.points.clear(); }));
    hashes.add("another point", with([](TinState& state) { state.imprint.points[0].vertex = 3; }));
    hashes.add("a point elsewhere", with([](TinState& state) { state.imprint.points[0].place.y = 1201; }));
    hashes.add("no edge", with([](TinState& state) { state.imprint.edges.clear(); }));
    hashes.add("another edge", with([](TinState& state) { state.imprint.edges = {{1, 4}}; }));
}

/// Sand with vertices in all tiles: 64 vertices in each of 256.
VertexSand largeLayer() { return tin_piles::layerOf(tin_piles::Kind::regular, 130); }

void auditAll(TileHash& hash, const VertexSand& layer) {
    for (int tile = 0; tile < hash.tileCount(); ++tile) {
        hash.auditNext(layer);
    }
}

TEST(TinAudit, FindsAFlippedBitInEveryTileOfVertices) {
    VertexSand layer = largeLayer();
    TileHash hash(layer);
    const int tiles = hash.tileCount() - 1;  // the last one has no vertices
    ASSERT_GE(layer.triangles().places.size(), static_cast<std::size_t>(64 * tiles));
    const std::uint64_t right = hash.update({});
    auditAll(hash, layer);
    ASSERT_EQ(hash.update({}), right);
    for (int tile = 0; tile < tiles; ++tile) {
        for (const Vertex vertex : {64 * tile + (tile % 2 == 0 ? 0 : 63)}) {
            layer.add(vertex, 1);
            ASSERT_EQ(hash.update({}), right) << "no audit has run yet";
            auditAll(hash, layer);
            ASSERT_EQ(hash.update({}), hashOf(layer)) << "vertex " << vertex;
            ASSERT_NE(hash.update({}), right) << "vertex " << vertex;
            layer.add(vertex, -1);
            auditAll(hash, layer);
        }
    }
}

// The last tile has the constraints.
TEST(TinAudit, FindsAConstraintThatIsWrong) {
    VertexSand layer = layerWith({{1000, 1200}, {1400, 1500}, {700, 1800}});
    TileHash hash(layer);
    const std::uint64_t right = hash.update({});
    layer.constrain(4, 5);
    ASSERT_EQ(hash.update({}), right) << "no audit has run yet";
    auditAll(hash, layer);
    EXPECT_EQ(hash.update({}), hashOf(layer));
    EXPECT_NE(hash.update({}), right);
}

}  // namespace
}  // namespace tin_hash
