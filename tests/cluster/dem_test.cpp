// SPDX-License-Identifier: Apache-2.0
// A terrain in a map projection as a TIN: imported, shown in a session, and exported again.
#include <cmath>

#include "scene/import/importer.hpp"
#include "tests/cluster/session_fixture.hpp"
#include "tests/support/processes/run_program.hpp"

namespace {

class Dem : public SessionTest {
protected:
    /// Returns hills of 24 m on cells of 10 m, at a place in UTM zone 33.
    [[nodiscard]] static scene::EsriGrid hills() {
        scene::EsriGrid grid;
        grid.columns = 96;
        grid.rows = 64;
        grid.cellSize = 10;
        grid.westEdge = 500000;
        grid.southEdge = 4649000;
        grid.units.crs =
            "PROJCS[\"zone 33\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,"
            "298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],"
            "PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"latitude_of_origin\",0],PARAMETER["
            "\"central_meridian\",15],PARAMETER[\"scale_factor\",0.9996],PARAMETER[\"false_easting\","
            "500000],PARAMETER[\"false_northing\",0],UNIT[\"metre\",1]]";
        grid.units.lengthMetres = grid.units.heightMetres = 1;
        grid.units.heightName = "m";
        for (int row = 0; row < grid.rows; ++row) {
            for (int column = 0; column < grid.columns; ++column) {
                grid.heights.add(1200 + 12 * std::sin(0.2 * column) * std::cos(0.15 * row));
            }
        }
        return grid;
    }
};

TEST_F(Dem, AsATinOverOneAndFourRanksIsOneAndGoesHome) {
    const scene::Importer& importer = scene::loadImporter("a test");
    const std::string file = (folder_ / "hills.tif").string(), home = (folder_ / "home.tif").string();
    const base::Bytes bytes = importer.geoTiff(hills(), file);
    write("hills.tif", std::string(bytes.begin(), bytes.end()));
    const std::string scene =
        write("dem.toml",
              "[terrain]\nkind = \"dem\"\nfile = \"hills.tif\"\ndatum = 1100\n[tin]\nmax_error = 0.5\nspacing = 10\n"
              "[material]\n[tool]\nradius = 40\n");
    const std::string recorded = (folder_ / "ticks.csv").string(), again = (folder_ / "again.csv").string();
    const auto play = [&](const std::string& wallFile) {
        const Ended ended = runToEnd({"--wall", wallFile, "--scene", scene, "--device", "script:gis", "--pace", "fast",
                                      "--steps", "90", "--out", out(), "--no-pictures", "--record", recorded});
        EXPECT_EQ(ended.status, 0) << ended.output;
    };
    play(wall(1, 1));
    ASSERT_FALSE(HasFailure());
    const std::string ofOne = summary()["state_hash"];
    play(wall(2, 2));
    ASSERT_FALSE(HasFailure());
    const nlohmann::json result = summary();
    EXPECT_EQ(result["state_hash"], ofOne);
    EXPECT_EQ(result["ranks"], 4);
    EXPECT_EQ(result["steps"], 90);
    EXPECT_EQ(result["divergences"], 0);
    EXPECT_EQ(result["server_divergences"], 0);
    EXPECT_EQ(result["volume_final"].get<std::int64_t>(), result["volume_initial"].get<std::int64_t>());
    ASSERT_EQ(result["terrain"].size(), 1U);
    EXPECT_EQ(result["terrain"][0]["across"], "metres");
    EXPECT_EQ(result["terrain"][0]["up_from"], "band");

    const support::Ran replayed = support::runProgram(
        "sandwall-replay", out() + "/session.journal --hash --heights " + home + " --forces " + again);
    EXPECT_EQ(replayed.status, 0);
    EXPECT_NE(replayed.output.find(result["state_hash"].get<std::string>() + "\n"), std::string::npos)
        << replayed.output;
    const std::string rows = read("ticks.csv"), same = read("again.csv");
    EXPECT_GT(std::count(same.begin(), same.end(), '\n'), 1000);
    EXPECT_NE(same.find(",1\n"), std::string::npos) << "the hand never touched the sand";
    EXPECT_TRUE(same == rows.substr(0, same.size())) << "the replay of the journal computes other forces";

    const scene::EsriGrid before = importer.readDem(file, {}), after = importer.readDem(home, {});
    EXPECT_EQ(after.units, before.units);
    EXPECT_EQ(after.westEdge, before.westEdge);
    EXPECT_EQ(after.southEdge, before.southEdge);
    EXPECT_EQ(after.cellSize, before.cellSize);
    ASSERT_EQ(after.heights.size(), before.heights.size());
    int moved = 0;
    for (std::size_t i = 0; i < before.heights.size(); ++i) {
        // The TIN follows the hills to half a metre, also after the session at places that the hand has not touched.
        moved += std::abs(after.heights[i] - before.heights[i]) > 1 ? 1 : 0;
    }
    EXPECT_GT(moved, 100);
    EXPECT_LT(moved, 96 * 64 / 2);
    EXPECT_NEAR(after.at(95, 63), before.at(95, 63), 0.51) << "a corner that the hand never touched";

    // A film and a resumed session read the journal instead of the raster.
    support::ChildProcess film({support::launcher(), "film", out() + "/session.journal", "--wall", wall(1, 1), "--out",
                                (folder_ / "film").string()},
                               folder_ / "film.txt");
    ASSERT_EQ(film.wait(300), 0) << film.output();
    nlohmann::json ofJournal = result["terrain"];
    ofJournal[0]["file"] = "hills.tif";  // a journal names no folder
    EXPECT_EQ(json("film/summary.json")["terrain"], ofJournal);
    const Ended resumed =
        runToEnd({"--wall", wall(1, 1), "--resume", "--scene", scene, "--device", "script:gis", "--pace", "fast",
                  "--steps", "92", "--out", out(), "--no-pictures", "--restarts", "0"});
    EXPECT_EQ(resumed.status, 0) << resumed.output;
    EXPECT_EQ(summary()["steps"], 92);
    EXPECT_EQ(summary()["terrain"], ofJournal);
    const std::string journal = read("out/session.journal");
    EXPECT_NE(journal.find("hills.tif"), std::string::npos);
    EXPECT_EQ(journal.find(folder_.string()), std::string::npos) << "a journal names files without folders";
}

}  // namespace
