// SPDX-License-Identifier: Apache-2.0
// The memory that a replay needs is checked before the sand is made.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "replay/checks.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/master/journal/huge_journal.hpp"
#include "tests/support/refusal.hpp"

namespace {

using test::kGibibyte;
using ReplayMemory = test::HugeJournal;

// A replica takes 16 bytes per cell, the scene alone 4.
TEST_F(ReplayMemory, IsRefusedBeforeItsHeightsAreMade) {
    const std::filesystem::path journal = journalOf(rulesOfAHugeField());
    const auto refusalOn = [&](std::int64_t free, replay::DecodedFor use) {
        return test::refusalOf([&] { replay::requireMemory(journal, use, free); });
    };
    EXPECT_EQ(refusalOn(4 * kGibibyte, replay::DecodedFor::replica), "nothing");
    EXPECT_EQ(refusalOn(2 * kGibibyte, replay::DecodedFor::replica),
              journal.string() +
                  ": 16384 x 16384 cells need at least 4.0 GiB, and 2.0 GiB are free: fewer cells, or a machine with "
                  "more memory");
    EXPECT_EQ(refusalOn(kGibibyte, replay::DecodedFor::scene), "nothing");
    EXPECT_EQ(refusalOn(kGibibyte / 2, replay::DecodedFor::scene),
              journal.string() +
                  ": 16384 x 16384 heights need at least 1.0 GiB, and 0.5 GiB are free: take a machine with more "
                  "memory");
}

TEST_F(ReplayMemory, OfATinIsRefused) {
    const std::filesystem::path file = folder_ / "s.toml";
    std::ofstream(file) << "[field]\ncolumns = 64\n[terrain]\n[material]\n[tool]\nradius = 0.1\n[tin]\n";
    const std::filesystem::path journal = journalOf(scene::loadScene(file).encode());
    const std::string refused =
        test::refusalOf([&] { replay::requireMemory(journal, replay::DecodedFor::replica, 1000); });
    EXPECT_TRUE(refused.starts_with(journal.string() + ": a TIN's ")) << refused;
}

}  // namespace
