// SPDX-License-Identifier: Apache-2.0
// An attacker at either end of the link. scripts/checks/hostile.sh runs the same test a million times.
#include <cstdio>
#include <thread>

#include "scene/load/scene_file.hpp"
#include "tests/hostile/attack.hpp"
#include "tests/support/processes/server_process.hpp"
#include "tests/support/seed.hpp"

namespace {

using namespace haptic_bridge;
using namespace test;

class Hostile : public testing::Test {
protected:
    std::uint32_t seed_ = test::randomSeed();
    testing::ScopedTrace trace_{__FILE__, __LINE__, test::again(seed_)};
    Folder folder_;
    std::string sceneFile_ = folder_.write("small.toml", kSmallScene);
    scene::Scene scene_ = scene::loadScene(sceneFile_);
    Identity identity_{kProtocolVersion, sand::kAlgorithmVersion, scene_.rules.digest(), "small"};
};

std::uint64_t total(const RefusalCounts& counts) {
    std::uint64_t sum = 0;
    for (const std::uint64_t count : counts) {
        sum += count;
    }
    return sum;
}

TEST_F(Hostile, ThousandsOfFramesDoNotTouchWhoIsLinkedToTheServer) {
    ServerProcess server(folder_, ServerProcess::usual(sceneFile_, folder_, 0, "realtime"));
    Client client(server.address(), offerOf(scene_));
    Wall wall(scene_);
    ASSERT_TRUE(wall.follow(client, 30)) << client.link().message;
    std::atomic<bool> over{false};
    hostile::Done done;
    std::thread attacker([&] {
        hostile::Frames frames(seed_, identity_);
        done = hostile::attackServer(server.port(), frames, 4000, [&] { return !over; });
        over = true;
    });
    const bool followed = eventually(
        [&] {
            for (const auto& timed : client.drain(100)) {
                wall.apply(timed);
            }
            client.shown({wall.replica.stepNumber(), 16'666'667});
            return over.load();
        },
        240000ms);
    over = true;
    attacker.join();
    EXPECT_TRUE(followed);
    EXPECT_GE(done.frames, 4000U);
    EXPECT_GT(done.read, 0U);
    EXPECT_GT(done.refusals, 0U);
    EXPECT_EQ(wall.divergences + wall.outOfOrder, 0);
    EXPECT_EQ(client.counters().reconnects, 0U);
    EXPECT_TRUE(wall.follow(client, wall.replica.stepNumber() + 60)) << client.link().message << server.errors();
    client.stop();
    ASSERT_TRUE(client.report());
    EXPECT_GT(total(client.report()->refused), done.connections / 4) << "each refusal is counted";
    std::printf("%zu frames read, %zu refused unread\n", static_cast<std::size_t>(done.read),
                static_cast<std::size_t>(done.frames - done.read));
    const std::string errors = server.errors();
    std::printf("%zu refusals, %zu lines about them\n", static_cast<std::size_t>(total(client.report()->refused)),
                static_cast<std::size_t>(std::count(errors.begin(), errors.end(), '\n')));
    EXPECT_EQ(server.stop(SIGTERM), 0) << errors;
}

TEST_F(Hostile, AMasterTakesNothingFromAServerThatIsNone) {
    hostile::FalseServer server(seed_, identity_, 1'000'000'000);
    Client client({"127.0.0.1", server.port()}, offerOf(scene_));
    std::size_t most = 0;
    const auto refused = [&] { return total(client.counters().refused) + total(client.counters().refusedHere); };
    EXPECT_TRUE(eventually(
        [&] {
            most = std::max(most, client.drainPositions().size());
            EXPECT_TRUE(client.drain(100).empty()) << "no server was granted the steps";
            return server.positions() > 0 && refused() >= 3;
        },
        240000ms))
        << server.frames() << " frames, " << server.positions() << " positions, " << refused() << " refused";
    EXPECT_LE(most, Client::kMaxPositions + 64 * 1024 / 38);
    EXPECT_EQ(client.counters().stepsIn, 0U);
    client.stop();
}

}  // namespace
