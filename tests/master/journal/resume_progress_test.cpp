// SPDX-License-Identifier: Apache-2.0
// A resume tells how far it is. The ranks wait as long as it gets further.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/input_error.hpp"
#include "master/journal/journal.hpp"
#include "master/journal/resume.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/master/journal/resume_fixture.hpp"
#include "tests/support/journal/read_session.hpp"
#include "tests/support/refusal.hpp"

namespace {

using test::Resume;

TEST_F(Resume, TellsHowMuchOfTheJournalIsReadAndReplayed) {
    std::filesystem::remove_all(folder_ / "checkpoints");
    std::vector<double> read, replayed;
    const auto session = test::readSession(journal(), "",
                                           {.read = [&](double share) { read.push_back(share); },
                                            .replayed = [&](double share) { replayed.push_back(share); }});
    EXPECT_EQ(session->replayedSteps, 40U);
    EXPECT_EQ(read.size(), 20U + 1) << "of each record, and at the end";
    EXPECT_GE(replayed.size(), 40U) << "of each step";
    for (const auto* shares : {&read, &replayed}) {
        EXPECT_TRUE(std::is_sorted(shares->begin(), shares->end()));
        EXPECT_LT(shares->front(), 0.4) << "the header is read";
        EXPECT_LT(shares->at(shares->size() / 2), 0.8);
        EXPECT_EQ(shares->back(), 1);
    }
}

// Such a replay takes longer, and the ranks must not give up meanwhile.
TEST_F(Resume, TellsThatTheReplayBeginsAgainFromAnEarlierCheckpoint) {
    const std::uint64_t session = master::openJournal(journal()).header().session;
    std::filesystem::remove(master::checkpointFile(journal(), 40));
    replica_.corrupt(5, 5);
    replica_.audit(replica_.hashTiles().tileCount());
    ASSERT_NE(replica_.stateHash(), hashes_[40]);
    keepCheckpoint(session);
    {
        master::JournalWriter writer(test::readSession(journal())->place, "test");
        writer.finish(40, hashes_[40]);
    }
    std::vector<double> shares;
    const auto resumed = test::readSession(journal(), "", {.replayed = [&](double share) { shares.push_back(share); }});
    EXPECT_EQ(resumed->hash, hashes_[40]);
    EXPECT_EQ(resumed->checkpointStep, 30U);
    int begun = 1;
    for (std::size_t i = 1; i < shares.size(); ++i) {
        begun += shares[i] < shares[i - 1] ? 1 : 0;
    }
    EXPECT_EQ(begun, 2);
    EXPECT_EQ(shares.back(), 1);
}

// The state comes from the file of the checkpoint, or from the replica after later steps.
TEST_F(Resume, SendsTheSandAfterTheLastStepToTheRanks) {
    for (const bool replays : {false, true}) {
        if (replays) {
            std::filesystem::remove(master::checkpointFile(journal(), 40));
        }
        const auto session = test::readSession(journal(), "");
        EXPECT_EQ(session->replayedSteps, replays ? 10U : 0U);
        sand::Replica rank(session->scene);
        rank.decodeState(session->state);
        EXPECT_EQ(rank.stateHash(), hashes_[40]);
        EXPECT_EQ(rank.encodeState(), session->sand->encodeState());
    }
}

TEST_F(Resume, ComparesTheNamedSceneWithTheJournalsAndTellsTheProgress) {
    const std::filesystem::path file = folder_ / "scene.toml", other = folder_ / "other" / "session.journal";
    std::ofstream(file) << "name = \"other\"\n[field]\ncolumns = 40\nrows = 30\n[terrain]\n[material]\n";
    std::filesystem::create_directories(other.parent_path());
    { master::JournalWriter writer(other, scene::loadScene(file), "test"); }
    const scene::Scene recorded = master::openSession(other, file)->scene;
    for (const std::string& named : {file.string(), std::string()}) {
        std::vector<double> shares;
        master::SceneCheck check(named, recorded, other);
        EXPECT_TRUE(check.isShort());
        check.require([&](double share) { shares.push_back(share); });
        EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
        EXPECT_EQ(shares.empty(), named.empty());
        EXPECT_EQ(shares.empty() ? 1 : shares.back(), 1);
        shares.clear();
        check.require([&](double share) { shares.push_back(share); });
        check.requireIfCompared();
        EXPECT_EQ(shares.size(), 0U) << "of what is compared already";
    }
}

TEST_F(Resume, ChecksTheMemoryBeforeTheSceneIsDecoded) {
    std::string checked;
    const auto check = [&](const journal::JournalReader& reader) {
        checked = reader.place().journal;
        throw base::InputError("too large");
    };
    EXPECT_EQ(test::refusalOf([&] { (void)master::openSession(journal(), "missing.toml", check); }), "too large");
    EXPECT_EQ(checked, journal().string());
}

TEST_F(Resume, AJournalThatIsOpenedAgainBeginsAfterItsHeader) {
    const journal::JournalReader opened = master::openJournal(journal());
    const auto records = [](journal::JournalReader reader) {
        int count = 0;
        while (reader.next()) {
            ++count;
        }
        return count;
    };
    const int all = records(master::openJournal(journal()));
    EXPECT_GE(all, 20);
    for (int time = 0; time < 2; ++time) {
        journal::JournalReader again = master::openAgain(journal(), opened);
        EXPECT_EQ(&again.header(), &opened.header()) << "shares the header";
        EXPECT_EQ(again.place().session, opened.place().session);
        EXPECT_EQ(records(std::move(again)), all);
    }
    std::filesystem::resize_file(journal(), static_cast<std::uintmax_t>(opened.place().offset - 1));
    EXPECT_EQ(test::refusalOf([&] { (void)master::openAgain(journal(), opened); }),
              journal().string() + ": has changed since it was opened");
}

}  // namespace
