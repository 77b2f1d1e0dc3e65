// SPDX-License-Identifier: Apache-2.0
// Faulty arms behind the real server. The server prints one line, and the wall continues.
#include "scene/load/scene_file.hpp"
#include "tests/support/processes/server_process.hpp"

namespace {

using namespace test;
using haptic_bridge::Client;

class BadDevice : public testing::Test {
protected:
    std::vector<std::string> words(const std::string& what, const std::string& pace = "realtime") {
        auto all = ServerProcess::usual(sceneFile_, folder_, 0, pace);
        all[3] = "driver:" SANDWALL_BIN_DIR "/bad-driver.so:" + what;
        return all;
    }
    Folder folder_;
    std::string sceneFile_ = folder_.write("small.toml", kSmallScene);
    scene::Scene scene_ = scene::loadScene(sceneFile_);
};

TEST_F(BadDevice, IsToldInALineAndTheWallGoesOn) {
    for (const auto& [what, line] :
         {std::pair{"stops", "does not answer; the tool is lifted and the hand feels nothing until it answers"},
          {"nan", "sends values that are not finite, "},
          {"jumps", "jumps, "}}) {
        const std::string fault = folder_.file(what);
        ServerProcess server(folder_, words(std::string(what) + ":" + fault));
        Client client(server.address(), offerOf(scene_));
        Wall wall(scene_);
        while (wall.engaged <= 20) {  // steps in the sand
            ASSERT_TRUE(wall.follow(client, wall.replica.stepNumber() + 1)) << server.errors();
            ASSERT_LT(wall.replica.stepNumber(), 600U) << "ten seconds without the tool in the sand";
        }
        (void)folder_.write(what, "");
        const std::uint64_t healthy = wall.replica.stepNumber();
        ASSERT_TRUE(wall.follow(client, healthy + 90)) << client.link().message << "\n" << server.errors();
        EXPECT_EQ(wall.divergences, 0);
        EXPECT_FALSE(wall.replica.engaged() && std::string(what) != "jumps") << what << ": it must lift the tool";
        ASSERT_TRUE(eventually([&, expected = std::string(line)] {
            return server.errors().find(expected) != std::string::npos;
        })) << what
            << ": " << server.errors();
        const std::string errors = server.errors();
        EXPECT_EQ(errors.find(line), errors.rfind(line)) << "once:\n" << errors;
        client.stop();
        EXPECT_EQ(server.stop(SIGTERM), 0) << server.errors();
    }
}

TEST_F(BadDevice, ThatCannotBeOpenedIsNamed) {
    for (const auto& [what, reason] : {std::pair{"throws", "the device on USB 3 is taken"},
                                       {"throws 7", "the driver has thrown an exception without a text"}}) {
        ServerProcess server(folder_, words(what));
        EXPECT_EQ(server.wait(), 2) << what;
        const std::string device = "sandwall-haptic-server: --device " + words(what)[3];
        EXPECT_EQ(server.errors(), device + ": " + reason + "\n");
    }
}

TEST_F(BadDevice, WhoseDriverChangesTheRoundingWhenItOpensIsSetBack) {
    ServerProcess server(folder_, words("rough"));
    Client client(server.address(), offerOf(scene_));
    Wall wall(scene_);
    ASSERT_TRUE(wall.follow(client, 10)) << client.link().message << "\n" << server.errors();
    EXPECT_NE(server.errors().find("rough: changed how this process computes: it rounds up; this was set back"),
              std::string::npos)
        << server.errors();
    client.stop();
    EXPECT_EQ(server.stop(SIGTERM), 0) << server.errors();
}

// With "press:FILE" the driver writes a file when its arm is closed. Without the file it was never opened.
TEST_F(BadDevice, IsNotOpenedForAVirtualClockOrForForcesWithoutLimits) {
    const std::string pushed = folder_.file("pushed");
    for (const std::string& device : {"driver:" SANDWALL_BIN_DIR "/bad-driver.so:press:" + pushed,
                                      std::string("spacenav:" SANDWALL_BIN_DIR "/fake-spnav.so")}) {
        auto fast = words("");
        auto literal = words("");
        fast[3] = literal[3] = device;
        fast[5] = "fast";
        literal.insert(literal.end(), {"--guards", "literal"});
        ServerProcess first(folder_, fast);
        EXPECT_EQ(first.wait(), 2);
        EXPECT_EQ(first.errors(),
                  "sandwall-haptic-server: --pace fast: drives a virtual clock, which a real device cannot follow; use "
                  "it with script:, trace: or sim:, or give --pace realtime\n");
        ServerProcess second(folder_, literal);
        EXPECT_EQ(second.wait(), 2);
        EXPECT_EQ(second.errors(),
                  "sandwall-haptic-server: --guards literal: sends the law without limits, which only a simulated arm "
                  "may get; use it with sim:, or give --guards on\n");
        EXPECT_FALSE(std::filesystem::exists(pushed));
    }
}

TEST_F(BadDevice, FeelsWhatTheOperatorLetsItFeelWithinTheCeilingOfItsOwnOptions) {
    for (const bool untilCtl : {false, true}) {
        auto all = words("press:" + folder_.file("pushed"));
        all.insert(all.end(), {"--force", "off"});
        if (untilCtl) {
            all.emplace_back("--force-until-ctl");
        }
        ServerProcess server(folder_, all);
        Client client(server.address(), offerOf(scene_));
        Wall wall(scene_);
        ASSERT_TRUE(wall.follow(client, 10)) << client.link().message << "\n" << server.errors();
        EXPECT_EQ(client.forceCeiling(), untilCtl ? 1 : 0);
        client.shareForce({0.5, true});
        ASSERT_TRUE(wall.follow(client, 90)) << client.link().message << "\n" << server.errors();
        client.stop();
        EXPECT_EQ(server.stop(SIGTERM), 0) << server.errors();
        EXPECT_EQ(std::stod(folder_.read("pushed")) > 0, untilCtl) << folder_.read("pushed");
        EXPECT_EQ(client.forceCeiling(), std::nullopt) << "no server is linked";
    }
}

}  // namespace
