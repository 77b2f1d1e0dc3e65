// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <memory>
#include <set>

#include "render_node/gl/gl_context.hpp"
#include "tests/render_node/golden.hpp"
#include "tests/render_node/wall_painter.hpp"

namespace {

class GoldenWalls : public testing::Test {
protected:
    std::unique_ptr<render_node::GlContext> context_ = render_node::makeOffscreenContext(render_node::Backend::osmesa);
    sample::DugScene dug_;
};

TEST_F(GoldenWalls, LookAsTheyDid) {
    ASSERT_FALSE(sample::wallNames().empty());
    for (const std::string& name : sample::wallNames()) {
        SCOPED_TRACE(name);
        const walls::Wall wall =
            sample::smallWall(walls::loadWall(sample::wallFolder() / (name + ".toml")), golden::kMostPixels);
        render_node::ScenePainter view = sample::makeView(dug_, wall);
        golden::expect("golden", name, sample::wallPicture(view, wall));
    }
}

TEST_F(GoldenWalls, AreThoseOfTheWallFiles) {
    std::set<std::string> goldens;
    for (const auto& entry : std::filesystem::directory_iterator(golden::folder("golden"))) {
        goldens.insert(entry.path().stem().string());
    }
    const auto names = sample::wallNames();
    EXPECT_EQ(goldens, std::set<std::string>(names.begin(), names.end()));
}

}  // namespace
