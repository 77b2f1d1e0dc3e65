// SPDX-License-Identifier: Apache-2.0
#include "master/start_up.hpp"

#include <gtest/gtest.h>

#include "base/input_error.hpp"
#include "scene/scene.hpp"

namespace {

constexpr std::int64_t kGiB = std::int64_t{1} << 30;

std::string refusal(const std::vector<lockstep::RankHost>& ranks, const sand::Scene& scene) {
    try {
        master::requireMemory(ranks, scene, "s.toml");
    } catch (const base::InputError& error) {
        return error.what();
    }
    return "nothing";
}

sand::Scene sceneOf(int side) {
    sand::Scene scene;
    scene.rules.columns = scene.rules.rows = side;
    return scene;
}

sand::Scene tinOf(int side, std::size_t vertices) {
    sand::Scene scene = sceneOf(side);
    sand::tin::Start start;
    start.places.resize(vertices);
    scene.tin = std::make_shared<const sand::tin::Start>(std::move(start));
    return scene;
}

TEST(StartUp, RefusesAGridThatDoesNotFitTheMemory) {
    EXPECT_EQ(refusal({{"a", 8 * kGiB}, {"a", 8 * kGiB}}, sceneOf(16384)), "nothing");
    EXPECT_EQ(refusal({{"a", 8 * kGiB}, {"a", 8 * kGiB}, {"a", 8 * kGiB}}, sceneOf(16384)),
              "s.toml: 16384 x 16384 cells need at least 12.0 GiB for the 3 ranks on a, where 8.0 GiB are free: fewer "
              "cells, or more hosts");
}

TEST(StartUp, RefusesATinWhoseVerticesDoNotFitTheMemory) {
    EXPECT_EQ(refusal({{"a", kGiB}, {"a", kGiB}}, tinOf(512, 1 << 20)), "nothing");
    EXPECT_EQ(
        refusal({{"a", kGiB}, {"a", kGiB}}, tinOf(512, 1 << 22)),
        "s.toml: a TIN of 4194304 vertices over 512 x 512 nominal cells needs at least 2.5 GiB for the 2 ranks on "
        "a, where 1.0 GiB are free: fewer of either, or more hosts");
}

TEST(StartUp, RefusesATinWhoseNominalCellsDoNotFitTheMemoryOfThoseThatDraw) {
    EXPECT_EQ(refusal({{"a", kGiB}, {"b", 2 * kGiB}}, tinOf(16384, 4)), "nothing");
    EXPECT_EQ(
        refusal({{"a", kGiB}, {"b", 2 * kGiB}, {"b", 2 * kGiB}, {"b", 2 * kGiB}}, tinOf(16384, 4)),
        "s.toml: a TIN of 4 vertices over 16384 x 16384 nominal cells needs at least 3.0 GiB for the 3 ranks on b, "
        "where 2.0 GiB are free: fewer of either, or more hosts");
}

}  // namespace
