// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "sand/tin/flow/erosion.hpp"
#include "tests/support/sand/relaxing.hpp"

namespace {

using sand::tin::LatticePoint;
using sand::tin::Mesh;
using sand::tin::Vertex;
using sand::tin::VertexSand;

constexpr std::int32_t kSide = 1 << 13;  // [probe unit]

std::int32_t below(std::int32_t bound, std::mt19937& random) {
    return static_cast<std::int32_t>(random() % static_cast<std::uint32_t>(bound));
}

LatticePoint anywhere(std::mt19937& random) {
    const std::int32_t x = below(kSide + 1, random);
    return {x, below(kSide + 1, random)};
}

Vertex anyOf(const VertexSand& layer, std::mt19937& random) {
    const auto count = static_cast<std::int32_t>(layer.triangles().places.size());
    Vertex vertex = below(count, random);
    while (!layer.triangles().alive(vertex)) {
        vertex = (vertex + 1) % count;
    }
    return vertex;
}

/// Returns the hash of a random session. Vertices are inserted, joined and removed; sand is poured; a tool is in the
/// sand in two steps of five; the sand slides. With `anew`, each step has a new Erosion that does not know earlier
/// steps. The hash includes the outflow over an open rim.
std::uint64_t hashOfSession(std::int32_t threshold, std::int32_t startThreshold, sand::Rim rim, bool anew) {
    std::mt19937 random(61);
    Mesh mesh(kSide, kSide);
    std::vector<LatticePoint> places(300);
    for (LatticePoint& place : places) {
        place = anywhere(random);
    }
    mesh.insert(places);
    VertexSand layer(std::move(mesh));
    sand::tin::Erosion erosion(layer, threshold, startThreshold, rim);
    std::vector<Vertex> moved;
    std::uint64_t hash = 14695981039346656037U;
    for (int step = 0; step < 100; ++step) {
        layer.insert(anywhere(random));
        const Vertex from = anyOf(layer, random);
        layer.constrain(from, anyOf(layer, random));
        layer.remove(anyOf(layer, random));
        const Vertex lifted = anyOf(layer, random);
        layer.setHeight(lifted, below(1 << 22, random));
        erosion.changed(layer, layer.takeChange());
        const Vertex fallen = anyOf(layer, random);
        layer.add(fallen, layer.stars()[static_cast<std::size_t>(fallen)] * below(1 << 21, random));
        erosion.wake({lifted, fallen});
        const LatticePoint tool = anywhere(random);
        const sand::tin::Underside held = [&](LatticePoint place) {
            const std::int64_t x = place.x - tool.x, y = place.y - tool.y;
            return x * x + y * y < 2'000'000 ? 1 << 16 : std::numeric_limits<std::int32_t>::max();
        };
        const bool stands = step % 5 < 2;
        for (Vertex vertex = 0; stands && vertex < static_cast<Vertex>(layer.heights().size()); ++vertex) {
            const auto i = static_cast<std::size_t>(vertex);
            if (layer.triangles().alive(vertex) && layer.heights()[i] > held(layer.triangles().places[i]) - 1.0) {
                erosion.wake({vertex});
            }
        }
        if (anew) {
            erosion = sand::tin::Erosion(layer, threshold, startThreshold, rim);
        }
        erosion.sweep(layer, 30, stands ? &held : nullptr, moved);
        base::ByteWriter writer;
        layer.encode(writer);
        if (rim == sand::Rim::open) {
            writer.put(erosion.takeOutflow());
        }
        for (const std::uint8_t byte : writer.bytes()) {
            hash = (hash ^ byte) * 1099511628211U;
        }
    }
    return hash;
}

// These numbers must be the same with every compiler, level of optimisation and machine, as in golden_test.cpp.
TEST(TinGolden, SessionHashesAreTheSameEverywhere) {
    for (const bool anew : samples::kSlowBuild ? std::vector{false} : std::vector{false, true}) {
        const auto session = [anew](std::int32_t threshold, std::int32_t startThreshold, sand::Rim rim) {
            return fmt::format("{:016x}", hashOfSession(threshold, startThreshold, rim, anew));
        };
        EXPECT_EQ(session(65536, 65536, sand::Rim::closed), "1882fd7900521acb") << anew;
        EXPECT_EQ(session(40000, 50000, sand::Rim::closed), "a5afae9a9d28043e") << anew;
        EXPECT_EQ(session(65536, 65536, sand::Rim::open), "cae5af1f1391d51f") << anew;
        EXPECT_EQ(session(40000, 50000, sand::Rim::open), "320f1223aa07e5f3") << anew;
    }
}

}  // namespace
