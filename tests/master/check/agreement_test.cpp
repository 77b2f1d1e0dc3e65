// SPDX-License-Identifier: Apache-2.0
// The master and ranks that differ, without MPI. Each rank is a replica in this process.
#include "master/check/agreement.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "master/steps/recorded_steps.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/sand/no_steps.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using lockstep::Arrival;
using lockstep::Divergence;
using lockstep::Healing;
using lockstep::Remedy;
using lockstep::Verdict;

const scene::Scene& sceneOfRanks() {
    static const scene::Scene scene = samples::flatScene(24, 24);
    return scene;
}

/// Two render ranks, whose sand a test may corrupt.
class FakeRanks : public master::Ranks {
public:
    Verdict meet(const Arrival& mine, std::int64_t /* nextFrame */) override {
        ++meetings;
        arrivals_ = {mine, mine, mine};
        for (std::size_t i = 0; i < 2; ++i) {
            arrivals_[i + 1].stateHash = hashOf(replicas[i]);
            arrivals_[i + 1].viewHash ^= i == 1 && otherView ? 1 : 0;
        }
        const auto differs = [&](auto hash) {
            return arrivals_[1].*hash != mine.*hash || arrivals_[2].*hash != mine.*hash;
        };
        return !nonsense_.empty()             ? Verdict::nonsense
               : differs(&Arrival::stateHash) ? Verdict::otherSand
               : differs(&Arrival::viewHash)  ? Verdict::otherView
                                              : Verdict::equal;
    }
    Divergence findDivergence(sand::Replica& mine, const lockstep::Arbiter& arbiter) override {
        const std::vector<std::uint64_t> hashes{hashOf(mine), hashOf(replicas[0]), hashOf(replicas[1])};
        std::vector<lockstep::Account> accounts;
        accounts.reserve(hashes.size());
        for (const std::uint64_t hash : hashes) {
            accounts.push_back({hash, 0, {}});
        }
        const lockstep::Vote vote = lockstep::countVotes(accounts);
        Divergence result;
        result.rightHash = hashes[static_cast<std::size_t>(vote.rank)];
        result.agreeing = vote.agreeing;
        if (vote.tie || arbiter.overrules) {
            result.outvoted = arbiter.overrules;
            result.journal = arbiter.sand();
            result.judge = result.journal ? Divergence::Judge::journal : Divergence::Judge::master;
            result.rightHash = result.journal ? hashOf(*result.journal) : hashes[0];
        }
        result.source = -1;
        for (int rank = 0; rank < 3; ++rank) {
            if (hashes[static_cast<std::size_t>(rank)] != result.rightHash) {
                result.odd.push_back({rank, hashes[static_cast<std::size_t>(rank)], false, -1, {}, 0});
            } else if (result.source < 0) {
                result.source = rank;
                result.journal.reset();
            }
        }
        return result;
    }
    Healing heal(sand::Replica& mine, const Remedy& remedy) override {
        if (!remedy.goOn) {
            return Healing::ended;
        }
        const sand::Replica right = remedy.source == 0 ? mine : replicas[static_cast<std::size_t>(remedy.source) - 1];
        Healing result = Healing::spared;
        for (const int rank : remedy.odd) {
            if (rank == 0) {
                mine = right;
                result = Healing::healed;
            } else if (rank != incurable) {
                replicas[static_cast<std::size_t>(rank) - 1] = right;
            }
        }
        return result;
    }
    [[nodiscard]] const std::vector<Arrival>& arrivals() const override { return arrivals_; }
    [[nodiscard]] const std::vector<lockstep::FrameBarrier::Nonsense>& nonsense() const override { return nonsense_; }
    void talkNonsense() { nonsense_ = {{2, "frame 1: rank 2 sent an invalid arrival"}}; }

    std::vector<sand::Replica> replicas{sand::Replica(sceneOfRanks()), sand::Replica(sceneOfRanks())};
    bool otherView = false;
    int incurable = -1;
    int meetings = 0;

private:
    static std::uint64_t hashOf(sand::Replica& sand) {
        sand.audit(sand.hashTiles().tileCount());
        return sand.stateHash();
    }

    std::vector<Arrival> arrivals_;
    std::vector<lockstep::FrameBarrier::Nonsense> nonsense_;
};

/// Counts how often the master's own sand was healed.
class HealedSteps : public test::NoSteps {
public:
    void healed(sand::Replica& /* sand */) override { ++healings; }

    int healings = 0;
};

class AgreementTest : public test::FolderTest {
protected:
    /// Flips bit `bit` in the sand of a rank.
    void spoil(int rank, int bit) {
        sand::Replica& sand = rank == 0 ? sand_.replica() : ranks_.replicas[static_cast<std::size_t>(rank) - 1];
        sand.corrupt(2, 2, bit);
        if (rank == 0) {
            sand.audit(sand.hashTiles().tileCount());
            sand_.rehash();
        }
    }
    bool reach() {
        ++frame_;
        return agreement_.reach({frame_, 0, 0, 0, sand_.hash(), 5}, sand_, steps_, 0);
    }
    std::string read(const std::string& file) const {
        std::ifstream stream(folder_ / file);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    nlohmann::json failure() const { return nlohmann::json::parse(read("failure.json"), nullptr, false); }

    const std::uint64_t right_ = sand::Replica(sceneOfRanks()).stateHash();
    master::MasterSand sand_{sand::Replica(sceneOfRanks())};
    FakeRanks ranks_;
    HealedSteps steps_;
    master::Incidents incidents_;
    lockstep::RankStatistics statistics_{3};
    bool hasJournal_ = false;
    int asked_ = 0;  // times that the journal was asked for its sand
    master::Agreement agreement_{
        ranks_,
        {{"the master", "rank 1", "rank 2"}, {"h0", "h1", "h2"}, {"", "r1c1", "r1c2"}},
        folder_,
        incidents_,
        statistics_,
        {[this] { return hasJournal_ ? folder_ / "session.journal" : std::filesystem::path(); },
         [this] {
             ++asked_;
             return hasJournal_ ? std::make_unique<sand::Replica>(sceneOfRanks()) : nullptr;
         }}};
    std::uint64_t frame_ = 0;
};

TEST_F(AgreementTest, OfEqualRanksIsOneMeeting) {
    EXPECT_TRUE(reach());
    EXPECT_EQ(ranks_.meetings, 1);
    EXPECT_EQ(incidents_.divergences, 0U);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "divergence.txt"));
}

TEST_F(AgreementTest, ARankThatDiffersTakesTheSandOfTheOthersAndMeetsThemAgain) {
    spoil(2, 3);
    EXPECT_TRUE(reach());
    EXPECT_EQ(ranks_.meetings, 2);
    EXPECT_EQ(ranks_.replicas[1].stateHash(), right_);
    EXPECT_EQ(incidents_.divergences, 1U);
    EXPECT_EQ(incidents_.healed, 1U);
    EXPECT_EQ(statistics_.ranks()[2].healed, 1U);
    EXPECT_EQ(steps_.healings, 0) << "the master was right";
    EXPECT_EQ(asked_, 0) << "with a majority the journal is not used";
    EXPECT_NE(read("divergence.txt").find("rank 2"), std::string::npos);
}

TEST_F(AgreementTest, TheMasterItselfIsHealedAndItsStepsAreTold) {
    spoil(0, 3);
    EXPECT_TRUE(reach());
    EXPECT_EQ(sand_.hash(), right_);
    EXPECT_EQ(sand_.replica().stateHash(), right_);
    EXPECT_EQ(steps_.healings, 1);
}

TEST_F(AgreementTest, WithoutAMajorityTheJournalJudgesAndTheMasterPassesItsSandOn) {
    hasJournal_ = true;
    spoil(0, 3);
    spoil(1, 4);
    spoil(2, 5);
    EXPECT_TRUE(reach());
    EXPECT_EQ(asked_, 1);
    EXPECT_EQ(sand_.hash(), right_);
    EXPECT_EQ(ranks_.replicas[0].stateHash(), right_);
    EXPECT_EQ(ranks_.replicas[1].stateHash(), right_);
    EXPECT_EQ(incidents_.healed, 3U);
}

TEST_F(AgreementTest, WithoutAJournalTheMasterIsRight) {
    spoil(0, 3);
    spoil(1, 4);
    const std::uint64_t mine = sand_.hash();
    EXPECT_TRUE(reach());
    EXPECT_EQ(sand_.hash(), mine);
    EXPECT_EQ(ranks_.replicas[1].stateHash(), mine) << "rank 2 was right, but without a majority the master decides";
}

TEST_F(AgreementTest, AMajorityDecidesUntilTheJournalOutvotesIt) {
    spoil(1, 3);
    spoil(2, 3);
    EXPECT_TRUE(reach());
    EXPECT_NE(sand_.hash(), right_) << "the master was right, and has taken the sand of the majority";
    const auto decided = agreement_.takeDecision();
    ASSERT_TRUE(decided.has_value());
    EXPECT_EQ(decided->sand.hash, sand_.hash());
    EXPECT_FALSE(agreement_.takeDecision().has_value());

    agreement_.overrule(std::make_unique<sand::Replica>(sceneOfRanks()));
    EXPECT_TRUE(reach());
    EXPECT_EQ(sand_.hash(), right_);
    EXPECT_EQ(ranks_.replicas[0].stateHash(), right_);
    EXPECT_EQ(ranks_.replicas[1].stateHash(), right_);
    EXPECT_EQ(incidents_.healed, 4U) << "the master, and then all three";
    EXPECT_FALSE(agreement_.takeDecision().has_value());
    EXPECT_EQ(asked_, 0) << "the journal's sand was there already";
    EXPECT_TRUE(reach());
    EXPECT_EQ(ranks_.meetings, 5) << "two, two and one";
}

TEST_F(AgreementTest, TheDecisionOfAMajorityIsAboutTheSandAfterHealing) {
    sand_.replica().apply({.epoch = 1, .number = 1, .engaged = false, .path = {}});
    sand_.rehash();
    EXPECT_TRUE(reach());
    const auto decided = agreement_.takeDecision();
    ASSERT_TRUE(decided.has_value());
    EXPECT_EQ(decided->sand.step, 0U) << "the master's own sand was the wrong one";
    EXPECT_EQ(decided->sand.hash, right_);
}

TEST_F(AgreementTest, ARankThatIsGivenUpIsNoDecision) {
    for (int bit = 3; bit < 6; ++bit) {
        (void)agreement_.takeDecision();
        spoil(2, bit);
        EXPECT_EQ(reach(), bit < 5);
    }
    EXPECT_FALSE(agreement_.takeDecision().has_value());
}

// The master was right. A wrong majority has healed it twice, which must not count against it. The second time, no hash
// has a majority any more when the journal outvotes the earlier one.
TEST_F(AgreementTest, ARankThatAWrongMajorityHealedIsNotBroken) {
    for (int time = 0; time < 2; ++time) {
        spoil(1, 3);
        spoil(2, 3);
        EXPECT_TRUE(reach());
        if (time == 1) {
            spoil(1, 5);
            spoil(2, 6);
        }
        agreement_.overrule(std::make_unique<sand::Replica>(sceneOfRanks()));
        EXPECT_TRUE(reach());
    }
    spoil(0, 5);
    EXPECT_TRUE(reach()) << "the first fault of the master's own memory";
    spoil(1, 7);
    EXPECT_FALSE(reach()) << "the third fault of rank 1";
    EXPECT_EQ(failure()["rank"], 1);
}

TEST_F(AgreementTest, AnOverruleThatChangesNothingIsOneMeeting) {
    agreement_.overrule(std::make_unique<sand::Replica>(sceneOfRanks()));
    EXPECT_TRUE(reach());
    EXPECT_EQ(ranks_.meetings, 1);
    EXPECT_EQ(incidents_.healed, 0U);
}

TEST_F(AgreementTest, MemoryThatNeedsHelpAThirdTimeIsGivenUp) {
    for (int time = 0; time < 2; ++time) {
        spoil(2, 3 + time);
        EXPECT_TRUE(reach()) << time;
        statistics_.add(ranks_.arrivals(), false);
    }
    spoil(2, 7);
    EXPECT_FALSE(reach());
    EXPECT_EQ(failure()["what"], "broken");
    EXPECT_EQ(failure()["rank"], 2);
    EXPECT_EQ(failure()["host"], "h2");
    EXPECT_EQ(failure()["tile"], "r1c2");
    EXPECT_EQ(incidents_.divergences, 3U);
    EXPECT_EQ(incidents_.healed, 2U);
    EXPECT_EQ(agreement_.unhealed(), 1U);
}

TEST_F(AgreementTest, ARankThatHealingDoesNotHelpIsGivenUpAtOnce) {
    ranks_.incurable = 1;
    spoil(1, 3);
    EXPECT_FALSE(reach());
    EXPECT_EQ(failure()["rank"], 1);
    EXPECT_EQ(incidents_.divergences, 1U) << "one frame";
    EXPECT_EQ(agreement_.unhealed(), 1U);
}

TEST_F(AgreementTest, AnotherViewEndsTheSession) {
    ranks_.otherView = true;
    EXPECT_FALSE(reach());
    EXPECT_EQ(failure()["what"], "broken");
    EXPECT_EQ(failure()["rank"], 2);
    EXPECT_EQ(incidents_.divergences, 1U);
    EXPECT_EQ(incidents_.healed, 0U);
    EXPECT_EQ(statistics_.ranks()[2].differed, 1U);
    EXPECT_EQ(agreement_.unhealed(), 1U);
}

TEST_F(AgreementTest, NonsenseEndsTheSession) {
    ranks_.talkNonsense();
    EXPECT_FALSE(reach());
    EXPECT_EQ(failure()["rank"], 2);
    EXPECT_EQ(incidents_.divergences, 0U) << "its sand is unknown";
}

}  // namespace
