// SPDX-License-Identifier: Apache-2.0
#include "master/start_up.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scene/scene.hpp"
#include "tests/support/folder_test.hpp"
#include "tests/support/refusal.hpp"

namespace {

constexpr std::int64_t kGiB = std::int64_t{1} << 30;

std::string refusal(const std::vector<lockstep::RankHost>& ranks, const scene::Scene& scene) {
    return test::refusalOf([&] { master::requireMemory(ranks, scene, "s.toml"); });
}

scene::Scene sceneOf(int side) {
    scene::Scene scene;
    scene.rules.columns = scene.rules.rows = side;
    return scene;
}

scene::Scene tinOf(int side, std::size_t vertices) {
    scene::Scene scene = sceneOf(side);
    sand::tin::TinStart start;
    start.places.resize(vertices);
    scene.tin = std::make_shared<const sand::tin::TinStart>(std::move(start));
    return scene;
}

TEST(StartUp, RefusesAGridThatDoesNotFitTheMemory) {
    EXPECT_EQ(refusal({{"a", 8 * kGiB}, {"a", 8 * kGiB}}, sceneOf(16384)), "nothing");
    EXPECT_EQ(refusal({{"a", 8 * kGiB}, {"a", 8 * kGiB}, {"a", 8 * kGiB}}, sceneOf(16384)),
              "s.toml: 16384 x 16384 cells need at least 12.0 GiB for the 3 ranks on a, where 8.0 GiB are free; use "
              "fewer cells, or more hosts");
}

TEST(StartUp, RefusesATinWhoseVerticesDoNotFitTheMemory) {
    EXPECT_EQ(refusal({{"a", kGiB}, {"a", kGiB}}, tinOf(512, 1 << 20)), "nothing");
    EXPECT_EQ(
        refusal({{"a", kGiB}, {"a", kGiB}}, tinOf(512, 1 << 22)),
        "s.toml: a TIN of 4194304 vertices over 512 x 512 nominal cells needs at least 2.5 GiB for the 2 ranks on "
        "a, where 1.0 GiB are free; use fewer of either, or more hosts");
}

TEST(StartUp, RefusesATinWhoseNominalCellsDoNotFitTheMemoryOfThoseThatDraw) {
    EXPECT_EQ(refusal({{"a", kGiB}, {"b", 2 * kGiB}}, tinOf(16384, 4)), "nothing");
    EXPECT_EQ(
        refusal({{"a", kGiB}, {"b", 2 * kGiB}, {"b", 2 * kGiB}, {"b", 2 * kGiB}}, tinOf(16384, 4)),
        "s.toml: a TIN of 4 vertices over 16384 x 16384 nominal cells needs at least 3.0 GiB for the 3 ranks on b, "
        "where 2.0 GiB are free; use fewer of either, or more hosts");
}

TEST(StartUp, RefusesTheHeightsThatATinIsMadeOf) {
    const auto refusalOn = [](std::int64_t free) {
        return test::refusalOf([free] {
            master::requireMemory({{"a", free}, {"b", 8 * kGiB}}, 16384, 16384, true, "s.toml");
        });
    };
    EXPECT_EQ(refusalOn(kGiB), "nothing") << "the heights alone are 1 GiB";
    EXPECT_EQ(refusalOn(kGiB / 2),
              "s.toml: 16384 x 16384 nominal cells of a TIN need at least 1.0 GiB for the one rank on a, where 0.5 GiB "
              "are free; use fewer cells, or more hosts");
}

// Only the master reads a raster. It takes 16 bytes per pixel.
TEST(StartUp, RefusesARasterWhosePixelsDoNotFitTheMastersHost) {
    const auto refusalOn = [](std::int64_t free) {
        return test::refusalOf([free] {
            master::requireMemoryOfRaster({{"a", free}, {"a", free}, {"b", kGiB}}, 16384, 16384, "s.toml");
        });
    };
    EXPECT_EQ(refusalOn(4 * kGiB), "nothing") << "the other ranks read nothing";
    EXPECT_EQ(refusalOn(2 * kGiB),
              "s.toml: 16384 x 16384 pixels of a raster need at least 4.0 GiB for the one rank on a, where 2.0 GiB are "
              "free; coarsen it");
}

class StartUpFiles : public test::FolderTest {};

TEST_F(StartUpFiles, AFolderToWhichOtherUsersMayWriteIsRefused) {
    const std::filesystem::path out = folder_ / "out";
    const auto refused = [&] { return test::refusalOf([&] { master::requireFolder(out); }); };
    std::filesystem::create_directory(out);
    std::filesystem::permissions(out, std::filesystem::perms::all);
    EXPECT_EQ(refused(), out.string() + ": other users may write to it; run chmod go-w on it, or choose another --out");
    std::filesystem::permissions(out, std::filesystem::perms::owner_all);
    EXPECT_EQ(refused(), "nothing");
}

TEST_F(StartUpFiles, AFileInPlaceOfTheFolderForResultsIsRefused) {
    const std::filesystem::path out = folder_ / "out";
    const auto refused = [&] { return test::refusalOf([&] { master::requireFolder(out); }); };
    EXPECT_EQ(refused(), "nothing") << "it can be made";
    std::filesystem::create_directory(out);
    EXPECT_EQ(refused(), "nothing");
    std::filesystem::remove(out);
    std::ofstream(out) << "text";
    EXPECT_EQ(refused(), out.string() + ": is not a folder, and --out must be one; choose another");
}

}  // namespace
