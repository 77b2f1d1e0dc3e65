// SPDX-License-Identifier: Apache-2.0
// Numbers that sand cannot have: the error names file, line, key and range.
#include <gtest/gtest.h>

#include <limits>

#include "scene/load/scene_file.hpp"
#include "tests/support/files/scene_fixture.hpp"

namespace {

using ExtremeInput = SceneFile;

TEST_F(ExtremeInput, AnglesEndBelow90Degrees) {
    const auto thresholdAt = [&](const std::string& degrees) {
        return scene::loadScene(write("s.toml", kFlat + "band = 0\ntalus_deg = " + degrees + "\n"))
            .rules.tuning.threshold;
    };
    EXPECT_EQ(thresholdAt("0"), 0);
    EXPECT_EQ(thresholdAt("45"), sand::kUnitsPerCell);
    EXPECT_NEAR(thresholdAt("89.9"), 572.957 * sand::kUnitsPerCell, sand::kUnitsPerCell);
    EXPECT_NEAR(thresholdAt("89.99"), 5729.578 * sand::kUnitsPerCell, sand::kUnitsPerCell);
    EXPECT_EQ(thresholdAt("89.9999999999"), 1 << 30) << "larger than any difference of heights";
    for (const auto* angle : {"90", "90.0001", "1e300", "-1e-9", "inf", "-inf", "nan"}) {
        EXPECT_EQ(complaint(kFlat + "talus_deg = " + angle + "\n").find("s.toml:4: talus_deg must be "), 0U) << angle;
    }
}

TEST_F(ExtremeInput, HeightsBeyondTheRangeAreRefusedWithIt) {
    const std::string range = "is beyond the range of ±16 (4096 cells)";
    for (const auto* height : {"1e9", "-1e9", "16.001", "1e308"}) {
        const std::string line = complaint("[field]\n[terrain]\nheight = " + std::string(height) + "\n[material]\n");
        EXPECT_EQ(line.find("s.toml:3: "), 0U) << line;
        EXPECT_NE(line.find(range), std::string::npos) << line;
    }
    EXPECT_EQ(complaint("[field]\n[terrain]\nheight = 16\n[material]\n"), "accepted");
    EXPECT_EQ(complaint("[field]\n[terrain]\nheight = -16\n[material]\n"), "accepted");
    const std::string dunes =
        complaint("[field]\n[terrain]\nkind = \"dunes\"\nheight = 15.99\ndune_height = 0.02\n[material]\n");
    EXPECT_NE(dunes.find(range), std::string::npos) << dunes;
    for (const auto* number : {"nan", "inf", "-inf"}) {
        EXPECT_EQ(complaint("[field]\n[terrain]\nheight = " + std::string(number) + "\n[material]\n"),
                  "s.toml:3: height must be a finite number");
    }
}

TEST_F(ExtremeInput, HeightsBelowHalfAUnitAreLevel) {
    const scene::Scene scene = scene::loadScene(write("s.toml", "[field]\n[terrain]\nheight = 2.9e-8\n[material]\n"));
    EXPECT_EQ(scene.terrain.volume(), 0) << "a unit is 2 / 512 / 65536 = 6.0e-8";
}

TEST_F(ExtremeInput, GridsOfNoNumbersAreRefused) {
    const auto complaintOf = [&](const std::string& header, const std::string& value) {
        write("t.asc", header + "1 2\n3 " + value + "\n");
        return complaint("[terrain]\nkind = \"esri_ascii\"\nfile = \"t.asc\"\n[material]\n[tool]\nradius = 4\n");
    };
    const std::string head = "ncols 2\nnrows 2\ncellsize 1\n";
    EXPECT_EQ(complaintOf(head, "4"), "accepted");
    for (const std::string value : {"nan", "NaN", "inf", "-inf", "1e999", "0x4", "4,5", "-"}) {
        EXPECT_EQ(complaintOf(head, value), "t.asc:5: a height must be a finite number, got '" + value + "'" +
                                                (value == "4,5" ? "; write a decimal point" : ""));
    }
    const std::string tall = complaintOf(head, "1e9");
    EXPECT_NE(tall.find("a height of 1000000000 is beyond the range of ±4096 (4096 cells)"), std::string::npos) << tall;
    for (const auto* size : {"0", "-1", "nan", "inf"}) {
        EXPECT_EQ(complaintOf("ncols 2\nnrows 2\ncellsize " + std::string(size) + "\n", "4").find("t.asc:"), 0U)
            << size;
    }
}

TEST_F(ExtremeInput, SidesBeyondTheLargestAreRefused) {
    EXPECT_EQ(complaint("[field]\ncolumns = 16385\n[terrain]\n[material]\n"),
              "s.toml:2: columns must be a whole number within [1, 16384], got 16385");
    EXPECT_EQ(complaint("[field]\ncolumns = 8\nrows = -3\n[terrain]\n[material]\n"),
              "s.toml:3: rows must be a whole number within [1, 16384], got -3");
    write("t.asc", "ncols 16385\nnrows 1\ncellsize 1\n0\n");
    EXPECT_EQ(complaint("[terrain]\nkind = \"esri_ascii\"\nfile = \"t.asc\"\n[material]\n"),
              "t.asc:1: ncols must be a whole number within [1, 16384], got 16385");
}

TEST_F(ExtremeInput, RulesOutOfRangeAreRefusedOnTheWire) {
    sand::Rules rules = scene::loadScene(write("s.toml", kFlat)).rules;
    const auto accepted = [](const sand::Rules& sent) {
        try {
            return base::decoded<sand::Rules>(base::encoded(sent)) == sent;
        } catch (const base::FormatError&) {
            return false;
        }
    };
    EXPECT_TRUE(accepted(rules));
    for (std::int32_t sand::Rules::*number :
         {&sand::Rules::columns, &sand::Rules::rows, &sand::Rules::aspect, &sand::Rules::stepsPerSecond}) {
        sand::Rules bad = rules;
        bad.*number = 0;
        EXPECT_FALSE(accepted(bad));
        bad.*number = -1;
        EXPECT_FALSE(accepted(bad));
    }
    sand::Rules wide = rules;
    wide.columns = sand::kMaxSide + 1;
    EXPECT_FALSE(accepted(wide));
    for (unsigned number = 0; number < 128; ++number) {
        for (const std::uint64_t tin : {0U, 7U}) {
            sand::Rules sent = rules;
            sent.scheme = static_cast<sand::Scheme>(number);
            sent.tin = tin;
            EXPECT_EQ(accepted(sent), number == 0 || number == 2) << "scheme " << number << ", TIN " << tin;
        }
    }
}

}  // namespace
