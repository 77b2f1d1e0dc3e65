// SPDX-License-Identifier: Apache-2.0
// The memory that a journal's sand needs on the ranks is checked before the sand is made.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "master/journal/journal.hpp"
#include "master/start_up.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/master/journal/huge_journal.hpp"
#include "tests/support/refusal.hpp"

namespace {

using test::kGibibyte;

class JournalMemory : public test::HugeJournal {
protected:
    const walls::Wall wall_;  // without pictures
    const std::vector<lockstep::RankHost> roomy_{{"a", kGibibyte}};
};

// The scene in this journal ends after its rules, so that decoding its heights would fail.
TEST_F(JournalMemory, IsRefusedBeforeItsHeightsAreMade) {
    const std::filesystem::path journal = journalOf(rulesOfAHugeField());
    const auto refusalOn = [&](std::int64_t free) {
        const std::vector<lockstep::RankHost> ranks{{"a", free}, {"a", free}};
        return test::refusalOf([&] { master::requireMemoryOfJournal({ranks, wall_}, master::openJournal(journal)); });
    };
    const std::string refused = refusalOn(16 * kGibibyte);
    EXPECT_TRUE(refused.starts_with(journal.string() + ": 16384 x 16384 cells need ")) << refused;
    EXPECT_TRUE(refused.ends_with(" GiB for the 2 ranks on a, where 16.0 GiB are free; use fewer cells, or more hosts"))
        << refused;
}

TEST_F(JournalMemory, OfATinIsRefused) {
    const std::filesystem::path file = folder_ / "s.toml";
    std::ofstream(file) << "[field]\ncolumns = 64\n[terrain]\n[material]\n[tool]\nradius = 0.1\n[tin]\n";
    const std::filesystem::path journal = journalOf(scene::loadScene(file).encode());
    EXPECT_EQ(test::refusalOf([&] {
                  master::requireMemoryOfJournal({roomy_, wall_}, master::openJournal(journal));
              }),
              "nothing");
    const std::vector<lockstep::RankHost> small{{"a", 1000}};
    const std::string refused = test::refusalOf([&] {
        master::requireMemoryOfJournal({small, wall_}, master::openJournal(journal));
    });
    EXPECT_TRUE(refused.starts_with(journal.string() + ": a TIN's ")) << refused;
}

TEST_F(JournalMemory, OfAMissingJournalIsRefused) {
    EXPECT_EQ(test::refusalOf([&] {
                  master::requireMemoryOfJournal({roomy_, wall_}, master::openJournal(journal_));
              }),
              journal_.string() + ": cannot be read (No such file or directory); check the path");
}

}  // namespace
