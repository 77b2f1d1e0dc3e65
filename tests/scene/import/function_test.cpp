// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include "scene/model/scene.hpp"
#include "tests/scene/import/import_fixture.hpp"

namespace {

std::string function(const std::string& z, const std::string& field = "columns = 4") {
    return "[field]\n" + field + "\n[terrain]\nkind = \"function\"\nx = [-1, 1]\ny = [0, 1]\nz = \"" + z + "\"";
}

TEST_F(Import, AFunctionIsEvaluatedInTheMiddleOfEveryCell) {
    const scene::Scene scene = load(function("x + 10*y"));
    ASSERT_EQ(scene.terrain.columns(), 4);
    ASSERT_EQ(scene.terrain.rows(), 2) << "cells are square";
    EXPECT_EQ(scene.terrain.cellSize(), 0.5);
    EXPECT_EQ(scene.terrain.height(0, 0), (-0.75 + 2.5) / 0.5 * sand::kUnitsPerCell);
    EXPECT_EQ(scene.terrain.height(3, 1), (0.75 + 7.5) / 0.5 * sand::kUnitsPerCell);
    EXPECT_EQ(scene.georeference.west, -1);
}

// The function has no finite value anywhere. Evaluating it first would give another message.
TEST_F(Import, AFunctionsSizeIsLookedAtBeforeItIsEvaluated) {
    const std::string file = write("s.toml", text(function("sqrt(-1)", "columns = 400")));
    const auto tooLarge = [](const sand::FieldSize& size) { throw std::length_error(size.text()); };
    EXPECT_THROW((void)scene::loadScene(file, {.field = tooLarge}), std::length_error);
    int asked = 0;
    (void)scene::loadScene(write("s.toml", text(function("x"))), {.field = [&](const sand::FieldSize&) { ++asked; }});
    EXPECT_EQ(asked, 1);
}

TEST_F(Import, FunctionsThatAreNoneSayWhere) {
    EXPECT_EQ(refusal(function("sin(x")), "s.toml:7: z = \"sin(x\": at its end: Missing parenthesis");
    EXPECT_EQ(refusal(function("2*(x + w)")), "s.toml:7: z = \"2*(x + w)\": character 8: Unexpected token \"w\"");
    EXPECT_EQ(refusal(function("")), "s.toml:7: z = \"\": Expression is empty.");
    EXPECT_EQ(refusal(function("y = x")),
              "s.toml:7: z = \"y = x\": character 3: write the expression alone; == compares");
    EXPECT_EQ(refusal(function("x, y")), "s.toml:7: z = \"x, y\": expected one height, but a comma gives several");
    EXPECT_EQ(refusal(function("sqrt(x)")), "s.toml:7: z = \"sqrt(x)\": z is not a number at x = -0.75, y = 0.75");
    EXPECT_EQ(refusal(function("1 / (x - 0.25)")),
              "s.toml:7: z = \"1 / (x - 0.25)\": z is infinite at x = 0.25, y = 0.75");
}

TEST_F(Import, AFunctionsCellsAreSquare) {
    EXPECT_EQ(
        refusal(function("x", "columns = 5")),
        "s.toml:6: 5 columns make cells of 0.4, and y is 2.5 of them long; that must be a whole number within [1, "
        "16384]");
    EXPECT_EQ(refusal(function("x", "columns = 4\nrows = 3")),
              "s.toml:3: 4 columns of x make 2 rows of y; leave rows out");
    EXPECT_EQ(refusal(function("x", "columns = 4\nwidth = 2")), "s.toml:3: a function's width is that of its x");
    EXPECT_EQ(refusal("[field]\n[terrain]\nkind = \"function\"\nx = [1, 0]\ny = [0, 1]\nz = \"x\""),
              "s.toml:4: x must go from less to more, got [1, 0]");
}

}  // namespace
