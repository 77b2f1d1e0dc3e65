// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "pictures/png_file.hpp"
#include "render_node/gl/gl_context.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/pictures/golden_pictures.hpp"
#include "tests/support/pictures/wall_painter.hpp"

namespace {

using pictures::Image;
using pictures::Mask;

/// Pictures of one wall, and the tool's pixels in them.
struct WallPictures {
    Image engaged;   // the golden picture's scene: a red ball in the sand
    Image hovering;  // the same ball at the same place, of steel
    Image without;   // the same sand without a ball
    Mask part;       // pixels that are compared separately for the tool
};

/// Returns the names of all golden pictures of walls.
std::set<std::string> goldens() {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(golden::folder("golden"))) {
        names.insert(entry.path().stem().string());
    }
    return names;
}

class GoldenWalls : public testing::Test {
protected:
    /// Calls `check` with every wall file, at reduced size, and with the sand on it. Returns the number of wall files.
    std::size_t forEachWall(const std::function<void(const std::string&, const walls::Wall&)>& check) {
        std::size_t count = 0;
        for (const std::string& name : sample::wallNames()) {
            SCOPED_TRACE(name);
            check(name,
                  sample::smallWall(walls::loadWall(sample::wallFolder() / (name + ".toml")), golden::kMostPixels));
            ++count;
        }
        return count;
    }
    [[nodiscard]] Mask partOfTool(const walls::Wall& wall) const {
        return sample::partOfBall(sample::ballOf(dug_), sample::sceneToRoom(wall, dug_.scene), wall);
    }
    [[nodiscard]] WallPictures picturesOf(const walls::Wall& wall) const {
        render_node::ScenePainter view = sample::makeView(dug_, wall);
        WallPictures pictures{sample::wallPicture(view, wall), {}, {}, partOfTool(wall)};
        view.setTool(dug_.replica.probe(), false);
        pictures.hovering = sample::wallPicture(view, wall);
        render_node::ScenePainter bare(dug_.scene, sample::sceneToRoom(wall, dug_.scene));
        bare.update(dug_.replica.surface().data(), {});
        pictures.without = sample::wallPicture(bare, wall);
        return pictures;
    }

    std::unique_ptr<render_node::GlContext> context_ =
        render_node::makeOffscreenContext(render_node::Backend::automatic);
    sample::DugScene dug_;
};

TEST_F(GoldenWalls, LookAsTheyDid) {
    forEachWall([this](const std::string& name, const walls::Wall& wall) {
        render_node::ScenePainter view = sample::makeView(dug_, wall);
        golden::expect(golden::folder("golden"), name, sample::wallPicture(view, wall), partOfTool(wall));
    });
}

TEST_F(GoldenWalls, AreThoseOfTheWallFiles) {
    const auto names = sample::wallNames();
    EXPECT_EQ(goldens(), std::set<std::string>(names.begin(), names.end()));
}

// The part that is compared separately comes from geometry. The pictures show the pixels that the tool really changes.
TEST_F(GoldenWalls, HoldAPartThatHasAllThatTheToolChangesAndLittleElse) {
    const std::size_t count = forEachWall([this](const std::string&, const walls::Wall& wall) {
        const WallPictures shown = picturesOf(wall);
        const pictures::Comparison tool = pictures::compare(shown.without, shown.engaged, 0);
        EXPECT_EQ(pictures::countOutside(tool.bad, shown.part), 0);
        const auto part = std::count(shown.part.begin(), shown.part.end(), 1);
        // The ball alone is a disc of one radius in a box of some 5 by 4.5 radii: a seventh of the box.
        EXPECT_GT(static_cast<double>(tool.badPixels), static_cast<double>(part) / 7);
        EXPECT_LT(part, static_cast<std::ptrdiff_t>(shown.part.size() / 8));
    });
    EXPECT_EQ(count, goldens().size());
}

/// Returns `from` with the pixels of `other` where `where` is not 0.
Image withPixels(Image from, const Image& other, const Mask& where) {
    for (std::size_t i = 0; i < from.rgb.size(); ++i) {
        if (where[i / pictures::kChannels] != 0) {
            from.rgb[i] = other.rgb[i];
        }
    }
    return from;
}

/// Returns the picture with `change` applied to every level.
Image withLevels(Image image, const std::function<int(int)>& change) {
    for (std::uint8_t& level : image.rgb) {
        level = static_cast<std::uint8_t>(std::clamp(change(level), 0, 255));
    }
    return image;
}

TEST_F(GoldenWalls, FailForAnotherToolAndForNoTool) {
    std::size_t otherColour = 0, darker = 0, noShadow = 0, noTool = 0;
    const std::size_t count = forEachWall([&](const std::string& name, const walls::Wall& wall) {
        const Image want = pictures::readPng(golden::folder("golden") / (name + ".png"));
        const WallPictures shown = picturesOf(wall);
        // The red ball and the steel ball differ only in the ball's own pixels.
        const Mask ball = pictures::compare(shown.engaged, shown.hovering, 0).bad;
        const auto fails = [&](const Image& got) { return golden::fault(want, got, shown.part).empty() ? 0U : 1U; };
        EXPECT_EQ(fails(shown.engaged), 0);
        otherColour += fails(shown.hovering);
        const Image dark = withLevels(shown.engaged, [](int level) { return level * 9 / 10; });
        darker += fails(withPixels(shown.engaged, dark, ball));
        noShadow += fails(withPixels(shown.without, shown.engaged, ball));
        noTool += fails(shown.without);
    });
    EXPECT_EQ(otherColour, count);
    EXPECT_EQ(darker, count) << "a ball that is a tenth darker";
    EXPECT_EQ(noShadow, count);
    EXPECT_EQ(noTool, count);
    EXPECT_EQ(count, goldens().size());
}

TEST_F(GoldenWalls, FailForAPictureThatIsALevelBrighterOrDarker) {
    const std::size_t count = forEachWall([](const std::string& name, const walls::Wall&) {
        const Image want = pictures::readPng(golden::folder("golden") / (name + ".png"));
        EXPECT_EQ(golden::fault(want, want, {}), "");
        for (const int by : {-1, 1}) {
            EXPECT_NE(golden::fault(want, withLevels(want, [by](int level) { return level + by; }), {}), "") << by;
        }
    });
    EXPECT_EQ(count, goldens().size());
}

class GoldenFile : public test::FolderTest {
protected:
    /// Sets SANDWALL_WRITE_GOLDENS, or removes it.
    static void set(const std::optional<std::string>& wish) {
        const int failed = wish ? setenv(kVariable, wish->c_str(), 1) : unsetenv(kVariable);
        ASSERT_EQ(failed, 0);
    }
    void TearDown() override { set(before_); }  // restores the value that the caller of all golden tests may have set

    static constexpr const char* kVariable = "SANDWALL_WRITE_GOLDENS";
    const char* const given_ = std::getenv(kVariable);
    const std::optional<std::string> before_ = given_ == nullptr ? std::nullopt : std::optional<std::string>(given_);
};

TEST_F(GoldenFile, ThatIsWrittenFailsItsTestAndIsComparedInTheNextRun) {
    Image picture(20, 20);
    for (std::size_t i = 0; i < picture.rgb.size(); ++i) {
        picture.rgb[i] = static_cast<std::uint8_t>(i * 7);
    }
    set("1");
    EXPECT_NONFATAL_FAILURE(golden::expect(folder_, "new", picture), "SANDWALL_WRITE_GOLDENS");
    set(std::nullopt);
    EXPECT_EQ(pictures::readPng(folder_ / "new.png"), picture);
    golden::expect(folder_, "new", picture);
    const std::string other = "none_" + folder_.filename().string();
    EXPECT_NONFATAL_FAILURE(golden::expect(folder_, other, picture), "no golden picture");
    EXPECT_TRUE(std::filesystem::remove(golden::failures() / (other + ".got.png"))) << "left for a person to look at";
}

}  // namespace
