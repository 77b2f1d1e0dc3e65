// SPDX-License-Identifier: Apache-2.0
// The memory that a journal's sand needs is checked before the sand is made.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "master/journal/format.hpp"
#include "master/journal/tools.hpp"
#include "master/start_up.hpp"
#include "scene/load/scene_file.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/folder_test.hpp"
#include "tests/support/refusal.hpp"

namespace {

constexpr std::int64_t kGibibyte = std::int64_t{1} << 30;

class JournalMemory : public test::FolderTest {
protected:
    /// Writes a journal that has only a header. `scene` becomes the scene in it.
    std::filesystem::path journalOf(const base::Bytes& scene) {
        master::JournalHeader header;
        header.session = 1;
        header.scene = scene;
        header.material = scene::Material();
        std::uint64_t chain = 0;
        const base::Bytes bytes = master::encodeHeader(header, chain);
        std::ofstream(journal_, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        return journal_;
    }

    /// Returns the first bytes of a scene of 16384 x 16384 cells.
    static base::Bytes rulesOfAHugeField() {
        sand::Rules rules;
        rules.columns = rules.rows = 16384;
        rules.stepsPerSecond = 60;
        base::ByteWriter writer;
        writer.putText("huge");
        base::putMember(writer, rules);
        return writer.take();
    }

    const std::filesystem::path journal_ = folder_ / "session.journal";
};

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

// A replica takes 16 bytes per cell, the scene alone 4.
TEST_F(JournalMemory, OfAReplayIsRefusedBeforeItsHeightsAreMade) {
    const std::filesystem::path journal = journalOf(rulesOfAHugeField());
    const auto refusalOn = [&](std::int64_t free, master::DecodedFor use) {
        return test::refusalOf([&] { master::requireMemory(journal, use, free); });
    };
    EXPECT_EQ(refusalOn(4 * kGibibyte, master::DecodedFor::replica), "nothing");
    EXPECT_EQ(refusalOn(2 * kGibibyte, master::DecodedFor::replica),
              journal.string() +
                  ": 16384 x 16384 cells need at least 4.0 GiB, and 2.0 GiB are free: fewer cells, or a machine with "
                  "more memory");
    EXPECT_EQ(refusalOn(kGibibyte, master::DecodedFor::scene), "nothing");
    EXPECT_EQ(refusalOn(kGibibyte / 2, master::DecodedFor::scene),
              journal.string() +
                  ": 16384 x 16384 heights need at least 1.0 GiB, and 0.5 GiB are free: take a machine with more "
                  "memory");
}

TEST_F(JournalMemory, OfATinIsRefused) {
    const std::filesystem::path file = folder_ / "s.toml";
    std::ofstream(file) << "[field]\ncolumns = 64\n[terrain]\n[material]\n[tool]\nradius = 0.1\n[tin]\n";
    const std::filesystem::path journal = journalOf(scene::loadScene(file).encode());
    EXPECT_EQ(test::refusalOf([&] { master::requireMemoryOfJournal({{"a", kGibibyte}}, journal); }), "nothing");
    const std::string refused = test::refusalOf([&] { master::requireMemoryOfJournal({{"a", 1000}}, journal); });
    EXPECT_TRUE(refused.starts_with(journal.string() + ": a TIN's ")) << refused;
    const std::string replayed =
        test::refusalOf([&] { master::requireMemory(journal, master::DecodedFor::replica, 1000); });
    EXPECT_TRUE(replayed.starts_with(journal.string() + ": a TIN's ")) << replayed;
}

TEST_F(JournalMemory, OfAMissingJournalIsRefused) {
    EXPECT_EQ(test::refusalOf([&] {
                  master::requireMemoryOfJournal({{"a", kGibibyte}}, journal_);
              }),
              journal_.string() + ": cannot be read; check the path");
}

}  // namespace
