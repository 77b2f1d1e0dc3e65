// SPDX-License-Identifier: Apache-2.0
// A watcher sees every step, moves nothing, and does not delay the master.
#include <filesystem>

#include "host/clock.hpp"
#include "tests/haptic_bridge/client/fake_server.hpp"
#include "tests/haptic_bridge/link/link_security_fixture.hpp"
#include "tests/haptic_bridge/link/raw_peer.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using namespace haptic_bridge;
using namespace test;

TEST_F(LinkSecurityTest, AWatcherSeesTheStepsAndMovesNothing) {
    ServerProcess server(folder_, arguments({}));
    Client master(server.address(), offerOf(scene_));
    Wall wall(scene_);
    ASSERT_TRUE(wall.follow(master, 10));
    RawPeer watcher(server.port());
    Hello asking = hello(Role::watch);
    asking.master.rulesDigest = 0;  // a watcher has no sand
    watcher.send(asking);
    const auto welcome = watcher.receive();
    ASSERT_TRUE(welcome && std::holds_alternative<Welcome>(*welcome));
    EXPECT_EQ(std::get<Welcome>(*welcome).role, Role::watch);
    RawPeer pushy(server.port());
    pushy.send(asking);
    ASSERT_TRUE(pushy.receive());
    pushy.send(StartMessage{9, 0, 0});
    ASSERT_TRUE(wall.follow(master, 60));
    std::uint64_t last = 0;
    while (last < 50) {
        const auto message = watcher.receive();
        ASSERT_TRUE(message) << server.errors();
        if (const auto* step = std::get_if<StepMessage>(&*message)) {
            EXPECT_TRUE(last == 0 || step->step.number == last + 1);
            last = step->step.number;
        }
    }
    EXPECT_TRUE(eventually([&] { return server.errors().find("a watcher only listens") != std::string::npos; }))
        << server.errors();
    EXPECT_EQ(wall.divergences + wall.outOfOrder, 0);
    master.stop();
    ASSERT_TRUE(master.report());
    EXPECT_EQ(master.report()->refused[static_cast<std::size_t>(RefusalCode::role) - 1], 1U);
}

TEST_F(LinkSecurityTest, TheProgramThatWatchesPrintsWhereTheProbeIs) {
    const std::string watchers = secretFile("watchers", "watch " + quoted(kWatch) + "\n");
    ServerProcess server(folder_, arguments({"--secret-file", both_, "--tls"}, "realtime"));
    Client master(server.address(), offerOf(scene_), client(both_, true));
    Wall wall(scene_);
    ASSERT_TRUE(wall.follow(master, 10)) << master.link().message;
    const auto watch = [&](const std::string& options) {
        const std::string command = "timeout 60 " SANDWALL_BIN_DIR "/sandwall-watch " + server.address().text() +
                                    " --lines 2 " + options + " >" + folder_.file("watch") + " 2>&1 &";
        std::filesystem::remove(folder_.file("watch"));
        EXPECT_EQ(std::system(command.c_str()), 0);
        EXPECT_TRUE(eventually([&] {
            for (const auto& timed : master.drain(100)) {
                wall.apply(timed);
            }
            master.shown({wall.replica.stepNumber(), 16'666'667});
            const std::string told = folder_.read("watch");
            return told.find("steps/s", told.find("steps/s") + 1) != std::string::npos ||
                   (told.find("127.0.0.1") != std::string::npos && told.ends_with('\n'));
        }));
        return folder_.read("watch");
    };
    const std::string told = watch("--tls --secret-file " + watchers);
    EXPECT_EQ(told.find("scene 'small', 60 steps per second\nstep "), 0U) << told;
    EXPECT_NE(told.find("probe at "), std::string::npos) << told;
    const std::string plain = watch("");
    EXPECT_NE(plain.find("this server accepts only TLS"), std::string::npos) << plain;
    EXPECT_EQ(wall.divergences + wall.outOfOrder, 0);
}

TEST(TheProgramThatWatches, ComesAgainWhenTheServerHasReadItsScene) {
    const Folder folder;
    int greeted = 0;
    FakeServer server([&](FakeServer::Connection& connection) {
        if (!connection.await<Hello>()) {
            return;
        }
        if (greeted++ == 0) {
            connection.send(Loading{500});
            connection.await<Ping>();
            connection.send(Bye{"its scene is read"});
        } else {
            connection.send(Welcome{{.sceneName = "dunes"}, 60, Role::watch});
            connection.await<Bye>();
        }
    });
    const std::string command = "timeout 60 " SANDWALL_BIN_DIR "/sandwall-watch " + server.address().text() +
                                " --lines 1 >" + folder.file("watch") + " 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0);
    const std::string told = folder.read("watch");
    EXPECT_EQ(told.find("the server reads its scene\nscene 'dunes', 60 steps per second\nstep "), 0U) << told;
    EXPECT_EQ(greeted, 2);
}

TEST_F(LinkSecurityTest, WhoWatchesAndDoesNotReadIsCutOff) {
    // A hand that crosses the air beyond the field, again and again. Its steps are long, so that fewer of them fill all
    // buffers, and cost no work on sand.
    std::string air = "travel 500\n";
    for (int crossing = 0; crossing < 1000; ++crossing) {
        air += crossing % 2 == 0 ? "stroke\npoint 90 90\n" : "stroke\npoint -90 -90\n";
    }
    std::vector<std::string> words = arguments({});
    std::replace(words.begin(), words.end(), std::string("script:gis"), "script:" + folder_.write("air.strokes", air));
    ServerProcess server(folder_, words);
    Client master(server.address(), offerOf(scene_));
    Wall wall(scene_);
    ASSERT_TRUE(wall.follow(master, 10));
    RawPeer watcher(server.port(), 4096);
    watcher.send(hello(Role::watch));
    ASSERT_TRUE(watcher.receive());
    // The watcher's buffer is small. The kernel also fills its largest buffer for sending, usually 4 MiB. A step takes
    // some 200 bytes, while the hand moves.
    const auto cutOff = [&] { return server.errors().find("does not read what is sent") != std::string::npos; };
    std::int64_t pingedNs = host::monotonicNs();
    for (int round = 0; round < 2000 && !cutOff(); ++round) {
        if (host::monotonicNs() - pingedNs > 1'000'000'000) {  // or a slow server would end it because it is silent
            watcher.send(Ping{});
            pingedNs = host::monotonicNs();
        }
        ASSERT_TRUE(wall.follow(master, wall.replica.stepNumber() + 100)) << master.link().message;
    }
    EXPECT_TRUE(cutOff()) << server.errors();
    EXPECT_EQ(wall.divergences + wall.outOfOrder, 0);
    EXPECT_EQ(master.counters().reconnects, 0U);
}

}  // namespace
