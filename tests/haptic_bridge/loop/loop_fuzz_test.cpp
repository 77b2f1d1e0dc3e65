// SPDX-License-Identifier: Apache-2.0
// Runs whole haptic servers under a virtual clock with random arms, scenes, hands, operators and failures. Checks every
// push of the arm, the records of the ticks, and a replay of them.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/input_error.hpp"
#include "haptic_bridge/hand/arm_numbers.hpp"
#include "haptic_bridge/loop/tick_replay.hpp"
#include "tests/haptic_bridge/loop/random_hand.hpp"
#include "tests/haptic_bridge/loop/tick_check.hpp"
#include "tests/support/seed.hpp"

namespace {

using namespace haptic_bridge;
using test::Dice;

constexpr const char* kLoopCount = "SANDWALL_FUZZ_LOOP";

/// Keeps the ticks and steps of a server as a master's journal does.
class Journal {
public:
    void add(test::VirtualServer& server) {
        if (std::exchange(sitting_, server.sitting()) != server.sitting()) {
            endPiece();
            pieces_.push_back(encode(TrackPiece{sitting_, true, headerOf(server.hand()), {}}));
        }
        piece_.sitting = sitting_;
        piece_.ticks.push_back(server.hand().lastInput());
        appendRow(server.last(), rows_);
        if (piece_.ticks.size() == kMostTicksInPiece) {
            endPiece();
        }
    }
    void keepStep(const sand::Step& step) { steps_.push_back(step); }
    void compareWithReplay(const scene::Scene& scene) {
        endPiece();
        TickReplay replay(scene, pieces_);
        sand::Replica sand(scene);
        std::string rows;
        replay.feel(sand, rows);
        for (const sand::Step& step : steps_) {
            sand.apply(step);
            replay.feel(sand, rows);
        }
        EXPECT_EQ(replay.left(), 0U);
        EXPECT_FALSE(rows.empty());
        EXPECT_TRUE(rows == rows_) << "a replay gives other rows";
    }

private:
    void endPiece() {
        if (!piece_.ticks.empty()) {
            pieces_.push_back(encode(piece_));
            piece_.ticks.clear();
        }
    }

    std::uint32_t sitting_ = 0;
    TrackPiece piece_;
    std::vector<base::Bytes> pieces_;
    std::vector<sand::Step> steps_;
    std::string rows_;
};

/// A random scene, arm and mapping.
struct Draw {
    explicit Draw(Dice& dice)
        : scene(test::randomScene(dice)),
          physics(test::randomArm(dice, !dice.chance(0.05))),
          settings(test::randomSettings(dice, physics, scene)) {}

    /// Returns whether the arm can get limits. A server refuses a law that is not finite at one radius of depth.
    [[nodiscard]] bool hasLimits() const {
        const LawAtRadius law = lawAtRadius(scene);
        const double scale = MappedDevice::scaleFor(physics, settings, scene);
        return std::isfinite(law.stiffness * scale) && std::isfinite(law.drag * scale) && std::isfinite(law.push);
    }

    scene::Scene scene;
    ArmPhysics physics;
    HandSettings settings;
};

/// One random server with its master, operator, hand and failures.
class RandomServer {
public:
    RandomServer(Dice& dice, const Draw& draw)
        : dice_(dice),
          scene_(draw.scene),
          physics_(draw.physics),
          settings_(draw.settings),
          hand_(dice, settings_, physics_, toolInArm(), dice.oneOf({0.0, 0.3, 2.0})),
          server_(
              scene_, physics_, [this](double) { return reading_; }, dice.oneOf({0.0, 0.5, 1.0, 1.0}), settings_),
          check_(scene_, settings_, server_.hand().guards().limits()),
          trouble_(dice.oneOf({0.0, 0.3, 1.0})),
          recorded_(dice.chance(0.3)) {
        EXPECT_EQ(complaintAbout(physics_, "the test"), std::nullopt);
        // From no spread steps to one sweep in a step: a step of 1/60 s has 8 ms for its sand.
        server_.sweepNs = dice.chance(0.3) ? 0 : static_cast<std::int64_t>(dice.scaled(5e3, 2e7));
        server_.onStep = [this](const base::Bytes& message) {
            constexpr std::size_t kLength = 4;  // [byte], of the length of a message
            auto step = std::get<StepMessage>(decode(std::span(message).subspan(kLength))).step;
            if (step.edit.any()) {
                check_.expectEdit(step.number);
                step.edit = asked_.at(step.edit.number);  // a server sends no sand, and the master adds its own
            }
            if (recorded_) {
                journal_.keepStep(step);
            }
        };
    }

    void run(double seconds, test::ActedCounts& counts) {
        for (int tick = 0; tick < seconds * 1000; ++tick) {
            reading_ = hand_.next();
            happen();
            const bool misses = dice_.chance(0.0005 * trouble_);
            server_.tick(misses ? dice_.oneOf({3, 9, 10, 11, 15, 40}) * test::VirtualServer::kTickNs
                                : test::VirtualServer::kTickNs);
            ASSERT_EQ(check_.wrong(server_), "") << "tick " << tick;
            if (server_.moving()) {
                counts.add(server_.last().guards);
                if (recorded_) {
                    journal_.add(server_);
                }
            }
        }
        const auto counted = server_.hand().guardCounts().all();
        EXPECT_EQ(counted, check_.counts.all()) << "counters and records";
        if (recorded_ && check_.counts.ticks() > 0) {
            journal_.compareWithReplay(scene_);
        }
        server_.end();
        EXPECT_EQ(norm(server_.pushed()), 0) << "the last push";
    }

private:
    [[nodiscard]] double toolInArm() const {
        const double scale = MappedDevice::scaleFor(physics_, settings_, scene_);
        return scene_.toolRadius() / (scale * settings_.verticalScale);
    }
    /// Lets master, operator and wall do something in this tick.
    void happen() {
        if (!server_.linked()) {
            if (dice_.chance(0.02)) {
                // A replay cannot know about sand of another session.
                const bool other = !recorded_ && older_ && dice_.chance(0.3);
                server_.link(randomShare(), other ? older_ : std::nullopt);
            }
            return;
        }
        if (dice_.chance(0.001)) {
            older_ = server_.sand();
        }
        if (dice_.chance(0.002)) {
            sand::Edit edit = randomEdit();
            edit.number = asked_.size() + 1;
            asked_.emplace(edit.number, edit);
            server_.edit(std::move(edit));
        }
        if (dice_.chance(server_.hand().tripped() ? 0.005 : 0.0007)) {
            const ForceShare share = randomShare();
            server_.share(share);
            if (share.byOperator && share.share > 0) {
                check_.expectForce();
            }
        }
        if (dice_.chance(0.0004 * trouble_)) {
            server_.unlink();
        }
        if (dice_.chance(server_.sandIsStopped ? 0.003 : 0.0005 * trouble_)) {
            server_.sandIsStopped = !server_.sandIsStopped;
        }
        if (dice_.chance(server_.sandThreadHangs ? 0.02 : 0.0005 * trouble_)) {
            server_.sandThreadHangs = !server_.sandThreadHangs;
        }
    }
    [[nodiscard]] ForceShare randomShare() { return {dice_.oneOf({0.0, 0.4, 1.0, 1.0, 1.0}), dice_.chance(0.5)}; }
    [[nodiscard]] sand::Edit randomEdit() {
        sand::Tuning tuning = server_.sand().rules().tuning;
        switch (dice_.below(6)) {
            case 0:
                return sand::Edit::reset;
            case 1:
                return sand::Edit::undo;
            case 2:
                return sand::Edit::settle;
            case 3:
                tuning.threshold = tuning.startThreshold = test::talusOf(dice_.between(1, 60));
                return sand::Edit::tuned(tuning);
            case 4:
                test::randomTool(dice_, tuning.tool);
                return sand::Edit::tuned(tuning);
            default:
                return sand::Edit::loaded(otherSand().copySand()->encode());
        }
    }
    /// Returns older sand of this server, or in cells also sand that buries the hand.
    [[nodiscard]] sand::Replica otherSand() {
        if (scene_.tin != nullptr || dice_.chance(0.5)) {
            return older_ ? *older_ : server_.sand();
        }
        scene::Scene high = scene_;
        for (int y = 0; y < high.rules.rows; ++y) {
            for (int x = 0; x < high.rules.columns; ++x) {
                high.terrain.setHeight(x, y, (4 + dice_.below(2)) * sand::kUnitsPerCell);
            }
        }
        return sand::Replica(high);
    }

    Dice& dice_;
    scene::Scene scene_;
    ArmPhysics physics_;
    HandSettings settings_;
    test::RandomHand hand_;
    ArmReading reading_;
    test::VirtualServer server_;
    test::TickCheck check_;
    double trouble_;
    bool recorded_;
    Journal journal_;
    std::map<std::uint64_t, sand::Edit> asked_;  // by their numbers
    std::optional<sand::Replica> older_;
};

TEST(LoopFuzz, EveryPushOfARandomServerKeepsTheBoundsAndIsOnRecord) {
    const unsigned seed = test::randomSeed(), count = test::sequences(kLoopCount, 20);
    test::ActedCounts counts;
    for (unsigned i = 0; i < count; ++i) {
        Dice dice(seed + i);
        const Draw draw(dice);
        if (draw.hasLimits()) {
            RandomServer(dice, draw).run(4, counts);
        } else {
            EXPECT_THROW(RandomServer(dice, draw), base::InputError);
        }
        ASSERT_FALSE(HasFailure()) << test::again(seed + i);
    }
    counts.print(kLoopCount, "loop", count, seed);
}

}  // namespace
