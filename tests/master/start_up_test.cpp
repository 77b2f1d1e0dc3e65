// SPDX-License-Identifier: Apache-2.0
#include "master/start_up.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/not_yet_error.hpp"
#include "host/build_id.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/files/folder_test.hpp"
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

/// Returns a wall of `count` tiles, named t1, t2 and so on.
walls::Wall wallOf(int count) {
    walls::Wall wall;
    for (int rank = 1; rank <= count; ++rank) {
        walls::Tile& tile = wall.tiles.emplace_back();
        tile.rank = rank;
        tile.name = "t" + std::to_string(rank);
    }
    return wall;
}

std::string misplaced(const std::vector<lockstep::RankHost>& ranks, const std::vector<std::string>& places) {
    std::vector<master::RankMachine> parsed;
    std::transform(places.begin(), places.end(), std::back_inserter(parsed), master::RankMachine::parse);
    return test::refusalOf([&] { master::requirePlaces(ranks, wallOf(static_cast<int>(ranks.size()) - 1), parsed); });
}

TEST(StartUp, RefusesARankOnAnotherMachineThanItsHost) {
    const std::vector<lockstep::RankHost> ranks{
        {"head", 0, "head/1"}, {"n1", 0, "n1/2"}, {"n2", 0, "n2/3"}, {"n1", 0, "n1/2"}};
    EXPECT_EQ(misplaced(ranks, {"1,3=left=n1/2", "2=right=n2/3"}), "nothing");
    EXPECT_EQ(misplaced(ranks, {"1,2=left=n1/2", "3=right=n2/3"}),
              "rank 2 (tile t2): mpirun has started it on n2, but its host is left, which is n1; look at the command "
              "with --print-command (docs/hosts.md)");
    EXPECT_NE(misplaced(ranks, {"1=left=n1/7"}), "nothing") << "a machine with the same name";
    EXPECT_EQ(misplaced(ranks, {}), "nothing") << "a job that was started by hand";
}

TEST(StartUp, RefusesAPlaceThatTheLauncherWouldNotWrite) {
    for (const std::string text : {"", "1", "1=a", "1=a=", "1==m", "=a=m", "0=a=m", "1,,2=a=m", "x=a=m", "1025=a=m"}) {
        EXPECT_NE(test::refusalOf([&] { (void)master::RankMachine::parse(text); }).find("--place: write RANK"),
                  std::string::npos)
            << text;
    }
}

TEST(StartUp, RefusesARankThatDrawsAnotherTile) {
    std::vector<lockstep::Readiness> ranks(3);
    ranks[1].tile = "t1";
    ranks[2].tile = "t2";
    EXPECT_EQ(test::refusalOf([&] { master::requireTiles(ranks, wallOf(2)); }), "nothing");
    ranks[2].tile = "t1";
    ranks[2].host = "n2";
    EXPECT_EQ(test::refusalOf([&] { master::requireTiles(ranks, wallOf(2)); }),
              "rank 2 on n2: draws the tile t1 in place of t2; run the programs of one build");
}

TEST(StartUp, WaitsOnlyForRanksWhoseDisplaysMayStillCome) {
    std::vector<lockstep::Readiness> ranks(3);
    for (lockstep::Readiness& rank : ranks) {
        rank.buildId = host::buildId();
    }
    const std::vector<std::string> names{"the master", "rank 1", "rank 2"};
    const auto refuse = [&] { master::requireReady(ranks, names); };
    EXPECT_NO_THROW(refuse());
    ranks[1].error = "no display";
    ranks[1].mayStillCome = true;
    EXPECT_THROW(refuse(), base::NotYetError);
    EXPECT_EQ(test::refusalOf(refuse), "rank 1: no display");
    ranks[2].error = "no such mode";
    EXPECT_EQ(test::refusalOf(refuse), "rank 2: no such mode") << "a wait cannot help rank 2";
    EXPECT_THROW(refuse(), base::InputError);
    try {
        refuse();
    } catch (const base::NotYetError&) {
        FAIL() << "the launcher would wait for rank 1 in vain";
    } catch (const base::InputError&) {
    }
}

TEST(StartUp, RefusesAGridThatDoesNotFitTheMemory) {
    EXPECT_EQ(refusal({{"a", 8 * kGiB}, {"a", 8 * kGiB}}, sceneOf(16384)), "nothing");
    EXPECT_EQ(refusal({{"a", 8 * kGiB}, {"a", 8 * kGiB}, {"a", 8 * kGiB}}, sceneOf(16384)),
              "s.toml: 16384 x 16384 cells need at least 12.0 GiB for the 3 ranks on a, where 8.0 GiB are free; use "
              "fewer cells, or more hosts");
}

TEST(StartUp, RefusesATinWhoseVerticesDoNotFitTheMemory) {
    EXPECT_EQ(refusal({{"a", kGiB}, {"a", kGiB}}, tinOf(512, 1 << 20)), "nothing");
    EXPECT_EQ(refusal({{"a", kGiB}, {"a", kGiB}}, tinOf(512, 1 << 22)),
              "s.toml: a TIN's 4194304 vertices over 512 x 512 nominal cells need at least 2.5 GiB for the 2 ranks on "
              "a, where 1.0 GiB are free; use fewer of either, or more hosts");
}

TEST(StartUp, RefusesATinWhoseNominalCellsDoNotFitTheMemoryOfThoseThatDraw) {
    EXPECT_EQ(refusal({{"a", kGiB}, {"b", 2 * kGiB}}, tinOf(16384, 4)), "nothing");
    EXPECT_EQ(refusal({{"a", kGiB}, {"b", 2 * kGiB}, {"b", 2 * kGiB}, {"b", 2 * kGiB}}, tinOf(16384, 4)),
              "s.toml: a TIN's 4 vertices over 16384 x 16384 nominal cells need at least 3.0 GiB for the 3 ranks on b, "
              "where 2.0 GiB are free; use fewer of either, or more hosts");
}

TEST(StartUp, RefusesTheHeightsThatATinIsMadeOf) {
    const auto refusalOn = [](std::int64_t free) {
        return test::refusalOf([free] {
            master::requireMemory({{"a", free}, {"b", 8 * kGiB}}, sand::FieldSize{16384, 16384, true}, "s.toml");
        });
    };
    EXPECT_EQ(refusalOn(kGiB), "nothing") << "the heights alone are 1 GiB";
    EXPECT_EQ(refusalOn(kGiB / 2),
              "s.toml: 16384 x 16384 nominal cells of a TIN need at least 1.0 GiB for the one rank on a, where 0.5 GiB "
              "are free; use fewer cells, or more hosts");
}

// Only the master reads a raster.
TEST(StartUp, RefusesARasterWhosePixelsDoNotFitTheMastersHost) {
    const auto refusalOn = [](std::int64_t free) {
        return test::refusalOf([free] {
            master::requireMemoryOfRaster({{"a", free}, {"a", free}, {"b", kGiB}},
                                          {16384, 16384, scene::NumberSize::doubles}, "s.toml");
        });
    };
    EXPECT_EQ(refusalOn(2 * kGiB), "nothing") << "the other ranks read nothing";
    EXPECT_EQ(refusalOn(kGiB),
              "s.toml: 16384 x 16384 pixels of a raster need at least 2.0 GiB for the one rank on a, where 1.0 GiB are "
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
