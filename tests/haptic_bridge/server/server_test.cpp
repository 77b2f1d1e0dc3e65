// SPDX-License-Identifier: Apache-2.0
// Tests of the real server program over loopback, with the real client.
#include "base/input_error.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/haptic_bridge/link/raw_peer.hpp"
#include "tests/support/processes/server_process.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using namespace test;
using haptic_bridge::Client;
using haptic_bridge::Link;
using samples::withNumber;

class HapticServer : public testing::Test {
protected:
    Folder folder_;
    std::string sceneFile_ = folder_.write("small.toml", kSmallScene);
    scene::Scene scene_ = scene::loadScene(sceneFile_);
};

TEST_F(HapticServer, WritesTheSameSandTwice) {
    std::vector<std::uint64_t> hashes;
    for (int run = 0; run < 2; ++run) {
        ServerProcess server(folder_, ServerProcess::usual(sceneFile_, folder_));
        Client client(server.address(), offerOf(scene_));
        Wall wall(scene_);
        ASSERT_TRUE(wall.follow(client, 240)) << client.link().message << "\n" << server.errors();
        EXPECT_EQ(wall.divergences, 0);
        EXPECT_EQ(wall.outOfOrder, 0);
        // G, I and S are drawn from 0 to 1.1994 s, 1.3365 to 1.8819 s and 2.1050 to 3.1616 s: 168.1 steps of 1/60 s. A
        // step is engaged or hovering as a whole. If the hand lands within a step, its samples go into the next step.
        // The first step of I and of S is therefore longer, without an additional step. The first step of I has 14
        // samples that waited and 16 of its own.
        EXPECT_EQ(wall.strokes, 3);
        EXPECT_EQ(wall.engaged, 167);
        EXPECT_EQ(wall.longest, 30U);
        EXPECT_FALSE(wall.replica.engaged()) << "the three letters must be complete within 240 steps";
        EXPECT_EQ(samples::fieldOf(wall.replica).volume() + wall.replica.outflow(), scene_.terrain.volume());
        hashes.push_back(wall.replica.stateHash());
        client.stop();
        ASSERT_TRUE(client.report().has_value());
        EXPECT_GE(client.report()->steps, 240U);
        EXPECT_EQ(client.report()->samplesDropped, 0U);
        EXPECT_EQ(client.link().link, Link::stopped);
        EXPECT_EQ(server.stop(SIGTERM), 0) << server.errors();
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_NE(hashes[0], sand::Replica(scene_).stateHash());
}

TEST_F(HapticServer, WritesWithARecordedHand) {
    const std::string command = std::string("python3 ") + SANDWALL_SOURCE_DIR +
                                "/scripts/figures/make_hand_trace.py --seconds 6 " + folder_.file("hand.csv");
    ASSERT_EQ(std::system(command.c_str()), 0);
    std::vector<std::string> arguments = ServerProcess::usual(sceneFile_, folder_);
    arguments[3] = "trace:" + folder_.file("hand.csv");
    ServerProcess server(folder_, arguments);
    Client client(server.address(), offerOf(scene_));
    Wall wall(scene_);
    ASSERT_TRUE(wall.follow(client, 380)) << client.link().message << "\n" << server.errors();
    EXPECT_EQ(wall.divergences, 0);
    EXPECT_EQ(wall.strokes, 3) << "G, I and S";
    EXPECT_FALSE(wall.replica.engaged()) << "a finished recording hovers";
    // The I is in the middle of the field, and the sand between I and S is untouched.
    EXPECT_LT(samples::fieldOf(wall.replica).height(64, 64), scene_.terrain.height(64, 64));
    EXPECT_EQ(samples::fieldOf(wall.replica).height(78, 48), scene_.terrain.height(78, 48));
}

// A hand that turns its tool sends the heading when it changes. A ball gets no heading, because it would make no
// difference.
TEST_F(HapticServer, TurnsTheToolThatHasAHeading) {
    const std::string walk = folder_.write("walk.strokes",
                                           "follow\nstroke\npoint -0.5 0\npoint 0.5 0\npoint 0.5 0.5\n"
                                           "heading 200\nfoot left\nstroke\npoint 0 -0.5\nhold 0.2\n");
    for (const std::string shape : {"sphere", "ellipse"}) {
        std::string text = kSmallScene;
        text.replace(text.find("radius"), 0, "shape = \"" + shape + "\"\n");
        std::vector<std::string> arguments = ServerProcess::usual(folder_.write("walk.toml", text), folder_);
        arguments[3] = "script:" + walk;
        const scene::Scene scene = scene::loadScene(arguments[1]);
        ServerProcess server(folder_, arguments);
        Client client(server.address(), offerOf(scene));
        Wall wall(scene);
        ASSERT_TRUE(wall.follow(client, 160)) << client.link().message << "\n" << server.errors();
        EXPECT_EQ(wall.divergences, 0);
        EXPECT_EQ(wall.strokes, 2);
        EXPECT_EQ(wall.turns, shape == "sphere" ? 0 : 2) << "east as the scene has it, north, and 200 degrees";
        EXPECT_EQ(wall.replica.heading(), shape == "sphere" ? sand::Heading{} : *sand::headingOf(200, true));
    }
}

TEST_F(HapticServer, RunsInRealTimeAndReports) {
    std::vector<std::string> arguments = ServerProcess::usual(sceneFile_, folder_, 0, "realtime");
    arguments.insert(arguments.end(), {"--timing-tests", "20"});
    ServerProcess server(folder_, arguments);
    Client client(server.address(), offerOf(scene_));
    Wall wall(scene_);
    ASSERT_TRUE(wall.follow(client, 90)) << client.link().message << "\n" << server.errors();
    EXPECT_EQ(wall.divergences, 0);
    EXPECT_EQ(client.stepsPerSecond(), 60U);
    client.stop();
    ASSERT_TRUE(client.report().has_value());
    const haptic_bridge::Report report = *client.report();
    EXPECT_GT(report.hapticPeriodUsP50, 0);
    EXPECT_GT(report.forceUsP50, 0);
    EXPECT_GT(report.toWall.count, 0U);
    EXPECT_GE(report.toMaster.count, report.toWall.count);
    EXPECT_GT(report.toWall.msP50, 0);
    EXPECT_GT(report.toMaster.msP50, 0);
    EXPECT_GT(report.ticks, 0U);
    EXPECT_GT(report.handTicks, 0U);
    EXPECT_LE(report.handTicks, report.ticks) << "the loop also ticks before a master is linked";
    EXPECT_GT(report.feltTicks, 0U) << "the recorded hand digs";
    EXPECT_LE(report.feltTicks + report.faultedTicks, report.handTicks);
    EXPECT_FALSE(report.literal);
    EXPECT_EQ(report.audited, haptic_bridge::Audited::agreed) << "the last report of the link";
    EXPECT_GT(report.guards[static_cast<std::size_t>(haptic_bridge::Guard::stiffness)], 0U) << "the scene's constants";
    EXPECT_EQ(server.stop(SIGTERM), 0);
    for (const char* line : {"k_s 1000 → 18: ", "force loop: ", " per mille", "guards acted in ticks: stiffness "}) {
        EXPECT_NE(server.errors().find(line), std::string::npos) << server.errors();
    }
    EXPECT_GT(report.stepBytesMean, 0);
    std::printf(
        "haptic period us p50 %.0f p99 %.0f max %.0f; force us p50 %.2f p99 %.2f; half round trip ms mean %.3f "
        "stddev %.3f, to the master %.3f stddev %.3f; step message %.0f bytes\n",
        report.hapticPeriodUsP50, report.hapticPeriodUsP99, report.hapticPeriodUsMax, report.forceUsP50,
        report.forceUsP99, report.toWall.msMean, report.toWall.msStddev, report.toMaster.msMean,
        report.toMaster.msStddev, report.stepBytesMean);
}

TEST_F(HapticServer, GetsFewerStepsThroughASlowWallAndLosesNone) {
    ServerProcess server(folder_, ServerProcess::usual(sceneFile_, folder_, 0, "realtime"));
    Client client(server.address(), offerOf(scene_));
    Wall wall(scene_);
    ASSERT_TRUE(wall.follow(client, 5));
    // The wall shows no frame until the window of 8 steps is full and the server has withheld some more steps.
    const std::uint64_t before = wall.replica.stepNumber();
    ASSERT_TRUE(eventually([&] { return client.counters().stepsIn >= before + 8; })) << client.counters().stepsIn;
    std::this_thread::sleep_for(1000ms);
    EXPECT_LE(client.counters().stepsIn, before + 8);
    ASSERT_TRUE(wall.follow(client, before + 40)) << client.link().message;
    EXPECT_EQ(wall.divergences, 0);
    EXPECT_EQ(wall.outOfOrder, 0);
    EXPECT_GT(wall.longest, 17U) << "the withheld movement comes as a longer path";
    EXPECT_LE(wall.longest, 64U) << "docs/protocol.md";
    client.stop();
    ASSERT_TRUE(client.report().has_value());
    EXPECT_GT(client.report()->stepsWithheld[static_cast<std::size_t>(haptic_bridge::Withheld::wall)], 0U);
}

TEST_F(HapticServer, ComesBackAfterAKillInANewEpoch) {
    auto server = std::make_unique<ServerProcess>(folder_, ServerProcess::usual(sceneFile_, folder_));
    const std::uint16_t port = server->port();
    Client client({"127.0.0.1", port}, offerOf(scene_));
    Wall wall(scene_);
    ASSERT_TRUE(wall.follow(client, 50));
    EXPECT_EQ(server->stop(SIGKILL), -SIGKILL);
    ASSERT_TRUE(eventually([&] { return client.link().link == Link::lost; })) << client.link().message;
    EXPECT_NE(client.link().message.find("link lost"), std::string::npos) << client.link().message;
    server = nullptr;
    server = std::make_unique<ServerProcess>(folder_, ServerProcess::usual(sceneFile_, folder_, port));
    ASSERT_TRUE(wall.follow(client, 100)) << client.link().message << "\n" << server->errors();
    EXPECT_EQ(wall.epoch, 2U);
    EXPECT_EQ(wall.divergences, 0) << "the server must have started from the wall's own state";
    EXPECT_EQ(client.counters().reconnects, 1U);
}

TEST_F(HapticServer, DoesWhatAnOperatorAsksAndTakesTheWallsMaterialWhenItComesBack) {
    auto server = std::make_unique<ServerProcess>(folder_, ServerProcess::usual(sceneFile_, folder_));
    const std::uint16_t port = server->port();
    Client client({"127.0.0.1", port}, offerOf(scene_));
    Wall wall(scene_);
    ASSERT_TRUE(wall.follow(client, 40));
    sand::Tuning tuning = scene_.rules.tuning;
    tuning.tool.radius *= 2;
    tuning.threshold /= 2;
    // The first load is too long for an ordinary message, because rough sand and its fluxes can hardly be compressed.
    std::mt19937 random(7);
    scene::Scene rough = scene_;
    rough.terrain = samples::randomField(scene_.rules.columns, scene_.rules.rows, sand::kMaxHeight, random);
    sand::Replica sliding(rough);
    sliding.apply({.epoch = 1, .number = 1, .engaged = false, .path = {}});
    const base::Bytes roughSand = sliding.copySand()->encode();
    ASSERT_GT(roughSand.size(), haptic_bridge::kMaxMessage);
    const std::vector<sand::Edit> asked{
        withNumber(11, sand::Edit::tuned(tuning)), withNumber(12, sand::Edit::loaded(roughSand)),
        withNumber(13, sand::Edit::loaded(roughSand)),  // the same once more: the server takes the next long load
        withNumber(14, sand::Edit::loaded(sand::Replica(scene_).copySand()->encode()))};
    for (const sand::Edit& edit : asked) {
        client.request(edit);
        ASSERT_TRUE(wall.follow(client, wall.replica.stepNumber() + 40)) << client.link().message;
    }
    EXPECT_EQ(wall.edits, asked);
    EXPECT_EQ(wall.divergences, 0);
    EXPECT_EQ(server->stop(SIGKILL), -SIGKILL);
    ASSERT_TRUE(eventually([&] { return client.link().link == Link::lost; })) << client.link().message;
    server = nullptr;
    server = std::make_unique<ServerProcess>(folder_, ServerProcess::usual(sceneFile_, folder_, port));
    ASSERT_TRUE(wall.follow(client, 240)) << client.link().message << "\n" << server->errors();
    EXPECT_EQ(wall.replica.rules().tuning, tuning);
    EXPECT_EQ(wall.divergences, 0) << "the server computes with the operator's settings";
}

TEST_F(HapticServer, ServesTheNextMasterFromItsOwnState) {
    ServerProcess server(folder_, ServerProcess::usual(sceneFile_, folder_));
    Wall first(scene_), second(scene_);
    {
        Client client(server.address(), offerOf(scene_));
        ASSERT_TRUE(first.follow(client, 30));
    }
    Client client(server.address(), offerOf(scene_));
    ASSERT_TRUE(second.follow(client, 30)) << client.link().message;
    EXPECT_EQ(second.divergences, 0);
}

TEST_F(HapticServer, RefusesASecondMasterAndLetsItInLater) {
    ServerProcess server(folder_, ServerProcess::usual(sceneFile_, folder_));
    auto first = std::make_unique<Client>(server.address(), offerOf(scene_));
    ASSERT_TRUE(eventually([&] { return first->link().link == Link::offered; }));
    Client second(server.address(), offerOf(scene_));
    ASSERT_TRUE(eventually([&] { return second.link().link == Link::refused; }));
    EXPECT_NE(second.link().message.find("busy"), std::string::npos) << second.link().message;
    first = nullptr;
    EXPECT_TRUE(eventually([&] { return second.link().link == Link::offered; })) << second.link().message;
}

TEST_F(HapticServer, NamesBothScenesAndBothDigests) {
    ServerProcess server(folder_, ServerProcess::usual(sceneFile_, folder_));
    Client otherScene(server.address(), {scene_.rules.digest(), "dunes"});
    ASSERT_TRUE(eventually([&] { return otherScene.link().link == Link::refused; }));
    EXPECT_NE(otherScene.link().message.find("'small'"), std::string::npos) << otherScene.link().message;
    EXPECT_NE(otherScene.link().message.find("'dunes'"), std::string::npos) << otherScene.link().message;
    Client otherSand(server.address(), {scene_.rules.digest() ^ 1, "small"});
    ASSERT_TRUE(eventually([&] { return otherSand.link().link == Link::refused; }));
    EXPECT_NE(otherSand.link().message.find("material"), std::string::npos) << otherSand.link().message;
}

TEST_F(HapticServer, AnswersGarbageHalfMessagesAndOtherVersionsWithAReason) {
    ServerProcess server(folder_, ServerProcess::usual(sceneFile_, folder_));
    const std::uint16_t port = server.port();
    haptic_bridge::Identity mine{haptic_bridge::kProtocolVersion, sand::kAlgorithmVersion, scene_.rules.digest(),
                                 "small"};
    {
        RawPeer browser(port);
        const std::string request = "GET / HTTP/1.1\r\n\r\n";
        browser.send({reinterpret_cast<const std::uint8_t*>(request.data()), request.size()});
        EXPECT_NE(browser.refusal().find("haptic server"), std::string::npos);
        EXPECT_FALSE(browser.receive()) << "the link must be closed";
    }
    {
        RawPeer newer(port);
        haptic_bridge::Identity other = mine;
        other.protocol += 1;
        newer.send(haptic_bridge::Hello{other});
        EXPECT_NE(newer.refusal().find("protocol version"), std::string::npos);
    }
    {
        RawPeer other(port);
        haptic_bridge::Identity sandy = mine;
        sandy.algorithm += 1;
        other.send(haptic_bridge::Hello{sandy});
        EXPECT_NE(other.refusal().find("algorithm version"), std::string::npos);
    }
    {
        RawPeer half(port);
        half.send(std::span<const std::uint8_t>(haptic_bridge::encode(haptic_bridge::Hello{mine})).first(10));
    }
    {
        RawPeer early(port);
        early.send(haptic_bridge::Shown{1, 1});
        EXPECT_NE(early.refusal().find("out of turn"), std::string::npos);
    }
    {
        RawPeer liar(port);
        liar.send(haptic_bridge::Hello{mine});
        ASSERT_TRUE(liar.receive());
        liar.send(haptic_bridge::StartMessage{1, 0, 12345});
        const auto answer = liar.receive();
        ASSERT_TRUE(answer && std::holds_alternative<haptic_bridge::NeedState>(*answer));
        liar.send(haptic_bridge::State{base::Bytes(100'000, 1)});
        EXPECT_NE(liar.refusal().find("state"), std::string::npos);
    }
    // After all faults the server still serves.
    Client client({"127.0.0.1", port}, offerOf(scene_));
    Wall wall(scene_);
    EXPECT_TRUE(wall.follow(client, 20)) << client.link().message << "\n" << server.errors();
    EXPECT_EQ(server.stop(SIGINT), 0) << server.errors();
}

TEST_F(HapticServer, SendsTimingTestsAsLongAsAStepAndCountsEachLegOnce) {
    std::vector<std::string> arguments = ServerProcess::usual(sceneFile_, folder_);
    arguments.insert(arguments.end(), {"--timing-tests", "50"});
    ServerProcess server(folder_, arguments);
    using namespace haptic_bridge;
    const Identity mine{kProtocolVersion, sand::kAlgorithmVersion, scene_.rules.digest(), "small"};
    RawPeer master(server.port());
    master.send(Hello{mine});
    master.send(StartMessage{1, 0, sand::Replica(scene_).stateHash()});
    std::size_t step = 0;
    unsigned tests = 0, compared = 0;  // the first test may come before there is a step
    while (tests < 3 || compared == 0) {
        const auto message = master.receive();
        ASSERT_TRUE(message) << server.errors();
        if (std::holds_alternative<StepMessage>(*message)) {
            step = encode(*message).size();
        } else if (const auto* test = std::get_if<TimingTest>(&*message)) {
            if (step != 0) {
                EXPECT_EQ(encode(*test).size(), step) << "a probe message's length";
                ++compared;
            }
            EXPECT_EQ(test->id, ++tests);
            master.send(TimingEcho{test->id, Leg::received});
            master.send(TimingEcho{test->id, Leg::received});
            if (tests != 2) {
                master.send(TimingEcho{test->id, Leg::shown});
                master.send(TimingEcho{test->id, Leg::shown});
            }
        }
    }
    master.send(TimingEcho{99, Leg::shown});
    master.send(Bye{"done"});
    std::optional<Report> report;
    while (const auto message = master.receive()) {
        if (const auto* told = std::get_if<Report>(&*message)) {
            report = *told;
        }
    }
    ASSERT_TRUE(report);
    EXPECT_EQ(report->toMaster.count, tests);
    EXPECT_EQ(report->toWall.count, tests - 1);
}

/// Returns the output of a server that is expected to end with exit status 2.
std::string complaint(const Folder& folder, const std::vector<std::string>& arguments) {
    ServerProcess server(folder, arguments);
    EXPECT_EQ(server.wait(), base::kExitBadInput) << server.errors();
    std::string errors = server.errors();
    EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
    return errors;
}

TEST_F(HapticServer, SaysWhatIsWrongInOneLine) {
    ServerProcess server(folder_, ServerProcess::usual(sceneFile_, folder_));
    const std::uint16_t port = server.port();
    const Folder other;
    EXPECT_NE(complaint(other, ServerProcess::usual(sceneFile_, other, port)).find("in use"), std::string::npos);
    EXPECT_NE(complaint(other, ServerProcess::usual("/nowhere.toml", other)).find("/nowhere.toml"), std::string::npos);
    const std::string trace = other.write("bad.csv", "time,x,y,z\n0,1,2,3\n0.001,1,two,3\n");
    EXPECT_NE(complaint(other, {"--scene", sceneFile_, "--device", "trace:" + trace}).find("bad.csv:3:"),
              std::string::npos);
    EXPECT_NE(complaint(other, {"--scene", sceneFile_, "--device", "phantom"}).find("unknown device"),
              std::string::npos);
    EXPECT_NE(complaint(other, {"--scene", sceneFile_, "--device", "script:/nowhere"}).find("/nowhere"),
              std::string::npos);
    EXPECT_NE(complaint(other, {"--scene", sceneFile_, "--device", "script:gis", "--map", "sacle=2"}).find("sacle=2"),
              std::string::npos);
    EXPECT_NE(
        complaint(other, {"--scene", sceneFile_, "--device", "script:gis", "--listen", "127.0.0.1:x"}).find("port"),
        std::string::npos);
}

TEST_F(HapticServer, PrintsAndWritesItsPort) {
    ServerProcess server(folder_, ServerProcess::usual(sceneFile_, folder_));
    const std::string port = std::to_string(server.port());
    EXPECT_TRUE(eventually([&] { return !server.output().empty(); }));
    EXPECT_EQ(server.output(), "listening on 127.0.0.1:" + port + "\n");
}

}  // namespace
