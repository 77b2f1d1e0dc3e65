// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "pictures/png_file.hpp"
#include "tests/cluster/session_fixture.hpp"
#include "tests/support/files/wall_text.hpp"

namespace {

std::vector<std::string> samples() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(SANDWALL_SOURCE_DIR "/walls/configs")) {
        if (entry.path().extension() == ".toml") {
            names.push_back(entry.path().stem().string());
        }
    }
    std::sort(names.begin(), names.end());
    return names;
}

class Sample : public SessionTest, public testing::WithParamInterface<std::string> {
protected:
    void show(const walls::Wall& wall, const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"--wall",  write("wall.toml", support::wallText(wall)),
                                           "--scene", scene(),
                                           "--pace",  "fast",
                                           "--track", "none",
                                           "--gl",    "osmesa",
                                           "--here",  "--device",
                                           "none",    "--frames",
                                           "20",      "--out",
                                           out()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Ended ended = runToEnd(arguments, 300);
        ASSERT_EQ(ended.status, 0) << ended.output;
    }
    [[nodiscard]] pictures::Image tile(const std::string& name, walls::Eye eye) const {
        return pictures::readPng(folder_ / "out" / fmt::format("tile_{}_{}.png", name, walls::eyeName(eye)));
    }
};

// Shows every wall file of the project, at a tenth of its size, with real ranks. Every eye must have its picture.
// tests/render_node/stereo_truth_test.cpp tests for all wall files that a single eye sees the picture between two eyes.
TEST_P(Sample, IsShownByItsRanks) {
    const walls::Wall wall =
        support::reduced(walls::loadWall(fmt::format(SANDWALL_SOURCE_DIR "/walls/configs/{}.toml", GetParam())), 0.1);
    show(wall, {});
    EXPECT_EQ(summary()["ranks"], wall.ranks());
    EXPECT_EQ(summary()["divergences"], 0);
    std::vector<pictures::Image> seen;
    for (const walls::Tile& each : wall.tiles) {
        for (const walls::Eye eye : walls::eyesOf(wall.stereo)) {
            seen.push_back(tile(each.name, eye));
            EXPECT_EQ(glm::ivec2(seen.back().width, seen.back().height), each.pixels);
        }
    }
    const auto likeTheFirst = [&](const pictures::Image& image) { return image.rgb == seen[0].rgb; };
    if (seen.size() > 1) {
        EXPECT_FALSE(std::all_of(seen.begin(), seen.end(), likeTheFirst)) << "all eyes see the same picture";
    }
}

INSTANTIATE_TEST_SUITE_P(Walls, Sample, testing::ValuesIn(samples()), [](const auto& sample) { return sample.param; });

class SampleInMono : public Sample {};

// With --mono the wall shows the picture from the middle of the eyes. The sand stays the same.
TEST_P(SampleInMono, IsSeenFromTheMiddle) {
    const walls::Wall wall =
        support::reduced(walls::loadWall(fmt::format(SANDWALL_SOURCE_DIR "/walls/configs/{}.toml", GetParam())), 0.1);
    show(wall, {"--mono"});
    const std::string hash = summary()["state_hash"];
    const pictures::Image middle = tile(wall.tiles[0].name, walls::Eye::middle);
    walls::Wall fromTheMiddle = walls::shownIn(wall, walls::Stereo::left);
    fromTheMiddle.viewer.eyeSeparation = 1e-9;
    show(fromTheMiddle, {});
    EXPECT_EQ(summary()["state_hash"], hash);
    EXPECT_EQ(tile(wall.tiles[0].name, walls::Eye::left).rgb, middle.rgb);
}

INSTANTIATE_TEST_SUITE_P(Walls, SampleInMono, testing::Values("anaglyph"));

}  // namespace
