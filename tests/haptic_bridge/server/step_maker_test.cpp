// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/step_maker.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/sand/sand_samples.hpp"

namespace {

using namespace haptic_bridge;

/// A hand whose next samples come from the test.
class GivenHand : public DeviceHand {
public:
    using DeviceHand::DeviceHand;
    void drain() override {
        for (const HandSample& sample : std::exchange(samples, {})) {
            add(sample);
        }
    }
    void publish(const sand::Replica& replica, bool withEdit) override {
        felt.push_back(replica.stepNumber());
        if (withEdit) {
            edited.push_back(replica.stepNumber());
        }
    }
    void refresh(const sand::Replica&) override { ++refreshes; }
    [[nodiscard]] bool onHostClock() const override { return true; }

    std::vector<HandSample> samples;
    std::vector<std::uint64_t> felt;    // step number at every publish
    std::vector<std::uint64_t> edited;  // the numbers among them whose step held an edit
    int refreshes = 0;
};

/// A server without thread, clock and link, and the messages that it has sent.
class StepMakerTest : public testing::Test {
protected:
    [[nodiscard]] static StartMessage grantOf(sand::Replica sand, std::uint32_t epoch = 1) {
        return {epoch, sand.stepNumber(), sand.stateHash()};
    }
    void step(std::size_t count = 1) {
        for (std::size_t i = 0; i < count; ++i) {
            maker_.collect();
            maker_.makeStep();
            now_ += 16'666'667;
        }
    }
    [[nodiscard]] static sand::Step engagedStep(std::uint64_t number) {
        sand::Step step;
        step.epoch = 1;
        step.number = number;
        step.engaged = true;
        step.path = {{30 * 256 + static_cast<std::int32_t>(number) * 64, 30 * 256, 0}};
        step.sweeps = 8;  // all that it owes
        return step;
    }

    const scene::Scene scene_ = samples::flatScene(60, 60);
    std::int64_t now_ = 1'000'000'000;
    GivenHand hand_{scene_.rules.stepsPerSecond};
    std::vector<std::uint32_t> ready_;
    std::vector<NeedState> needs_;
    std::vector<std::string> unusable_;
    std::vector<StepMessage> steps_;
    std::vector<Audited> audits_;
    StepMaker maker_{sand::Replica(scene_),
                     hand_,
                     {[this](std::uint32_t session) { ready_.push_back(session); },
                      [this](std::uint32_t, NeedState need) { needs_.push_back(need); },
                      [this](std::uint32_t, std::string why) { unusable_.push_back(std::move(why)); },
                      [this](std::uint32_t, const base::Bytes& message, std::uint64_t edit) {
                          constexpr std::size_t kLength = sizeof(std::uint32_t);
                          steps_.push_back(std::get<StepMessage>(decode(std::span(message).subspan(kLength))));
                          EXPECT_EQ(edit, steps_.back().step.edit.number);
                      },
                      [this](std::uint32_t, Audited result) { audits_.push_back(result); }},
                     [this] { return now_; }};
};

TEST_F(StepMakerTest, BeginsAtOnceOnTheSameSand) {
    EXPECT_FALSE(maker_.running());
    maker_.start(5, grantOf(sand::Replica(scene_), 3));
    EXPECT_EQ(ready_, std::vector<std::uint32_t>{5});
    EXPECT_TRUE(hand_.present());
    hand_.samples = {{now_ - 7, {30 * 256, 30 * 256, 0}, true}};
    step();
    ASSERT_EQ(steps_.size(), 1U);
    EXPECT_EQ(steps_[0].step.epoch, 3U);
    EXPECT_EQ(steps_[0].step.number, 1U);
    EXPECT_TRUE(steps_[0].step.engaged);
    EXPECT_EQ(steps_[0].serverTimeNs, now_ - 16'666'667 - 7) << "when the last sample was read";
    sand::Replica master(scene_);
    master.apply(steps_[0].step);
    EXPECT_EQ(steps_[0].stateHash, master.stateHash());
    EXPECT_EQ(hand_.felt, std::vector<std::uint64_t>{1});
}

TEST_F(StepMakerTest, RefusesALoadThatNoStepOfThisSceneMayHold) {
    maker_.start(1, grantOf(sand::Replica(scene_)));
    const auto most = static_cast<std::size_t>(scene_.rules.stepLimits().mostSandBytes);
    maker_.edit({sand::Edit::loaded(base::Bytes(most + 1))});
    ASSERT_EQ(unusable_.size(), 1U);
    EXPECT_EQ(unusable_[0],
              fmt::format("a load of {} bytes of sand; this scene's steps load at most {}", most + 1, most));
}

TEST_F(StepMakerTest, AsksForTheSandThatItLacksAndJudgesIt) {
    sand::Replica master(scene_);
    master.apply(engagedStep(1));
    maker_.start(1, grantOf(master));
    ASSERT_EQ(needs_, (std::vector<NeedState>{{0, sand::Replica(scene_).stateHash()}}));
    maker_.state({1, 2, 3});
    ASSERT_EQ(unusable_.size(), 1U) << "the bytes are not a state";
    maker_.start(2, grantOf(master));
    maker_.state(sand::Replica(scene_).encodeState());
    EXPECT_EQ(unusable_.size(), 2U) << "the bytes are the state of another step";
    maker_.state(master.encodeState());
    EXPECT_TRUE(ready_.empty()) << "the state was not requested";
    maker_.start(3, grantOf(master));
    maker_.state(master.encodeState());
    EXPECT_EQ(ready_, std::vector<std::uint32_t>{3});
    EXPECT_EQ(sand::Replica(maker_.sand()).stateHash(), master.stateHash());
}

TEST_F(StepMakerTest, CatchesUpByTheStepsThatItLacks) {
    sand::Replica master(scene_);
    std::vector<sand::Step> missed;
    for (std::uint64_t number = 1; number <= 4; ++number) {
        missed.push_back(engagedStep(number));
        master.apply(missed.back());
    }
    maker_.start(1, grantOf(master));
    maker_.catchUp({false, {missed[0], missed[1]}});
    maker_.catchUp({true, {missed[3]}});
    ASSERT_EQ(needs_.size(), 2U) << "a step is missing, so the whole sand is requested";
    EXPECT_EQ(needs_[1], NeedState{});
    maker_.start(2, grantOf(master));
    maker_.catchUp({true, {missed[2], missed[3]}});
    EXPECT_EQ(ready_, std::vector<std::uint32_t>{2});
}

// A NeedState lets a State of 256 MiB come. The CatchUps of one grant may all be waiting when the first does not fit.
TEST_F(StepMakerTest, AsksForTheWholeSandOnceAlthoughMoreCatchUpsWait) {
    maker_.start(1, {1, 40, 1});
    ASSERT_EQ(needs_.size(), 1U);
    for (int i = 0; i < 15; ++i) {
        maker_.catchUp({false, {engagedStep(30)}});
    }
    ASSERT_EQ(needs_.size(), 2U);
    EXPECT_EQ(needs_[1], NeedState{}) << "0 and 0 ask for a State";
    sand::Replica master(scene_);
    master.apply(engagedStep(1));
    maker_.start(2, grantOf(master, 2));
    maker_.catchUp({true, {engagedStep(1)}});
    EXPECT_TRUE(maker_.running()) << "the next master may send steps again";
}

TEST_F(StepMakerTest, IsAWindowAheadOfTheWallAndKeepsTheHandsSandFresh) {
    maker_.refresh();
    EXPECT_EQ(hand_.refreshes, 0) << "no epoch runs";
    maker_.start(1, grantOf(sand::Replica(scene_)));
    step(StepMaker::kWindow + 3);
    EXPECT_EQ(steps_.size(), StepMaker::kWindow);
    EXPECT_EQ(inAll(maker_.withheld()), 3U);
    EXPECT_EQ(hand_.felt.size(), StepMaker::kWindow) << "a withheld step gives no newer sand";
    maker_.refresh();
    EXPECT_EQ(hand_.refreshes, 1) << "the hand continues to feel the sand while the wall waits";
    maker_.shown({100, 16'666'667}, now_);
    step(StepMaker::kWindow + 1);
    EXPECT_EQ(steps_.size(), 2 * StepMaker::kWindow) << "a wall cannot show more than was sent";
    maker_.shown({3, 16'666'667}, now_);
    step();
    EXPECT_EQ(steps_.size(), 2 * StepMaker::kWindow) << "a wall cannot go back either";
}

TEST_F(StepMakerTest, CountsTheStepsThatItWithholdsByTheirCause) {
    const auto withholds = [this](std::size_t steps) {
        step(steps);
        return maker_.withheld();
    };
    maker_.start(1, grantOf(sand::Replica(scene_)));
    step(StepMaker::kWindow);
    EXPECT_EQ(withholds(2), (WithheldCounts{0, 0, 0, 2})) << "the wall has not shown a frame on this link";
    maker_.shown({0, 16'666'667, Held::no}, now_);
    EXPECT_EQ(withholds(3), (WithheldCounts{3, 0, 0, 2}));
    maker_.shown({0, 16'666'667, Held::disk}, now_);
    EXPECT_EQ(withholds(4), (WithheldCounts{3, 4, 0, 2}));
    maker_.shown({0, 16'666'667, Held::pause}, now_);
    EXPECT_EQ(withholds(5), (WithheldCounts{3, 4, 5, 2}));
    maker_.shown({0, 16'666'667, Held::no}, now_);
    EXPECT_EQ(withholds(1), (WithheldCounts{4, 4, 5, 2})) << "the pause is over";
    maker_.shown({0, 16'666'667, Held::pause}, now_);
    maker_.release();
    maker_.start(2, grantOf(maker_.sand(), 2));
    step(StepMaker::kWindow);
    EXPECT_EQ(withholds(1), (WithheldCounts{4, 4, 5, 3})) << "the pause was that of the wall before";
}

TEST_F(StepMakerTest, FindsInAnAuditThatItsMemoryHasChanged) {
    maker_.audit();
    EXPECT_TRUE(audits_.empty()) << "no master is linked";
    maker_.start(1, grantOf(sand::Replica(scene_)));
    hand_.samples = {{now_ - 7, {30 * 256, 30 * 256, 0}, true}};
    step(3);
    maker_.audit();
    EXPECT_EQ(audits_, std::vector<Audited>{Audited::agreed});
    const std::uint64_t sent = steps_.back().stateHash;
    // As a bit flips in memory. The hand is in another tile, so no step hashes this one again.
    const_cast<sand::Replica&>(maker_.sand()).corrupt(5, 50, 3);  // NOLINT(cppcoreguidelines-pro-type-const-cast)
    hand_.samples = {{now_ - 7, {30 * 256, 30 * 256, 0}, false}};
    EXPECT_EQ(const_cast<sand::Replica&>(maker_.sand()).stateHash(), sent) << "its hash does not tell";
    maker_.audit();
    EXPECT_EQ(audits_, (std::vector<Audited>{Audited::agreed, Audited::differed}));
    maker_.release();
    needs_.clear();
    sand::Replica wall(scene_);
    for (const StepMessage& made : steps_) {
        wall.apply(made.step);
    }
    maker_.start(2, grantOf(wall, 2));
    EXPECT_EQ(needs_.size(), 1U) << "it asks for the wall's sand, because its own hash is another now";
}

TEST_F(StepMakerTest, PutsAnEditIntoOneStepAndForgetsItWithItsMaster) {
    maker_.start(1, grantOf(sand::Replica(scene_)));
    maker_.edit({samples::withNumber(9, sand::Edit::settle)});
    step(2);
    EXPECT_EQ(steps_[0].step.edit, samples::withNumber(9, sand::Edit::settle));
    EXPECT_FALSE(steps_[1].step.edit.any());
    maker_.edit({sand::Edit(sand::Edit::reset)});
    maker_.release();
    EXPECT_FALSE(hand_.present());
    maker_.start(2, grantOf(maker_.sand(), 2));
    step();
    EXPECT_FALSE(steps_[2].step.edit.any());
    EXPECT_EQ(hand_.edited, std::vector<std::uint64_t>{1}) << "the hand knows which sand an edit made";
}

// The sand of a load is decoded before it is in a step, because every rank has to apply a step.
TEST_F(StepMakerTest, RefusesALoadThatIsNoSandOfItsScene) {
    maker_.start(1, grantOf(sand::Replica(scene_)));
    maker_.edit({sand::Edit::loaded({1, 2, 3})});
    EXPECT_EQ(unusable_.size(), 1U);
    step();
    EXPECT_FALSE(steps_[0].step.edit.any());
    maker_.edit({samples::withNumber(5, sand::Edit::loaded(maker_.sand().copySand()->encode()))});
    step();
    EXPECT_EQ(unusable_.size(), 1U);
    EXPECT_EQ(steps_[1].step.edit.kind, sand::Edit::load);
}

TEST_F(StepMakerTest, SendsTheNumberOfALoadAndNotItsSand) {
    sand::Replica master(scene_);
    master.apply(engagedStep(1));
    maker_.start(1, grantOf(sand::Replica(scene_)));
    const sand::Edit load = samples::withNumber(5, sand::Edit::loaded(master.copySand()->encode()));
    maker_.edit({load});
    step();
    ASSERT_EQ(steps_[0].step.edit.number, 5U);
    ASSERT_EQ(steps_[0].step.edit.kind, sand::Edit::load);
    EXPECT_TRUE(steps_[0].step.edit.sand->empty());
    sand::Replica wall(scene_);
    sand::Step whole = steps_[0].step;
    whole.edit = load;
    wall.apply(whole);
    EXPECT_EQ(wall.stateHash(), steps_[0].stateHash) << "its own replica has loaded it";
}

TEST_F(StepMakerTest, LiftsAToolThatTheMasterBeforeLeftInTheSand) {
    maker_.start(1, grantOf(sand::Replica(scene_)));
    hand_.samples = {{now_, {30 * 256, 30 * 256, 0}, true}};
    step();
    ASSERT_TRUE(maker_.sand().engaged());
    maker_.release();
    hand_.samples = {{now_, {20 * 256, 20 * 256, 0}, true}};
    maker_.collect();  // dropped, because no master is linked
    maker_.start(2, grantOf(maker_.sand(), 2));
    hand_.samples = {{now_, {40 * 256, 40 * 256, 0}, true}};
    step(2);
    EXPECT_FALSE(steps_[1].step.engaged);
    EXPECT_TRUE(steps_[1].step.path.empty()) << "no furrow from the old place to the hand";
    EXPECT_TRUE(steps_[2].step.engaged);
    EXPECT_EQ(steps_[2].step.path, (std::vector<sand::ProbePoint>{{40 * 256, 40 * 256, 0}}));
}

}  // namespace
