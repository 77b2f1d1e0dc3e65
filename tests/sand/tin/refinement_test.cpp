// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>

#include "sand/tin/refine/coarsening.hpp"
#include "tests/sand/tin/tool_fixture.hpp"

namespace details {
namespace {

using namespace tin_samples;
using sand::tin::Box;
using sand::tin::DetailRules;

constexpr double kCell = sand::kUnitsPerCell;
constexpr Box kNowhere{};

DetailRules rulesOf(std::int32_t spacing, double maxError, std::int32_t removals) {
    DetailRules rules;
    rules.spacing = spacing;
    rules.maxError = maxError;
    rules.removals = removals;
    return rules;
}

int refineAll(VertexSand& layer, const DetailRules& rules, const Box& box) {
    int came = 0;
    std::vector<LatticePoint> there;
    forEachVertex(layer, [&](Vertex, const LatticePoint& place, double) { there.push_back(place); });
    layer.edit([&](sand::tin::Mesh& mesh) {
        came = sand::tin::refine(mesh, rules, box, [](const LatticePoint&) { return true; }, there, {});
    });
    return came;
}

TEST(TinDetail, AVertexComesIntoEverySquareOnce) {
    VertexSand layer(sand::tin::Mesh(20 * 256, 10 * 256));
    const DetailRules rules = rulesOf(256, 0, 0);
    // The square of a corner contains a vertex already.
    EXPECT_EQ(refineAll(layer, rules, {0, 0, 20 * 256, 10 * 256}), 200 - 1);
    EXPECT_EQ(refineAll(layer, rules, {0, 0, 20 * 256, 10 * 256}), 0);
    EXPECT_EQ(refineAll(layer, rulesOf(512, 0, 0), {0, 0, 20 * 256, 10 * 256}), 0);
    EXPECT_GT(refineAll(layer, rulesOf(128, 0, 0), {0, 0, 20 * 256, 10 * 256}), 0);
}

TEST(TinDetail, RefinementKeepsAwayFromEdges) {
    VertexSand layer(sand::tin::Mesh(20 * 256, 20 * 256));
    layer.edit([](sand::tin::Mesh& mesh) {
        const std::pair edge{LatticePoint{100, 300}, LatticePoint{5000, 4000}};
        sand::tin::refine(mesh, rulesOf(256, 0, 0), {0, 0, 20 * 256, 20 * 256},
                          [](const LatticePoint&) { return true; }, {}, {edge});
        EXPECT_GT(mesh.vertexCount(), 350);
        for (const LatticePoint& place : mesh.triangles().places) {
            EXPECT_FALSE(sand::tin::isNear(place, edge.first, edge.second, 64)) << place.x << ' ' << place.y;
        }
    });
}

TEST(TinDetail, RefinementStopsAtTheBudgetAndGoesOnWhenThereIsRoomAgain) {
    VertexSand layer(sand::tin::Mesh(40 * 256, 40 * 256));
    DetailRules rules = rulesOf(256, 1, 50);
    rules.maxVertices = 404;
    EXPECT_EQ(refineAll(layer, rules, {0, 0, 40 * 256, 40 * 256}), 400);
    EXPECT_EQ(refineAll(layer, rules, {0, 0, 40 * 256, 40 * 256}), 0);
    Vertex next = 0;
    int removed = 0;
    for (int step = 0; step < 10; ++step) {
        removed += sand::tin::coarsen(layer, rules, next, kNowhere);
    }
    EXPECT_GT(removed, 100);
    EXPECT_EQ(refineAll(layer, rules, {0, 0, 40 * 256, 40 * 256}), removed);
    EXPECT_EQ(layer.mesh().vertexCount(), 404);
}

TEST(TinDetail, ALevelLayerLosesAllThatNothingHolds) {
    VertexSand layer = levelLayer(20, 20, 256);
    std::vector<Vertex> chain;
    layer.edit([&](sand::tin::Mesh& mesh) {
        chain = mesh.constrain(mesh.insert({1100, 1200}), mesh.insert({3000, 1300})).vertices;
    });
    const DetailRules rules = rulesOf(256, 1, 40);
    const Box keepOut{3000, 3000, 4000, 4000};
    Vertex next = 0;
    for (int step = 0; step < 60; ++step) {
        EXPECT_LE(sand::tin::coarsen(layer, rules, next, keepOut), rules.removals);
    }
    int inside = 0;
    forEachVertex(layer, [&](Vertex vertex, const LatticePoint& place, double height) {
        EXPECT_EQ(height, 0);
        const bool held = std::find(chain.begin(), chain.end(), vertex) != chain.end();
        EXPECT_TRUE(vertex < 4 || keepOut.holds(place) || held) << place.x << ' ' << place.y;
        inside += keepOut.holds(place) ? 1 : 0;
    });
    EXPECT_EQ(inside, 4 * 4);
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
        EXPECT_TRUE(layer.triangles().alive(chain[i]) && layer.triangles().alive(chain[i + 1]) &&
                    layer.mesh().isConstrained(chain[i], chain[i + 1]))
            << "edge " << i << " of the constraint";
    }
    EXPECT_EQ(sand::tin::coarsen(layer, rules, next, keepOut), 0);
}

TEST(TinDetail, NoRemovalMovesTheSurfaceByMoreThanItMay) {
    constexpr unsigned kSeed = 3;
    std::mt19937 random(kSeed);
    SCOPED_TRACE("seed 3");
    VertexSand layer = levelLayer(24, 24, 256);
    forEachVertex(layer, [&](Vertex vertex, const LatticePoint& place, double) {
        const double x = place.x / 256.0 - 12, y = place.y / 256.0 - 12;
        layer.setHeight(vertex, static_cast<std::int32_t>(kCell * (0.02 * x * x + 0.01 * x * y)) +
                                    static_cast<std::int32_t>(random() % 500));
    });
    const auto before = layer.volume();
    const DetailRules rules = rulesOf(256, 0.25 * kCell, 1);
    Vertex next = 0;
    int removed = 0;
    for (int step = 0; step < 60; ++step) {
        std::vector<double> heights;
        const auto look = [&] {
            heights.clear();
            std::int32_t near = sand::tin::kNoNumber;
            for (std::int32_t y = 0; y <= 24 * 256; y += 128) {
                for (std::int32_t x = 0; x <= 24 * 256; x += 128) {
                    heights.push_back(heightAt(layer, {x, y}, near));
                }
            }
            return heights;
        };
        const std::vector<double> old = look();
        removed += sand::tin::coarsen(layer, rules, next, kNowhere);
        const std::vector<double> now = look();
        for (std::size_t i = 0; i < old.size(); ++i) {
            ASSERT_LE(std::abs(now[i] - old[i]), rules.maxError) << "step " << step;
        }
        ASSERT_TRUE(layer.volume() == before);
    }
    EXPECT_GT(removed, 10);
    EXPECT_LT(removed, 60);
}

// Heights, vertices and constraints change here and there. Coarsening with a memory must do the same as coarsening
// without one.
TEST(TinDetail, CoarseningThatRemembersLeavesWhatOneThatLooksAgainLeaves) {
    constexpr unsigned kSeed = 4;
    std::mt19937 random(kSeed);
    SCOPED_TRACE("seed 4");
    VertexSand forgetful = levelLayer(24, 24, 256), layer = levelLayer(24, 24, 256);
    const DetailRules rules = rulesOf(256, 0.02 * kCell, 3);
    Vertex next = 0, other = 0;
    sand::tin::Coarsening coarsening;
    std::vector<std::pair<Vertex, Vertex>> constrained;
    const auto somewhere = [&] { return static_cast<std::int32_t>(1 + random() % (24 * 256 - 1)); };
    const auto both = [&](const auto& change) {
        for (VertexSand* one : {&forgetful, &layer}) {
            change(*one);
        }
    };
    // The west is rough, so that hardly a vertex may be removed there. The east is nearly level.
    const auto shake = [&](Vertex vertex) {
        const bool rough = layer.triangles().places[sand::tin::index(vertex)].x < 3000;
        const auto height = static_cast<std::int32_t>(random() % (rough ? 3000 : 100));
        both([&](VertexSand& one) { one.setHeight(vertex, height); });
    };
    forEachVertex(layer, [&](Vertex vertex, const LatticePoint&, double) { shake(vertex); });
    static_cast<void>(layer.takeChange());
    int removed = 0;
    for (int step = 0; step < 2000; ++step) {
        const auto vertex = static_cast<Vertex>(random() % layer.triangles().triangleAt.size());
        if (layer.triangles().alive(vertex)) {
            shake(vertex);
            coarsening.touch(layer.triangles(), {&vertex, 1});
        }
        Vertex came = sand::tin::kNoNumber;
        if (step % 8 == 0) {
            const LatticePoint place{somewhere(), somewhere()};
            both([&](VertexSand& one) { came = one.insert(place); });
        }
        if (step % 32 == 0) {
            const auto& triangles = layer.triangles();
            const auto& corner =
                triangles.triangles[sand::tin::index(triangles.triangleAt[sand::tin::index(came)])].corner;
            constrained.emplace_back(came, corner[0] == came ? corner[1] : corner[0]);
            both([&](VertexSand& one) { one.constrain(constrained.back().first, constrained.back().second); });
        } else if (step % 32 == 16 && constrained.size() > 4) {
            both([&](VertexSand& one) { one.release(constrained.front().first, constrained.front().second); });
            constrained.erase(constrained.begin());
        }
        coarsening.touch(layer.triangles(), layer.takeChange());
        const Box keepOut = step % 100 < 50 ? kNowhere : Box{0, 0, 1500, 3000};
        const int here = coarsening.step(layer, rules, next, keepOut);
        static_cast<void>(layer.takeChange());
        ASSERT_EQ(here, sand::tin::coarsen(forgetful, rules, other, keepOut)) << "step " << step;
        ASSERT_EQ(next, other);
        removed += here;
    }
    EXPECT_EQ(bytesOf(layer), bytesOf(forgetful));
    EXPECT_GT(removed, 100);
}

// 400 vertices, of which a step removes at most 40 and looks at no more than 640.
TEST(TinDetail, CoarseningIsDoneWhenItHasLookedAtAllVerticesAndFoundNone) {
    VertexSand layer = levelLayer(20, 20, 256);
    const DetailRules rules = rulesOf(256, 1, 40);
    sand::tin::Coarsening coarsening;
    Vertex next = 0;
    EXPECT_FALSE(coarsening.done()) << "it has not looked";
    int steps = 0, last = 0;
    do {
        last = coarsening.step(layer, rules, next, kNowhere);
        EXPECT_TRUE(last == 0 || !coarsening.done()) << "step " << steps;
        if (last > 0) {
            coarsening.touch(layer.triangles(), layer.takeChange());
        }
    } while (++steps < 100 && !coarsening.done());
    EXPECT_GE(steps, 11) << "ten that remove all, and one that finds none";
    Vertex other = 0;
    EXPECT_EQ(sand::tin::coarsen(layer, rules, other, kNowhere), 0);
    const std::vector<Vertex> corner{0};
    coarsening.touch(layer.triangles(), corner);
    EXPECT_FALSE(coarsening.done()) << "a height has changed";
    EXPECT_EQ(coarsening.step(layer, rules, next, kNowhere), 0);
    EXPECT_TRUE(coarsening.done());
    coarsening.forget();
    EXPECT_FALSE(coarsening.done());
}

TEST(TinDetail, WithoutAnErrorNothingGoes) {
    VertexSand layer = levelLayer(10, 10, 256);
    const base::Bytes before = bytesOf(layer);
    Vertex next = 0;
    EXPECT_EQ(sand::tin::coarsen(layer, rulesOf(256, 0, 100), next, kNowhere), 0);
    EXPECT_EQ(sand::tin::coarsen(layer, rulesOf(256, 1, 0), next, kNowhere), 0);
    EXPECT_EQ(bytesOf(layer), before);
}

}  // namespace
}  // namespace details
