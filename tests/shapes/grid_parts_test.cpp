// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>

#include "shapes/grid/parts.hpp"
#include "tests/support/seed.hpp"

namespace {

using shapes::GridParts;
using shapes::SurfacePart;
using shapes::SurfaceParts;

/// Vertices as a page keeps them: in one array for each input of the shader.
struct Kept {
    std::vector<float> heights, places;
    std::vector<std::int16_t> normals;
    std::vector<std::uint16_t> shades;

    explicit Kept(std::size_t vertices)
        : heights(vertices), places(2 * vertices), normals(2 * vertices), shades(2 * vertices) {}
    void take(const SurfacePart& part) {
        const auto copy = [](const auto& from, auto& to, std::size_t first) {
            ASSERT_LE(first + from.size(), to.size());
            std::copy(from.begin(), from.end(), to.begin() + static_cast<std::ptrdiff_t>(first));
        };
        copy(part.heights, heights, part.first);
        copy(part.places, places, 2UL * part.first);
        copy(part.normals, normals, 2UL * part.first);
        copy(part.shades, shades, 2UL * part.first);
    }
    void take(SurfaceParts& parts, const SurfaceParts::Change& change) {
        for (const int number : change.parts) {
            take(parts.part(number));
        }
    }
    friend bool operator==(const Kept&, const Kept&) = default;
};

Kept freshOf(const sand::GridData& data) {
    GridParts parts(data);
    Kept kept(parts.vertices());
    kept.take(parts, parts.take(data));
    return kept;
}

std::set<int> flagged(const SurfaceParts::Change& change) { return {change.parts.begin(), change.parts.end()}; }

TEST(GridParts, ThatFollowChangesAreThoseOfANewSurface) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    for (const auto& [columns, rows, holes] :
         {std::array{97, 61, 0}, std::array{160, 120, 1}, std::array{300, 280, 0}, std::array{1, 40, 0}}) {
        sand::HeightField field(columns, rows, 0.5);
        sand::Ground ground(columns, rows);
        for (int i = 0; i < 40 * holes; ++i) {
            ground.setWall(static_cast<int>(random() % 97), static_cast<int>(random() % 61));
        }
        const sand::GridData data{field, holes == 1 ? &ground : nullptr};
        GridParts parts(data);
        Kept kept(parts.vertices());
        kept.take(parts, parts.take(data));
        std::size_t fewest = 1000;
        for (int round = 0; round < 25; ++round) {
            for (auto changes = random() % 3; changes > 0; --changes) {
                field.setHeight(static_cast<int>(random() % static_cast<unsigned>(columns)),
                                static_cast<int>(random() % static_cast<unsigned>(rows)),
                                static_cast<std::int32_t>(random() % 400000));
            }
            const SurfaceParts::Change change = parts.take(data);
            ASSERT_FALSE(change.whole);
            fewest = std::min(fewest, flagged(change).size());
            kept.take(parts, change);
            ASSERT_TRUE(kept == freshOf(data)) << columns << " x " << rows << ", round " << round;
        }
        EXPECT_EQ(fewest, 0U);  // of a round without a change
    }
}

TEST(GridParts, TrianglesCoverTheGroundOnce) {
    for (const auto& [columns, rows] : {std::array{97, 61}, std::array{160, 120}, std::array{300, 280}}) {
        sand::HeightField field(columns, rows, 1);
        sand::Ground ground(columns, rows);
        ground.setWall(40, 30);
        ground.setWall(41, 30);
        GridParts parts({field, &ground});
        const SurfaceParts::Change all = parts.take(sand::GridData{field, &ground});
        ASSERT_TRUE(all.whole);
        Kept kept(parts.vertices());
        kept.take(parts, all);
        const auto place = [&](std::uint32_t vertex) {
            return glm::clamp(0.5 * (glm::dvec2(kept.places.at(2 * vertex), kept.places.at(2 * vertex + 1)) - 1.0),
                              glm::dvec2(0), glm::dvec2(columns, rows));
        };
        double area = 0;
        for (const int number : all.parts) {
            const std::vector<std::uint32_t> corners = parts.triangles(number);
            for (std::size_t i = 0; i < corners.size(); i += 3) {
                const glm::dvec2 a = place(corners[i]), b = place(corners[i + 1]) - a, c = place(corners[i + 2]) - a;
                ASSERT_GE(b.x * c.y - b.y * c.x, -1e-9);
                area += (b.x * c.y - b.y * c.x) / 2;
            }
        }
        EXPECT_NEAR(area, columns * rows - 2, 1e-6);
    }
}

}  // namespace
