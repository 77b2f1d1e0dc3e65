// SPDX-License-Identifier: Apache-2.0
// Answers to a `settle` that lets the sand settle by sweeps.
#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "tests/master/operator/operator_desk_fixture.hpp"

namespace {

using master::ArrivedStep;
using nlohmann::json;

/// A tower of sand on rock settles by sweeps, and so in several steps.
class DeskOnRock : public test::OperatorDeskTest {
protected:
    explicit DeskOnRock(scene::Scene scene = towerOnRock()) : OperatorDeskTest(std::move(scene)) {}
    static scene::Scene towerOnRock() {
        scene::Scene scene = samples::flatScene(32, 24);
        auto ground = std::make_shared<sand::Ground>(32, 24);
        ground->setBedrock(0, 0, scene.terrain.height(0, 0));
        scene.ground = ground;
        scene.terrain.setHeight(16, 12, scene.terrain.height(16, 12) + 400 * sand::kUnitsPerCell);
        return scene;
    }
    /// Shows these steps in one frame. A tool that is engaged stays so.
    void takeFrame(const std::vector<sand::Step>& frame) {
        std::vector<ArrivedStep> steps;
        bool engaged = sand_.replica().engaged();
        for (const sand::Step& step : frame) {
            engaged = engaged || step.engaged;
            ArrivedStep& timed = steps.emplace_back();
            timed.step = step;
            timed.step.number = sand_.replica().stepNumber() + steps.size();
            timed.step.engaged = engaged;
        }
        edits_.moveInto(steps);
        sand_.apply(1, steps, 0, source_);
        desk_->answer(steps);
    }
    void take(const sand::Step& step) { takeFrame({step}); }
    /// Asks for a settle that no step has yet, and returns it with its answer.
    std::pair<sand::Edit, std::future<json>> asked() {
        const std::size_t before = edits().size();
        std::future<json> answer = send("settle");
        obeyUntil([&] { return edits().size() > before; });
        return {edits().back(), std::move(answer)};
    }
    static bool waits(const std::future<json>& answer) {
        return answer.wait_for(std::chrono::milliseconds(20)) == std::future_status::timeout;
    }
    /// Asks for a settle and shows the first step of it, which leaves sand to slide.
    std::future<json> settle() {
        auto [edit, answer] = asked();
        take({.edit = edit, .sweeps = 5});
        EXPECT_TRUE(sand_.replica().settling());
        EXPECT_TRUE(waits(answer)) << "it continues";
        return std::move(answer);
    }
    /// Takes steps until a settle has come to rest.
    void rest() {
        for (int steps = 0; steps < 100 && sand_.replica().settling(); ++steps) {
            take({.sweeps = sand::kMostSweeps});
        }
        EXPECT_FALSE(sand_.replica().settling());
    }
};

/// A cliff over a field of 512 x 512 cells settles at once, but its step has too little work for all of it.
class DeskOnCliff : public DeskOnRock {
protected:
    DeskOnCliff() : DeskOnRock(cliff()) {}
    static scene::Scene cliff() {
        scene::Scene scene = samples::flatScene(512, 512);
        for (int y = 0; y < 512; ++y) {
            for (int x = 0; x < 512; ++x) {
                scene.terrain.setHeight(x, y, x < 256 ? sand::kMaxHeight : -sand::kMaxHeight);
            }
        }
        return scene;
    }
};

TEST_F(DeskOnCliff, SaysWhatHasEndedASettleThatItsStepHasNotFinished) {
    std::future<json> byHand = settle();
    take({.engaged = true, .path = {{2048, 2048, 0}}, .sweeps = 1});
    EXPECT_EQ(await(byHand), (json{{"ok", true}, {"step", 1}, {"settle_ended_by", "hand"}}));
}

TEST_F(DeskOnRock, SaysWhatHasEndedASettleOfSeveralSteps) {
    std::future<json> byHand = settle();
    take({.engaged = true, .path = {{2048, 2048, 0}}, .sweeps = 1});
    EXPECT_EQ(await(byHand), (json{{"ok", true}, {"step", 1}, {"settle_ended_by", "hand"}}));

    std::future<json> byReset = settle();
    take({.engaged = true, .edit = sand::Edit::reset, .sweeps = 1});
    EXPECT_EQ(await(byReset), (json{{"ok", true}, {"step", 3}, {"settle_ended_by", "edit"}}));

    std::future<json> replaced = settle(), paused = settle();
    EXPECT_EQ(await(replaced), (json{{"ok", true}, {"step", 5}, {"settle_ended_by", "edit"}}));
    EXPECT_EQ(ask("pause"), json({{"ok", true}}));
    EXPECT_EQ(await(paused), (json{{"ok", true}, {"step", 6}, {"settling", true}}));
    ask("resume");

    std::future<json> toRest = settle();
    rest();
    EXPECT_EQ(await(toRest), (json{{"ok", true}, {"step", 7}, {"settle_ended_by", "rest"}}));
}

TEST_F(DeskOnRock, SaysThatASettleHasEndedAtRestInItsOwnStep) {
    std::future<json> slow = settle();
    rest();
    ASSERT_EQ(await(slow)["settle_ended_by"], "rest");
    auto [edit, answer] = asked();
    take({.edit = edit, .sweeps = 5});
    const std::uint64_t step = sand_.replica().stepNumber();
    EXPECT_FALSE(sand_.replica().settling());
    EXPECT_EQ(await(answer), (json{{"ok", true}, {"step", step}, {"settle_ended_by", "rest"}}));
}

/// A frame may have several steps. Each client is told the end of its own settle.
TEST_F(DeskOnRock, SaysHowEachOfTheSettlesOfAFrameHasEnded) {
    std::future<json> first = settle();
    auto [second, secondAnswer] = asked();
    auto [third, thirdAnswer] = asked();
    takeFrame({{.engaged = true, .path = {{2048, 2048, 1 << 20}}, .sweeps = 1},  // high above the sand
               {.edit = second, .sweeps = 5},
               {.edit = third, .sweeps = 5}});
    EXPECT_EQ(await(first), (json{{"ok", true}, {"step", 1}, {"settle_ended_by", "hand"}}));
    EXPECT_EQ(await(secondAnswer), (json{{"ok", true}, {"step", 3}, {"settle_ended_by", "edit"}}));
    EXPECT_TRUE(waits(thirdAnswer)) << "it continues";
    rest();
    EXPECT_EQ(await(thirdAnswer), (json{{"ok", true}, {"step", 4}, {"settle_ended_by", "rest"}}));
}

/// An undo without a stroke and a load of other sand change nothing. The settle continues to its rest.
TEST_F(DeskOnRock, AnEditWithoutEffectDoesNotEndASettle) {
    std::future<json> answer = settle();
    for (int steps = 0; steps < 100 && sand_.replica().settling(); ++steps) {
        take({.edit = sand::Edit::undo, .sweeps = sand::kMostSweeps});
    }
    EXPECT_EQ(await(answer), (json{{"ok", true}, {"step", 1}, {"settle_ended_by", "rest"}}));
}

}  // namespace
