// SPDX-License-Identifier: Apache-2.0
// Laws and settings of an arm that the real server refuses before the arm feels a force.
#include "tests/haptic_bridge/server/pressing_server.hpp"

namespace {

using namespace test;

class RefusedLaw : public PressingServer {};

TEST_F(RefusedLaw, IsToldInALineBeforeTheArmIsOpened) {
    sceneFile_ = folder_.write("steep.toml", std::string(kSmallScene) + "[force]\ndepth_exponent = 20000\n");
    ServerProcess server(folder_, words("none"));
    EXPECT_EQ(server.wait(), 2);
    EXPECT_EQ(server.errors(), "sandwall-haptic-server: " + sceneFile_ +
                                   ":12: depth_exponent 20000 gives a force that is not finite 2 scene units deep; "
                                   "give at most 166\n");
    EXPECT_EQ(server.output(), "");
    EXPECT_FALSE(std::filesystem::exists(folder_.file("forces"))) << "the arm would have begun its log";
}

TEST_F(RefusedLaw, AHeightThatFollowsTheSurfaceIsRefusedBeforeTheArmIsOpened) {
    auto all = words("none");
    all.insert(all.end(), {"--map", "datum=surface"});
    ServerProcess server(folder_, all);
    EXPECT_EQ(server.wait(), 2);
    EXPECT_EQ(server.errors(),
              "sandwall-haptic-server: --map datum=surface: works only for recordings; an arm needs datum=level\n");
    EXPECT_FALSE(std::filesystem::exists(folder_.file("forces"))) << "the arm would have begun its log";
}

TEST_F(RefusedLaw, OfAScaleIsToldInALineAndTheArmIsPushedWithZero) {
    auto all = words("none");
    all.insert(all.end(), {"--map", "scale=1e307"});
    ServerProcess server(folder_, all);
    EXPECT_EQ(server.wait(), 2);
    const std::string errors = server.errors();
    EXPECT_EQ(errors.find("sandwall-haptic-server: the force law at a depth of one tool radius is "), 0U) << errors;
    EXPECT_EQ(errors.find('\n'), errors.size() - 1) << errors;
    ASSERT_EQ(forces().size(), 1U) << folder_.read("forces");
    EXPECT_EQ(lastForce(), 0);
}

}  // namespace
