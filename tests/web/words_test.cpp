// SPDX-License-Identifier: Apache-2.0
#include "web/words.hpp"

#include <gtest/gtest.h>

#include "base/input_error.hpp"
#include "web/replica/json_text.hpp"

namespace {

TEST(PageWords, HaveEveryToolNumberAndEdit) {
    const std::string words = web::wordsOfPage();
    for (const auto& known : valuesOf(sand::ToolKind{})) {
        EXPECT_NE(words.find(web::quotedText(known.name)), std::string::npos) << words;
    }
    for (const scene::MaterialKey& key : scene::materialKeys()) {
        EXPECT_NE(words.find("{\"word\":" + web::quotedText(key.word) + ","), std::string::npos) << words;
    }
    EXPECT_NE(words.find(R"({"word":"talus","lowest":0,"highest":90})"), std::string::npos) << words;
    EXPECT_NE(words.find(R"("edits":["settle","reset","undo","redo"])"), std::string::npos) << words;
    EXPECT_NE(words.find(R"("depth":{"lowest":0.1,"highest":2,"usual":0.5,"notch":0.1})"), std::string::npos) << words;
}

TEST(PageWords, TellTheMaterialAndThePartsOfItsTool) {
    scene::Material material;
    material.humidity = 0.25;
    EXPECT_EQ(
        web::materialText(material),
        R"({"material":{"talus":34,"wet-talus":45,"humidity":0.25,"cohesion":0,"band":0.001,"settling-time":0.1},)"
        R"("tool":{"kind":"sphere","radius":0.01}})");
    material.toolKind = sand::ToolKind::footprint;
    material.toolHeading = -7.5;
    material.leftFoot = true;
    const std::string text = web::materialText(material);
    EXPECT_NE(text.find(R"({"kind":"footprint","radius":0.01,"width":0.4,"heading":-7.5,"foot":"left"})"),
              std::string::npos)
        << text;
}

TEST(PageWords, ChangeEachPartOfTheTool) {
    EXPECT_EQ(web::toolChange("kind", "ellipsoid").kind, sand::ToolKind::ellipsoid);
    EXPECT_EQ(web::toolChange("radius", "0.5").radius, 0.5);
    EXPECT_EQ(web::toolChange("width", "0.25").width, 0.25);
    EXPECT_EQ(web::toolChange("heading", "-30").heading, -30);
    EXPECT_EQ(web::toolChange("foot", "left").leftFoot, true);
    EXPECT_EQ(web::toolChange("foot", "right").leftFoot, false);
    EXPECT_EQ(web::toolChange("width", "1").kind, std::nullopt);
    using Change = std::pair<const char*, const char*>;
    for (const auto& [part, value] : {Change{"kind", "spoon"}, Change{"kind", "left"}, Change{"foot", "both"},
                                      Change{"weight", "sphere"}, Change{"radius", "wide"}, Change{"heading", ""}}) {
        EXPECT_THROW((void)web::toolChange(part, value), base::InputError) << part << ' ' << value;
    }
}

TEST(PageWords, NameOnlyEditsThatNeedNothingElse) {
    EXPECT_EQ(web::editNamed("undo").kind, sand::Edit::undo);
    for (const char* name : {"", "tune", "load", "dig"}) {
        EXPECT_THROW((void)web::editNamed(name), base::InputError) << name;
    }
}

TEST(JsonText, EscapesWhatATextMayHave) {
    EXPECT_EQ(web::jsonOf(std::string("a \"b\\\n\x01")), R"("a \"b\\\u000a\u0001")");
    EXPECT_EQ(web::jsonOf(std::string("höhe")), "\"höhe\"");
    EXPECT_EQ(web::jsonOf(std::vector{1, -2}), "[1,-2]");
    EXPECT_EQ(web::jsonOf(true), "true");
}

}  // namespace
