// SPDX-License-Identifier: Apache-2.0
// The memory that a journal's sand needs on the ranks is checked before the sand is made.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "master/start_up.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/master/journal/huge_journal.hpp"
#include "tests/support/refusal.hpp"

namespace {

using test::kGibibyte;
using JournalMemory = test::HugeJournal;

// The scene in this journal ends after its rules, so that decoding its heights would fail.
TEST_F(JournalMemory, IsRefusedBeforeItsHeightsAreMade) {
    const std::filesystem::path journal = journalOf(rulesOfAHugeField());
    const auto refusalOn = [&](std::int64_t free) {
        return test::refusalOf([&] { master::requireMemoryOfJournal({{"a", free}, {"a", free}}, journal); });
    };
    EXPECT_EQ(refusalOn(8 * kGibibyte), "nothing");
    EXPECT_EQ(refusalOn(4 * kGibibyte),
              journal.string() +
                  ": 16384 x 16384 cells need at least 8.0 GiB for the 2 ranks on a, where 4.0 "
                  "GiB are free; use fewer cells, or more hosts");
}

TEST_F(JournalMemory, OfATinIsRefused) {
    const std::filesystem::path file = folder_ / "s.toml";
    std::ofstream(file) << "[field]\ncolumns = 64\n[terrain]\n[material]\n[tool]\nradius = 0.1\n[tin]\n";
    const std::filesystem::path journal = journalOf(scene::loadScene(file).encode());
    EXPECT_EQ(test::refusalOf([&] { master::requireMemoryOfJournal({{"a", kGibibyte}}, journal); }), "nothing");
    const std::string refused = test::refusalOf([&] { master::requireMemoryOfJournal({{"a", 1000}}, journal); });
    EXPECT_TRUE(refused.starts_with(journal.string() + ": a TIN's ")) << refused;
}

TEST_F(JournalMemory, OfAMissingJournalIsRefused) {
    EXPECT_EQ(test::refusalOf([&] {
                  master::requireMemoryOfJournal({{"a", kGibibyte}}, journal_);
              }),
              journal_.string() + ": cannot be read (No such file or directory); check the path");
}

}  // namespace
