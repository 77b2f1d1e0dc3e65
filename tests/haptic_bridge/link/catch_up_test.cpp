// SPDX-License-Identifier: Apache-2.0
// Tests that a server gets the sand of its master.
#include <utility>

#include "haptic_bridge/link/step_ring.hpp"
#include "tests/haptic_bridge/link/link_security_fixture.hpp"
#include "tests/haptic_bridge/link/raw_peer.hpp"

namespace {

using namespace haptic_bridge;
using namespace test;

// A server that is a few steps behind gets these steps, by number. A server whose sand has another history gets the
// whole sand.
TEST_F(LinkSecurityTest, CatchesUpByStepsOnTheSameHistoryAndByTheSandElse) {
    ServerProcess server(folder_, arguments({}));
    Wall wall(scene_);
    StepRing ring;
    const auto own = [&](int steps) {  // as a master that numbers its own steps
        ++wall.epoch;
        for (int i = 0; i < steps; ++i) {
            sand::Step step{wall.epoch, wall.replica.stepNumber() + 1, false, {}};
            step.edit = i == 0 ? sand::Edit(sand::Edit::settle) : sand::Edit();
            step.sweeps = wall.replica.wholeSweeps(step);
            wall.replica.apply(step);
            ring.add(step);
            ring.reached(step.number, wall.replica.stateHash());
        }
    };
    const auto follow = [&](const StepRing& recent) {
        Client client(server.address(), offerOf(scene_));
        EXPECT_TRUE(eventually([&] { return client.link().link == Link::offered; })) << client.link().message;
        client.grant(++wall.epoch, wall.replica.stepNumber(), wall.replica.stateHash(), recent);
        const std::uint64_t until = wall.replica.stepNumber() + 60;
        EXPECT_TRUE(eventually([&] {
            if (client.needsState()) {
                client.giveState(wall.replica.encodeState());
            }
            for (const auto& timed : client.drain(until - wall.replica.stepNumber())) {
                wall.apply(timed);
                ring.add(timed.step);
                ring.reached(timed.step.number, timed.serverHash);
            }
            client.shown({wall.replica.stepNumber(), 16'666'667});
            return wall.replica.stepNumber() >= until;
        })) << client.link().message
            << server.errors();
        // The server made a step that this wall never applies, so the server has another history from here on.
        EXPECT_TRUE(eventually([&] { return !client.drain(1).empty(); })) << client.link().message;
        return std::pair{client.counters().catchUps, client.counters().snapshots};
    };
    using Counts = std::pair<std::uint64_t, std::uint64_t>;
    ring.reached(0, wall.replica.stateHash());
    own(40);
    EXPECT_EQ(follow(ring), Counts(1, 0)) << "from the first step on";
    // The server made a step in its last session that this wall does not have.
    own(30);
    EXPECT_EQ(follow(ring), Counts(0, 1));
    own(10);
    StepRing forgetful;
    forgetful.reached(wall.replica.stepNumber(), wall.replica.stateHash());
    EXPECT_EQ(follow(forgetful), Counts(0, 1));
    EXPECT_EQ(wall.divergences + wall.outOfOrder, 0);
}

TEST_F(LinkSecurityTest, TakesSoManyCatchUpsAndNoneAfterTheLast) {
    ServerProcess server(folder_, arguments({}));
    const auto hear = [](RawPeer& peer) {  // the next message that is not a report
        auto message = peer.receive();
        while (message && std::holds_alternative<Report>(*message)) {
            message = peer.receive();
        }
        return message;
    };
    for (const bool last : {false, true}) {
        RawPeer master(server.port());
        master.send(hello());
        ASSERT_TRUE(master.receive()) << "the welcome";
        master.send(StartMessage{1, 5, 1});
        const auto need = hear(master);
        ASSERT_TRUE(need && std::holds_alternative<NeedState>(*need));
        const std::size_t most = last ? 1 : StepRing::kSteps / kMaxCatchUp;
        for (std::size_t i = 0; i < most; ++i) {
            master.send(CatchUp{last, {}});
        }
        if (last) {
            ASSERT_TRUE(hear(master)) << "the steps do not lead there, so the whole sand is requested";
        }
        master.send(CatchUp{true, {}});
        const auto answer = hear(master);
        ASSERT_TRUE(answer && std::holds_alternative<Refusal>(*answer)) << last;
        EXPECT_NE(std::get<Refusal>(*answer).text.find("out of turn"), std::string::npos);
    }
}

}  // namespace
