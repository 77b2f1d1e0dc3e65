// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/pixel_rect.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace {

using render_node::fewCovering;
using render_node::PixelRect;

bool holds(const PixelRect& rect, int x, int y) { return x >= rect.x0 && x < rect.x1 && y >= rect.y0 && y < rect.y1; }

TEST(PixelRect, OverlapIsEmptyWhereRectanglesOnlyTouch) {
    const PixelRect rect{2, 3, 10, 20};
    EXPECT_EQ(overlap(rect, {5, 0, 30, 7}), (PixelRect{5, 3, 10, 7}));
    EXPECT_EQ(overlap(rect, rect), rect);
    EXPECT_EQ(overlap(rect, {10, 3, 12, 20}), PixelRect{});
    EXPECT_EQ(overlap(rect, {0, 30, 40, 50}), PixelRect{});
    EXPECT_EQ(overlap(rect, {}), PixelRect{});
}

TEST(FewCovering, LeavesApartWhatLiesFarApartAndJoinsWhatDoesNot) {
    const PixelRect here{0, 0, 10, 10}, beside{12, 0, 22, 10}, away{200, 100, 210, 110};
    EXPECT_TRUE(fewCovering({}, 4, 50).empty());
    EXPECT_TRUE(fewCovering({PixelRect{}, {5, 5, 5, 9}}, 4, 50).empty());
    EXPECT_EQ(fewCovering({here, {}, beside}, 4, 19), (std::vector{here, beside})) << "20 pixels lie between";
    EXPECT_EQ(fewCovering({here, {}, beside}, 4, 20), (std::vector<PixelRect>{{0, 0, 22, 10}}));
    EXPECT_EQ(fewCovering({here, away, beside}, 4, 50), (std::vector<PixelRect>{{0, 0, 22, 10}, away}));
    EXPECT_EQ(fewCovering({here, {2, 2, 8, 8}}, 4, 0), (std::vector{here})) << "one within the other";
}

TEST(FewCovering, GivesNoMoreThanWasAskedFor) {
    std::vector<PixelRect> rects;
    rects.reserve(5000);
    for (int i = 0; i < 5000; ++i) {
        rects.push_back({i % 100 * 40, i / 100 * 60, i % 100 * 40 + 2, i / 100 * 60 + 2});
    }
    const std::vector<PixelRect> few = fewCovering(rects, 4, 1);
    EXPECT_EQ(few.size(), 4);
    for (const PixelRect& rect : rects) {
        EXPECT_TRUE(std::any_of(few.begin(), few.end(), [&](const PixelRect& one) { return around(one, rect) == one; }))
            << rect.x0 << ", " << rect.y0;
    }
    rects.resize(6);
    EXPECT_EQ(fewCovering(rects, 6, 1), rects);
    EXPECT_EQ(fewCovering(rects, 2, 1).size(), 2);
}

TEST(FewCovering, CoversEveryPixelAndCostsNoMoreThanAllApart) {
    std::mt19937 random(7);
    const auto below = [&](int most) { return static_cast<int>(random() % static_cast<unsigned>(most)); };
    for (int round = 0; round < 200; ++round) {
        std::vector<PixelRect> rects(1 + random() % 12);
        PixelRect all;
        std::int64_t apart = 0;
        constexpr std::int64_t kPass = 100;
        for (PixelRect& rect : rects) {
            rect = {below(80), below(60), 0, 0};
            rect.x1 = rect.x0 + 1 + below(20);
            rect.y1 = rect.y0 + 1 + below(20);
            all = around(all, rect);
            apart += rect.area() + kPass;
        }
        const std::vector<PixelRect> few = fewCovering(rects, rects.size(), kPass);
        std::int64_t cost = 0;
        for (const PixelRect& rect : few) {
            cost += rect.area() + kPass;
        }
        EXPECT_LE(cost, apart) << "seed 7, round " << round;
        EXPECT_LE(few.size(), rects.size());
        for (const PixelRect& rect : rects) {
            for (int y = rect.y0; y < rect.y1; ++y) {
                for (int x = rect.x0; x < rect.x1; ++x) {
                    ASSERT_TRUE(
                        std::any_of(few.begin(), few.end(), [&](const PixelRect& one) { return holds(one, x, y); }))
                        << "seed 7, round " << round;
                }
            }
        }
        EXPECT_EQ(fewCovering(rects, 4, 1 << 20), (std::vector{all}));
    }
}

}  // namespace
