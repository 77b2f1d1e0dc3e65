// SPDX-License-Identifier: Apache-2.0
// The memory of a scene is checked before the scene is made. The tests use fixed sizes instead of this machine's
// memory.
#include <fmt/format.h>

#include <array>
#include <vector>

#include "scene/import/raster_memory.hpp"
#include "scene/load/memory.hpp"
#include "scene/load/sand_size.hpp"
#include "tests/support/files/scene_fixture.hpp"
#include "tests/support/refusal.hpp"

namespace {

constexpr std::int64_t kGigabyte = std::int64_t{1} << 30;

class SceneMemory : public SceneFile {
protected:
    /// Returns the loader's refusal while `free` bytes are free, or "nothing" if it loads.
    std::string refusalOn(std::int64_t free, const std::string& text) {
        const std::filesystem::path file = write("s.toml", text);
        return test::refusalOf([&] { (void)scene::loadScene(file, scene::checksOfOneReplica("s.toml", free)); });
    }
    /// Returns the checks that are called while a scene is loaded, in their order: "raster 3 x 2", "field 3 x 2", "TIN
    /// 3 x 2".
    std::vector<std::string> asked(const std::string& text) {
        std::vector<std::string> all;
        (void)scene::loadScene(
            write("s.toml", text),
            {.raster =
                 [&](const scene::RasterSize& size) {
                     all.push_back(fmt::format("raster {} x {}", size.columns, size.rows));
                 },
             .field =
                 [&](const sand::FieldSize& size) {
                     all.push_back(fmt::format("{} {} x {}", size.nominal ? "TIN" : "field", size.columns, size.rows));
                 }});
        return all;
    }
    static inline const std::string kRest = "[tool]\nradius = 1\n";
};

using Asked = std::vector<std::string>;

TEST_F(SceneMemory, OfOneReplicaIsComparedWithWhatIsFree) {
    const std::string field = "[field]\ncolumns = 4096\nrows = 4096\n[terrain]\n";
    EXPECT_EQ(refusalOn(kGigabyte / 4, field), "nothing") << "16 bytes a cell";
    EXPECT_EQ(refusalOn(kGigabyte / 4 - 1, field),
              "s.toml: 4096 x 4096 cells need at least 0.2 GiB, and 0.2 GiB are free: fewer cells, or a machine with "
              "more memory");
    EXPECT_EQ(refusalOn(kGigabyte / 16 - 1, field + "[tin]\n"),
              "s.toml: 4096 x 4096 nominal cells of a TIN need at least 0.1 GiB, and 0.1 GiB are free: fewer cells, or "
              "a machine with more memory");
}

TEST_F(SceneMemory, OfAServerIsThatOfAllSandMoving) {
    const std::string text = "[field]\ncolumns = 4096\nrows = 4096\n[terrain]\n" + kRest;
    const std::int64_t need = scene::ProcessMemory::ofServer({{4096, 4096, false}}).figures().most();
    EXPECT_GT(need, std::int64_t{24} * 4096 * 4096) << "with sand for an undo and the start";
    const auto refusalOfServer = [&](std::int64_t free, const std::string& scene) {
        const std::filesystem::path file = write("s.toml", scene);
        return test::refusalOf([&] { (void)scene::loadScene(file, scene::checksOfServer("s.toml", free)); });
    };
    EXPECT_EQ(refusalOfServer(need, text), "nothing");
    EXPECT_EQ(
        refusalOfServer(need - 1, text),
        fmt::format("s.toml: 4096 x 4096 cells need {0} in the haptic server, and {0} are free: fewer cells, or a "
                    "machine with more memory",
                    scene::bytesInWords(need)));
    const std::int64_t withRock = scene::ProcessMemory::ofServer({{4096, 4096, false}, true}).figures().most();
    EXPECT_GT(withRock, need);
    const std::string rock = "[field]\ncolumns = 4096\nrows = 4096\n[terrain]\nlayer = 1\n" + kRest;
    EXPECT_NE(refusalOfServer(withRock - 1, rock), "nothing");
}

TEST_F(SceneMemory, CountsTheSettlingOfASceneFile) {
    const std::string text = "[field]\ncolumns = 4096\nrows = 4096\n[terrain]\n";
    const auto still = scene::sizeOfScene(write("still.toml", text + kRest)),
               settles = scene::sizeOfScene(write("settles.toml", text + "settle = true\n" + kRest));
    EXPECT_FALSE(still->settles);
    EXPECT_TRUE(settles->settles);
    EXPECT_GE(scene::ProcessMemory::ofMaster(*settles).figures().peak, std::int64_t{90} * 4096 * 4096);
    EXPECT_LT(scene::ProcessMemory::ofMaster(*still).figures().peak, std::int64_t{60} * 4096 * 4096);
    scene::SizeCollector sizes;
    const scene::Scene small = scene::loadScene(
        write("small.toml", "[field]\ncolumns = 40\n[terrain]\nsettle = true\n" + kRest), sizes.checks());
    EXPECT_TRUE(sizes.of(small).settles);
}

TEST_F(SceneMemory, IsKnownBeforePixelsAreRead) {
    write("t.asc", "ncols 400\nnrows 300\ncellsize 1\nNODATA_value -1\n1 word\n");
    const auto size =
        scene::sizeOfScene(write("s.toml", "[terrain]\nkind = \"esri_ascii\"\nfile = \"t.asc\"\n" + kRest));
    ASSERT_TRUE(size);
    EXPECT_EQ(size->field, (sand::FieldSize{400, 300, false}));
    EXPECT_FALSE(size->ground) << "only the pixels tell whether there are walls";
    EXPECT_EQ(size->rasterBytes, 8 * 400 * 300);
    EXPECT_FALSE(scene::sizeOfScene(write("p.toml", "[terrain]\nkind = \"points\"\nfile = \"none.xyz\"\n")));
    EXPECT_THROW((void)scene::sizeOfScene(write("b.toml", "[terrain]\nkind = \"dem\"\nfile = \"none.tif\"\n")),
                 base::InputError);
}

TEST_F(SceneMemory, OfATinIsThatOfItsVertices) {
    scene::Scene scene;
    sand::tin::TinStart start;
    start.places.resize(1 << 20);
    scene.rules.columns = scene.rules.rows = 512;
    scene.tin = std::make_shared<const sand::tin::TinStart>(std::move(start));
    const auto refusal = [&](std::int64_t free) {
        return test::refusalOf([&] { scene::requireReplica(scene, "s.toml", free); });
    };
    EXPECT_EQ(refusal(kGigabyte), "nothing");
    EXPECT_EQ(refusal(kGigabyte / 4),
              "s.toml: a TIN's 1048576 vertices over 512 x 512 nominal cells need at least 0.3 GiB, and 0.2 GiB are "
              "free: fewer of either, or a machine with more memory");
}

// The file has a word where a pixel should be. Reading the word would be refused with another message.
TEST_F(SceneMemory, OfARasterIsAskedBeforeItsPixelsAreRead) {
    const std::string head = "ncols 4096\nnrows 4096\ncellsize 1\n";
    const std::string text = "[terrain]\nkind = \"esri_ascii\"\nfile = \"t.asc\"\n" + kRest;
    write("t.asc", head + "1 word\n");
    EXPECT_EQ(refusalOn(kGigabyte / 8 - 1, text),
              "s.toml: 4096 x 4096 pixels of a raster need at least 0.1 GiB, and 0.1 GiB are free: coarsen it, or take "
              "a machine with more memory");
    const std::string read = refusalOn(kGigabyte / 4, text);
    EXPECT_NE(read.find("t.asc:4: a height must be a finite number, got 'word'"), std::string::npos) << read;
}

TEST_F(SceneMemory, OfTheFieldIsAskedBeforeThePixelsWhereTheHeaderMarksNoData) {
    const std::string text = "[terrain]\nkind = \"esri_ascii\"\nfile = \"t.asc\"\n" + kRest;
    const auto refused = [&](const std::string& grid, const std::string& more) {
        write("t.asc", grid + "1 word\n");
        return test::refusalOf([&] {
            (void)scene::loadScene(write("s.toml", text + more),
                                   {.field = [](const sand::FieldSize& size) { throw base::InputError(size.text()); }});
        });
    };
    const std::string head = "ncols 4096\nnrows 4096\ncellsize 1\n";
    EXPECT_EQ(refused(head, ""), "4096 x 4096 cells");
    EXPECT_EQ(refused(head, "[tin]\n"), "4096 x 4096 nominal cells of a TIN");
    const std::string masked = refused(head + "NODATA_value -1\n", "");
    EXPECT_NE(masked.find("t.asc:5: a height must be"), std::string::npos)
        << "edges without data may be cut off, so that the size is still unknown: " << masked;
}

TEST_F(SceneMemory, IsAskedOnceOfEachRasterAndOfTheField) {
    const std::string head = "ncols 3\nnrows 2\ncellsize 1\n", text = "[terrain]\nkind = \"esri_ascii\"\nfile = ";
    write("t.asc", head + "1 1 1\n1 1 1\n");
    write("cut.asc", head + "NODATA_value -1\n-1 1 1\n-1 1 1\n");
    write("rock.asc", head + "0 0 0\n0 0 0\n");
    EXPECT_EQ(asked("[field]\ncolumns = 8\n[terrain]\n"), Asked{"field 8 x 8"});
    EXPECT_EQ(asked(text + "\"t.asc\"\n" + kRest), (Asked{"raster 3 x 2", "field 3 x 2"}));
    EXPECT_EQ(asked(text + "\"t.asc\"\n" + kRest + "[tin]\n"), (Asked{"raster 3 x 2", "TIN 3 x 2"}));
    EXPECT_EQ(asked(text + "\"cut.asc\"\n" + kRest), (Asked{"raster 3 x 2", "field 2 x 2"}));
    EXPECT_EQ(asked(text + "\"cut.asc\"\nbedrock = \"rock.asc\"\n" + kRest),
              (Asked{"raster 3 x 2", "field 3 x 2", "raster 3 x 2"}))
        << "with rock the edges are not cut off";
}

}  // namespace
