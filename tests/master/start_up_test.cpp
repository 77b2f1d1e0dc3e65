// SPDX-License-Identifier: Apache-2.0
#include "master/start_up.hpp"

#include <fmt/format.h>
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
#include "walls/window_size.hpp"

namespace {

constexpr std::int64_t kGiB = std::int64_t{1} << 30;

std::string refusal(const std::vector<lockstep::RankHost>& ranks, const scene::Scene& scene) {
    const walls::Wall wall;  // without pictures
    return test::refusalOf([&] { master::requireMemory(master::MemoryUse{ranks, wall}, scene, "s.toml"); });
}

std::string inGibibytes(std::int64_t bytes) { return fmt::format("{:.1f} GiB", static_cast<double>(bytes) / kGiB); }

/// Returns what the ranks of one host need together for this sand.
std::int64_t needOf(const scene::SandSize& sand, int renderRanks, bool master = true) {
    const auto rank = scene::ProcessMemory::ofRank(sand, 0);
    const std::int64_t ranks = renderRanks * (rank.figures().most() - rank.shared());
    const auto first = scene::ProcessMemory::ofMaster(sand);
    const std::int64_t own = master ? first.figures().most() - first.shared() : 0;
    return ranks + own + std::max(renderRanks > 0 ? rank.shared() : 0, master ? first.shared() : 0);
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
    scene.rules.tin = 1;
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
    const std::int64_t need = needOf(scene::SandSize::of(sceneOf(16384)), 2);
    EXPECT_GT(need, 16 * kGiB) << "16 bytes a cell and process were too few";
    EXPECT_EQ(refusal({{"a", need}, {"a", need}, {"a", need}}, sceneOf(16384)), "nothing");
    EXPECT_EQ(refusal({{"a", need - 1}, {"a", need}, {"a", need}}, sceneOf(16384)),
              "s.toml: 16384 x 16384 cells need " + inGibibytes(need) + " for the 3 ranks on a, where " +
                  inGibibytes(need - 1) + " are free; use fewer cells, or more hosts");
}

TEST(StartUp, AMasterWithoutCheckpointsNeedsLess) {
    const walls::Wall wall;
    const scene::SandSize sand{{4096, 4096, false}};
    const std::int64_t need = scene::ProcessMemory::ofMaster(sand, false).figures().most();
    const std::vector<lockstep::RankHost> ranks{{"a", need}};
    EXPECT_EQ(test::refusalOf([&] { master::requireMemory({ranks, wall, false}, sand, "s.toml"); }), "nothing");
    EXPECT_NE(test::refusalOf([&] { master::requireMemory({ranks, wall, true}, sand, "s.toml"); }), "nothing");
}

TEST(StartUp, CountsTheFrameBuffersOfEachTile) {
    walls::Wall wall = wallOf(1);
    wall.tiles[0].pixels = {8192, 8192};
    const scene::SandSize sand{{512, 512, false}};
    const std::int64_t need =
        scene::ProcessMemory::ofRank(sand, walls::frameBufferBytes(wall, wall.tiles[0])).figures().most();
    EXPECT_GT(need, 8 * std::int64_t{8192} * 8192);
    const std::vector<lockstep::RankHost> fits{{"a", kGiB}, {"b", need}}, lacks{{"a", kGiB}, {"b", need - 1}};
    EXPECT_EQ(test::refusalOf([&] { master::requireMemory({fits, wall}, sand, "s.toml"); }), "nothing");
    EXPECT_NE(test::refusalOf([&] { master::requireMemory({lacks, wall}, sand, "s.toml"); }), "nothing");
}

TEST(StartUp, RefusesATinWhoseVerticesDoNotFitTheMemory) {
    const scene::Scene tin = tinOf(512, 1 << 22);
    const std::int64_t need = needOf(scene::SandSize::of(tin), 1);
    EXPECT_GT(need, 2 * std::int64_t{320} << 22);
    EXPECT_EQ(refusal({{"a", need}, {"a", need}}, tin), "nothing");
    EXPECT_EQ(refusal({{"a", kGiB}, {"a", kGiB}}, tin),
              "s.toml: a TIN's 4194304 vertices over 512 x 512 nominal cells need " + inGibibytes(need) +
                  " for the 2 ranks on a, where 1.0 GiB are free; use fewer of either, or more hosts");
}

TEST(StartUp, RefusesATinWhoseNominalCellsDoNotFitTheMemoryOfThoseThatDraw) {
    const scene::Scene tin = tinOf(16384, 4);
    const std::int64_t need = needOf(scene::SandSize::of(tin), 3, false);
    EXPECT_GT(need, 3 * kGiB);
    EXPECT_EQ(refusal({{"a", 8 * kGiB}, {"b", need}, {"b", need}, {"b", need}}, tin), "nothing");
    EXPECT_EQ(refusal({{"a", 8 * kGiB}, {"b", 2 * kGiB}, {"b", 2 * kGiB}, {"b", 2 * kGiB}}, tin),
              "s.toml: a TIN's 4 vertices over 16384 x 16384 nominal cells need " + inGibibytes(need) +
                  " for the 3 ranks on b, where 2.0 GiB are free; use fewer of either, or more hosts");
}

TEST(StartUp, RefusesTheHeightsThatATinIsMadeOf) {
    const walls::Wall wall;
    const scene::SandSize sand{{16384, 16384, true}};
    const std::int64_t need = needOf(sand, 0);
    EXPECT_GT(need, kGiB) << "the heights alone are 1 GiB";
    const auto refusalOn = [&](std::int64_t free) {
        const std::vector<lockstep::RankHost> ranks{{"a", free}, {"b", 8 * kGiB}};
        return test::refusalOf([&] { master::requireMemory({ranks, wall}, sand, "s.toml"); });
    };
    EXPECT_EQ(refusalOn(need), "nothing");
    EXPECT_EQ(refusalOn(kGiB / 2),
              "s.toml: 16384 x 16384 nominal cells of a TIN need " + inGibibytes(need) +
                  " for the one rank on a, where 0.5 GiB are free; use fewer cells, or more hosts");
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
              "s.toml: 16384 x 16384 pixels of a raster need 2.0 GiB for the one rank on a, where 1.0 GiB are "
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
