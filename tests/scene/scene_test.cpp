// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "base/input_error.hpp"
#include "scene/import/esri_file.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/support/files/scene_fixture.hpp"

namespace {

TEST_F(SceneFile, DefaultsAreThePapersExceptTheTool) {
    const scene::Scene scene = scene::loadScene(write("s.toml", kFlat));
    EXPECT_EQ(scene.rules.columns, 512);
    EXPECT_EQ(scene.rules.rows, 512);
    EXPECT_DOUBLE_EQ(scene.terrain.cellSize(), 2.0 / 512);
    EXPECT_EQ(scene.rules.tuning.tool.radius, 3277) << "12.8 cells, 1/40 of the side";
    EXPECT_EQ(scene.rules.tuning.threshold, std::lround(std::tan(34 * std::numbers::pi / 180) * 65536));
    EXPECT_EQ(scene.rules.stepsPerSecond, 60);
}

long residentKilobytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
}

// 16384 x 16384 heights are 1 GiB. A host without that memory must report it before it makes the heights.
TEST_F(SceneFile, ItsSizeIsLookedAtBeforeItsHeightsAreMade) {
    const std::string huge = "[field]\ncolumns = 16384\nrows = 16384\n[material]\n";
    const long before = residentKilobytes();
    for (const char* kind : {"[terrain]\n", "[terrain]\nkind = \"dunes\"\n", "[terrain]\nkind = \"dunes\"\n[tin]\n"}) {
        bool isTin = false;
        const auto tooLarge = [&](const sand::FieldSize& size) {
            isTin = size.nominal;
            throw base::InputError(fmt::format("{} are too many", size.text()));
        };
        EXPECT_THROW((void)scene::loadScene(write("s.toml", huge + kind), {.field = tooLarge}), base::InputError)
            << kind;
        EXPECT_EQ(isTin, std::string(kind).ends_with("[tin]\n"));
    }
    EXPECT_LT(residentKilobytes() - before, 100'000);
}

TEST_F(SceneFile, ItsSizeIsLookedAtOnce) {
    write("t.asc", "ncols 3\nnrows 2\ncellsize 1\n0 0 0\n0 0 0\n");
    const std::string raster = "[terrain]\nkind = \"esri_ascii\"\nfile = \"t.asc\"\n[material]\n[tool]\nradius = 1\n";
    for (const std::string& text : {kFlat, kFlat + "[tin]\n", raster, raster + "[tin]\n"}) {
        std::vector<sand::FieldSize> asked;
        (void)scene::loadScene(write("s.toml", text),
                               {.field = [&](const sand::FieldSize& size) { asked.push_back(size); }});
        const bool flat = text.starts_with(kFlat);
        const sand::FieldSize wanted{flat ? 512 : 3, flat ? 512 : 2, text.ends_with("[tin]\n")};
        EXPECT_EQ(asked, std::vector{wanted}) << text;
    }
}

TEST_F(SceneFile, SweepsFollowTheSquareOfTheToolsCells) {
    const auto sweeps = [&](const std::string& radius) {
        return scene::loadScene(write("s.toml", kFlat + "[tool]\nradius = " + radius)).rules.tuning.sweepsPerStep;
    };
    EXPECT_EQ(sweeps("0.046875"), 24);  // 12 cells: 144 / (0.1 s * 60)
    EXPECT_NEAR(sweeps("0.09375"), 4 * 24, 3);
}

TEST_F(SceneFile, ErrorsNameFileLineKeyAndRange) {
    EXPECT_EQ(complaint(kFlat + "talus_deg = 90\n"), "s.toml:4: talus_deg must be within [0, 90), got 90");
    EXPECT_EQ(complaint(kFlat + "talus_deg = -1\n"), "s.toml:4: talus_deg must be within [0, 90), got -1");
    EXPECT_EQ(complaint(kFlat + "talus_deg = nan\n"), "s.toml:4: talus_deg must be a finite number");
    EXPECT_EQ(complaint("[field]\ncolumns = 0\n[terrain]\n[material]\n"),
              "s.toml:2: columns must be a whole number within [1, 16384], got 0");
    EXPECT_EQ(complaint("[field]\nwidth = -2\n[terrain]\n[material]\n"), "s.toml:2: width must be positive, got -2");
    EXPECT_EQ(
        complaint(kFlat + "talus = 3\n"),
        "s.toml:4: unknown key 'talus'; known here: band, cohesion_length, humidity, scheme, settling_time, talus_deg, "
        "wet_talus_deg");
    EXPECT_EQ(complaint("[field]\n[material]\n"), "s.toml:1: a table [terrain] is missing");
    EXPECT_NE(complaint("[terrain\n").find("s.toml:1: "), std::string::npos);
    EXPECT_EQ(complaint("[field]\n[terrain]\nheight = 1e9\n[material]\n").find("s.toml:3: a height of 1000000000"), 0U);
}

TEST_F(SceneFile, StepsPerSecondAreAWholeNumberWithinTheRangeThatTheMessageNames) {
    const auto said = [&](const std::string& value) { return complaint("steps_per_second = " + value + "\n" + kFlat); };
    const std::string range = "s.toml:1: steps_per_second must be a whole number within [1, 1000]";
    for (const std::string value : {"0.5", "0", "-3", "1001", "59.94"}) {
        EXPECT_EQ(said(value), fmt::format("{}, got {}", range, value));
    }
    EXPECT_EQ(said("\"sixty\""), range);
    for (const std::string value : {"1", "1000"}) {
        EXPECT_EQ(said(value), "accepted") << value;
    }
}

TEST_F(SceneFile, WithoutAMaterialIsDrySand) {
    const scene::Scene without = scene::loadScene(write("s.toml", "name = \"s\"\n[field]\n[terrain]\n"));
    const scene::Scene empty = scene::loadScene(write("e.toml", "name = \"s\"\n" + kFlat));
    EXPECT_EQ(without.encode(), empty.encode());
    EXPECT_EQ(without.rules.scheme, sand::Scheme::isotropic);
}

TEST_F(SceneFile, UnknownSchemesAreRefusedWithTheKnownOnes) {
    EXPECT_EQ(complaint(kFlat + "talus_deg = 34\nscheme = \"n4\"\n"),
              "s.toml:5: scheme must be one of g, g_plain, got 'n4'");
    for (const auto& known : valuesOf(sand::Scheme{})) {
        const std::string text = fmt::format("{}scheme = \"{}\"\n", kFlat, known.name);
        EXPECT_EQ(scene::loadScene(write("s.toml", text)).rules.scheme, known.value) << known.name;
    }
}

TEST_F(SceneFile, WithoutARadiusHasAToolThatCanBeSeenAndFollowsTheHand) {
    struct Size {
        int columns, rows;
        double cells;
    };
    for (const auto& [columns, rows, cells] :
         {Size{12, 8, 2}, Size{80, 80, 2}, Size{81, 90, 2.025}, Size{5120, 6000, 128}, Size{16384, 5119, 127.975}}) {
        EXPECT_DOUBLE_EQ(scene::usualToolRadius(columns, rows, 0.5), cells * 0.5) << columns << " x " << rows;
    }
    const std::string text =
        "[field]\ncolumns = 200\nrows = 100\nwidth = 1\n[terrain]\n[material]\n[tool]\nshape = \"circle\"\n";
    const scene::Scene scene = scene::loadScene(write("s.toml", text));
    EXPECT_DOUBLE_EQ(scene.material.toolRadius, 2.5 / 200);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(SceneFile, AToolOutOfScaleIsRefusedOrWarnedOf) {
    EXPECT_EQ(complaint("[field]\ncolumns = 3\nrows = 3\n[terrain]\n[tool]\nshape = \"footprint\"\n")
                  .find("s.toml:5: a footprint of radius 1.3333333333333333 is"),
              0U);
    EXPECT_EQ(complaint(kFlat + "[tool]\nradius = 10\n").find("s.toml:5: a tool of radius 10 is 2560 cells"), 0U);
    EXPECT_EQ(scene::loadScene(write("s.toml", kFlat + "[tool]\nradius = 0.003\n")).warnings.size(), 1U);
}

TEST_F(SceneFile, AToolHasAShapeAWidthAndAHeading) {
    const scene::Scene scene = scene::loadScene(
        write("s.toml", kFlat + "[tool]\nshape = \"footprint\"\nradius = 0.1\nheading_deg = 90\nfoot = \"left\"\n"));
    EXPECT_EQ(scene.rules.tuning.tool,
              (sand::Tool{sand::ToolKind::footprint, 6554, 2622, {0, sand::Heading::kLength, true}}));
    EXPECT_EQ(scene::Scene::decode(scene.encode()).rules, scene.rules);
    const scene::Scene plain = scene::loadScene(write("p.toml", kFlat + "[tool]\nshape = \"sphere\"\nradius = 0.1\n"));
    EXPECT_NE(plain.rules.digest(), scene.rules.digest()) << "server and master must have the same tool";
    EXPECT_EQ(scene.encode().size(), plain.encode().size()) << "every tool has all of its members";
    const auto tool = [&](const std::string& keys) { return complaint(kFlat + "[tool]\n" + keys); };
    EXPECT_EQ(tool("shape = \"cube\"\n"), fmt::format("s.toml:5: shape must be one of {}, got 'cube'",
                                                      fmt::join(base::namesOf<sand::ToolKind>(), ", ")));
    EXPECT_EQ(tool("shape = \"ellipse\"\nwidth = 2\n"), "s.toml:6: width must be within [0.05, 1], got 2");
    EXPECT_EQ(tool("width = 0.5\n"), "s.toml:5: a sphere is as wide as it is long; leave width out");
    EXPECT_EQ(tool("heading_deg = nan\n"), "s.toml:5: heading_deg must be a finite number");
    EXPECT_EQ(tool("shape = \"ellipse\"\nfoot = \"left\"\n"),
              "s.toml:6: only a footprint is left or right, not this ellipse");
    EXPECT_EQ(tool("shape = \"footprint\"\nradius = 1.5\n"),
              "s.toml:6: a footprint of radius 1.5 is 3 long, but the field only 2");
}

TEST_F(SceneFile, ALevelOfDetailThatCannotHoldItsErrorIsRefused) {
    EXPECT_EQ(scene::loadScene(write("s.toml", kFlat + "[look]\ndetail = 0\n")).look.detail, 0);
    const scene::Scene scene = scene::loadScene(write("s.toml", kFlat + "[look]\ndetail = 2.5\n"));
    EXPECT_EQ(scene::Scene::decode(scene.encode()).look.detail, 2.5);
    for (const std::string bound : {"-1", "nan", "inf", "0.001", "1000"}) {
        const std::string said = complaint(fmt::format("{}[look]\ndetail = {}\n", kFlat, bound));
        EXPECT_EQ(said.rfind("s.toml:5: detail must be ", 0), 0U) << bound << ": " << said;
    }
}

TEST_F(SceneFile, AMissingFileIsNamed) {
    EXPECT_THROW((void)scene::loadScene(folder_ / "none.toml"), base::InputError);
}

TEST_F(SceneFile, AFlatTalusWarns) {
    EXPECT_EQ(scene::loadScene(write("s.toml", kFlat + "talus_deg = 3\n")).warnings.size(), 1U);
    EXPECT_TRUE(scene::loadScene(write("s.toml", kFlat + "talus_deg = 4\n")).warnings.empty());
}

TEST_F(SceneFile, LoadsAnEsriGridFromTheNorth) {
    write("t.asc", "NCOLS 3\nnrows 2\nxllcorner 5\nyllcorner 6\ncellsize 10\nNODATA_value -9999\n1 2 3\n4 5 6.5\n");
    const scene::Scene scene = scene::loadScene(
        write("s.toml", "[terrain]\nkind = \"esri_ascii\"\nfile = \"t.asc\"\n[material]\n[tool]\nradius = 5\n"));
    EXPECT_EQ(scene.rules.columns, 3);
    EXPECT_EQ(scene.rules.rows, 2);
    EXPECT_EQ(scene.terrain.height(2, 0), 42598);  // 6.5 / 10 * 65536, south-east
    EXPECT_EQ(scene.terrain.height(0, 1), 6554);   // 1 / 10, north-west
}

TEST_F(SceneFile, EsriGridErrorsNameTheGridsLine) {
    const auto complaintOf = [&](const std::string& grid) {
        write("t.asc", grid);
        return complaint("[terrain]\nkind = \"esri_ascii\"\nfile = \"t.asc\"\n[material]\n");
    };
    EXPECT_EQ(complaintOf("ncols 2\nnrows 2\ncellsize 1\n1 2\n3\n"), "t.asc:6: the file ends where a height should be");
    EXPECT_EQ(complaintOf("ncols 1\nnrows 1\ndx 2\ndy 3\n1\n"),
              "s.toml:3: " + (folder_ / "t.asc").string() +
                  " has cells of 2 x 3; a scene's are square; resample it: gdalwarp -tr 2 2 -r bilinear");
    EXPECT_EQ(complaintOf("nodata_value -1\nncols 1\nnrows 1\ncellsize 1\n-1\n"),
              "t.asc: every cell is a no-data cell; there is no terrain in it");
    EXPECT_EQ(complaintOf("depth 3\n"), "t.asc:1: 'depth' is not a key of an ESRI ASCII grid");
}

TEST_F(SceneFile, TakesColoursAsLinearLightAndAsImageProgramsWriteThem) {
    const scene::Scene scene =
        scene::loadScene(write("s.toml", kFlat + "[look]\nsand = \"#c8B48c\"\nbackground = [0, 0.5, 1]\n"));
    // ((level / 255 + 0.055) / 1.055)^2.4
    const std::vector<double> sand{0.577580, 0.456411, 0.262251};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(scene.look.sandColour[i], sand[i], 1e-6);
    }
    EXPECT_EQ(scene.look.backgroundColour, (std::vector<double>{0, 0.5, 1}));
    const auto black = scene::loadScene(write("s.toml", kFlat + "[look]\nsand = \"#000a00\"\n"));
    EXPECT_NEAR(black.look.sandColour[1], 10 / 255.0 / 12.92, 1e-12) << "the straight part of the curve";
    EXPECT_EQ(complaint(kFlat + "[look]\nbackground = [20, 30, 40]\n"),
              "s.toml:5: background must be three numbers from 0 to 1, got 20; divide by 255");
    EXPECT_EQ(complaint(kFlat + "[look]\nsand = [0.5, 300, 0.5]\n"),
              "s.toml:5: sand must be three numbers from 0 to 1, got 300");
    EXPECT_EQ(complaint(kFlat + "[look]\nsand = [0.5, -0.1, 0.5]\n"),
              "s.toml:5: sand must be three numbers from 0 to 1, got -0.1");
    for (const std::string wrong : {"sandy", "#c8b48", "#c8b48g", "#-8b48c", "c8b48c0", "#c8b48c0"}) {
        EXPECT_EQ(
            complaint(fmt::format("{}[look]\nsand = \"{}\"\n", kFlat, wrong)),
            fmt::format("s.toml:5: sand must be a colour such as \"#c8b48c\", or three numbers from 0 to 1, got '{}'",
                        wrong));
    }
}

TEST_F(SceneFile, FlatShadingSurvivesItsEncodingAndIsNoHillShade) {
    const scene::Scene scene = scene::loadScene(write("s.toml", kFlat + "[look]\nshading = \"flat\"\n"));
    const scene::Look look = scene::Scene::decode(scene.encode()).look;
    EXPECT_TRUE(look.flatShading);
    EXPECT_FALSE(look.hillShade);
}

TEST_F(SceneFile, ShadedLikeAMapSurvivesItsEncoding) {
    const scene::Scene scene = scene::loadScene(write("s.toml", kFlat + "[look]\nhill_shade = true\n"));
    EXPECT_FALSE(scene::Scene::decode(scene.encode()).look.flatShading);
    EXPECT_TRUE(scene::Scene::decode(scene.encode()).look.hillShade);
    EXPECT_EQ(complaint(kFlat + "[look]\nhill_shade = 1\n").rfind("s.toml:5: hill_shade must be", 0), 0U)
        << complaint(kFlat + "[look]\nhill_shade = 1\n");
}

TEST_F(SceneFile, AnEncodingThatIsCutAnywhereIsRefused) {
    scene::Scene scene = scene::loadScene(write("s.toml", kFlat));
    const base::Bytes bytes = scene.encode();
    EXPECT_NO_THROW((void)scene::Scene::decode(bytes));
    ASSERT_GT(bytes.size(), 100U) << "there is something to cut";
    scene.statements.reset();
    const std::size_t whole = scene.encode().size();  // without the last part, as an earlier build has written it
    EXPECT_NO_THROW((void)scene::Scene::decode(std::span(bytes).first(whole)));
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        if (length == whole) {
            continue;
        }
        EXPECT_THROW((void)scene::Scene::decode(std::span(bytes).first(length)), base::FormatError) << length;
    }
}

TEST_F(SceneFile, WhatItsFilesMeanSurvivesItsEncoding) {
    write("t.asc", "ncols 2\nnrows 2\ncellsize 1\nNODATA_value -1\n1 2\n-1 4\n");
    const std::string text = "[material]\n[tool]\nradius = 1\n[terrain]\nkind = \"esri_ascii\"\nfile = \"t.asc\"\n";
    const scene::Scene scene = scene::loadScene(write("s.toml", text));
    ASSERT_EQ(scene.statements.value().size(), 1U);
    EXPECT_EQ(scene.statements->front().noData, "-1");
    const base::Bytes bytes = scene.encode();
    scene::RasterStatement named = scene.statements->front();
    named.file = "t.asc";
    EXPECT_EQ(scene::Scene::decode(bytes).statements, std::vector{named});
    EXPECT_EQ(scene::loadScene(write("flat.toml", kFlat)).statements.value().size(), 0U) << "no files";

    // An earlier build has written neither part nor its length.
    scene::Scene old = scene;
    old.statements.reset();
    const base::Bytes before = old.encode();
    ASSERT_LT(before.size(), bytes.size());
    EXPECT_TRUE(std::equal(before.begin(), before.end(), bytes.begin()));
    EXPECT_EQ(scene::Scene::decode(before).statements, std::nullopt);
    EXPECT_EQ(scene::Scene::decode(before).encode(), before);

    // Another path, or an earlier build, may have read the same scene.
    scene::Scene moved = scene;
    moved.statements->front().file = "elsewhere/t.asc";
    scene::Scene other = scene;
    other.terrain.setHeight(1, 1, scene.terrain.height(1, 1) + 1);
    for (const scene::Scene* same : std::array<const scene::Scene*, 3>{&scene, &old, &moved}) {
        const scene::SceneIdentity identity(*same);
        EXPECT_TRUE(identity.isOf(scene::Scene::decode(bytes)));
        EXPECT_TRUE(identity.isOf(scene::Scene::decode(before)));
        EXPECT_FALSE(identity.isOf(scene::Scene::decode(other.encode())));
    }
    scene::Scene placed = scene;
    placed.georeference.west = 7;
    const scene::SceneIdentity identity(scene);
    EXPECT_FALSE(identity.isOf(placed));
    EXPECT_FALSE(scene::SceneIdentity(placed).isOf(scene));
    for (const auto change :
         {+[](scene::Scene& it) { it.rules.ground = 1; }, +[](scene::Scene& it) { it.rules.tin = 1; },
          +[](scene::Scene& it) { it.look.detail = 2; }, +[](scene::Scene& it) { it.name = "z"; }}) {
        scene::Scene changed = scene;
        change(changed);
        EXPECT_FALSE(identity.isOf(changed));
    }
}

// A journal begins with these bytes, and is given to other people.
TEST_F(SceneFile, AnEncodedSceneNamesItsFilesWithoutTheirFolders) {
    write("t.asc", "ncols 2\nnrows 2\ncellsize 1\n1 2\n3 4\n");
    const std::string text =
        "[material]\n[tool]\nradius = 1\n[terrain]\nkind = \"esri_ascii\"\nfile = \"t.asc\"\nbedrock = \"t.asc\"\n";
    scene::Scene scene = scene::loadScene(write("s.toml", text));
    ASSERT_EQ(scene.statements.value().size(), 2U);
    EXPECT_NE(scene.statements->front().file, "t.asc") << "messages have the whole path";
    scene.statements->push_back(scene.statements->front());
    scene.statements->back().file = "NETCDF:\"/home/somebody/t.nc\":z";
    scene.statements->push_back(scene.statements->front());
    scene.statements->back().file = "folder/";
    const base::Bytes bytes = scene.encode();
    const std::string all(bytes.begin(), bytes.end());
    for (const std::string& folder : {folder_.string(), std::string("somebody"), std::string("folder/")}) {
        EXPECT_EQ(all.find(folder), std::string::npos) << folder;
    }
    std::vector<std::string> files;
    const scene::Scene read = scene::Scene::decode(bytes);
    for (const scene::RasterStatement& statement : read.statements.value()) {
        files.push_back(statement.file);
    }
    EXPECT_EQ(files, (std::vector<std::string>{"t.asc", "t.asc", "t.nc\":z", ""}));
    EXPECT_EQ(scene::Scene::decode(bytes).encode(), bytes);
}

// Five texts behind their lengths, a 1 and a text, and the double 0.5.
TEST_F(SceneFile, WhatAFileMeansHasTheBytesOfAJournal) {
    const base::Bytes expected{1, 0, 0, 0, 'f', 1,   0, 0, 0, 'a', 2, 0,   0,   0, 'a', 'b', 1, 0, 0, 0,    'u',
                               2, 0, 0, 0, 'u', 'v', 1, 2, 0, 0,   0, '-', '1', 0, 0,   0,   0, 0, 0, 0xe0, 0x3f};
    const scene::RasterStatement statement{"f", "a", "ab", "u", "uv", "-1", 0.5};
    EXPECT_EQ(base::encoded(statement), expected);
    EXPECT_EQ(base::decoded<scene::RasterStatement>(expected), statement);
}

TEST_F(SceneFile, EverySceneOfTheProjectLoadsAndSurvivesItsEncoding) {
    std::set<std::string> scenes;
    for (const auto& entry : std::filesystem::directory_iterator(SANDWALL_SOURCE_DIR "/scenes")) {
        const scene::Scene scene = scene::loadScene(entry.path());
        const scene::Scene copy = scene::Scene::decode(scene.encode());
        EXPECT_EQ(copy.rules, scene.rules) << entry.path();
        EXPECT_EQ(copy.rules.digest(), scene.rules.digest());
        EXPECT_TRUE(sameHeights(copy.terrain, scene.terrain)) << entry.path();
        EXPECT_EQ(scene.force.depthExponent, 0.5) << entry.path() << " is small enough for the default";
        scenes.insert(entry.path().filename().string());
    }
    // The loop has loaded each kind: a level field, a field of dunes, and a TIN.
    for (const char* name : {"sandbox.toml", "dunes.toml", "gis_tin.toml"}) {
        EXPECT_TRUE(scenes.contains(name)) << name << " was not loaded";
    }
}

}  // namespace
