// SPDX-License-Identifier: Apache-2.0
// A loss of power while the journal's last write is on its way. The file system may have stored any of the pages of
// this write, and may have stored the file's length without its pages. All earlier writes were synced.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <random>

#include "base/input_error.hpp"
#include "master/journal/file_parts.hpp"
#include "master/journal/journal.hpp"
#include "master/journal/keeper.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/journal/read_session.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

constexpr std::size_t kPage = 4096;  // [byte], piece that a disk cache stores or loses as a whole

/// A session of one process that loses its power.
class PowerLoss : public test::FolderTest {
protected:
    void begin(const master::JournalOptions& options, const master::ResumedSession* resumed = nullptr) {
        keeper_.emplace(folder_, options, scene_, resumed, "power", "test");
    }
    /// Shows a frame of one step. Writes `pieces` pieces of ticks and a material in the same write, before the step.
    void showFrame(int pieces = 0) {
        ASSERT_TRUE(keeper_->mayTake(1 << 16, {replica_.stepNumber(), replica_.stateHash()}));
        for (int i = 0; i < pieces; ++i) {
            base::Bytes piece(2500 + random_() % 2000);
            std::generate(piece.begin(), piece.end(), [this] { return static_cast<std::uint8_t>(random_()); });
            keeper_->keepTicks({piece});
        }
        const sand::Step step = samples::randomStep(replica_.stepNumber() + 1, scene_.rules, random_);
        before_ = std::filesystem::file_size(part());
        keeper_->keep({++frame_, replica_.stateHash(), {step}},
                      pieces > 0 ? std::vector{scene_.material} : std::vector<scene::Material>());
        replica_.apply(step);
        hashes_.push_back(replica_.stateHash());
    }
    [[nodiscard]] std::filesystem::path journal() const { return folder_ / "session.journal"; }
    [[nodiscard]] std::filesystem::path part() const { return master::partOf(journal(), keeper_->parts()); }
    static std::string bytesOf(const std::filesystem::path& file) {
        std::ifstream stream(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    static void write(const std::filesystem::path& file, const std::string& bytes) {
        std::ofstream(file, std::ios::binary) << bytes;
    }
    /// Resumes the session, and expects every step up to `shown` and the right sand. Then shows another frame.
    void expectResumed(std::uint64_t shown) {
        const auto resumed = test::readSession(journal());
        ASSERT_TRUE(resumed.has_value());
        ASSERT_GE(resumed->step, shown) << "steps that were shown are lost";
        ASSERT_LE(resumed->step, shown + 1);
        ASSERT_EQ(resumed->hash, hashes_[resumed->step]);
        const sand::Replica replica = replica_;
        const std::vector<std::uint64_t> hashes = hashes_;
        replica_.decodeState(resumed->sand->encodeState());
        hashes_.resize(resumed->step + 1);
        begin({.checkpointSeconds = 0}, &*resumed);
        showFrame();
        keeper_->finish({replica_.stepNumber(), replica_.stateHash()});
        keeper_.reset();
        const journal::Journal whole = master::readJournal(journal());
        EXPECT_EQ(whole.frames.size(), resumed->step + 1);
        ASSERT_TRUE(whole.end.has_value());
        EXPECT_EQ(whole.tornBytes, 0);
        replica_ = replica;
        hashes_ = hashes;
    }
    /// Loses every subset of the pages of the last write, and resumes from each.
    void loseEverySubset(std::int64_t partBytes) {
        begin({.checkpointSeconds = 0, .partBytes = partBytes});
        for (int frame = 0; frame < 12; ++frame) {
            showFrame(frame % 3);
        }
        const std::uint64_t shown = replica_.stepNumber();
        showFrame(5);
        const std::filesystem::path last = part();
        keeper_.reset();
        const std::string whole = bytesOf(last);
        const std::size_t synced = before_;
        const std::size_t first = synced / kPage, pages = (whole.size() - 1) / kPage - first + 1;
        ASSERT_GE(pages, 4U) << "the last write covers too few pages";
        for (std::size_t stored = 0; stored < std::size_t{1} << pages; ++stored) {
            std::string bytes = whole;
            std::size_t length = synced;
            for (std::size_t page = 0; page < pages; ++page) {
                const std::size_t from = std::max(synced, (first + page) * kPage);
                const std::size_t to = std::min(whole.size(), (first + page + 1) * kPage);
                if ((stored >> page & 1U) != 0) {
                    length = to;
                } else {
                    std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(from),
                              bytes.begin() + static_cast<std::ptrdiff_t>(to), '\0');
                }
            }
            SCOPED_TRACE(testing::Message() << "stored pages " << stored << " of " << pages);
            write(last, bytes);  // the length is stored
            expectResumed(shown);
            write(last, bytes.substr(0, length));  // the length is that of the last stored page
            expectResumed(shown);
        }
    }

    scene::Scene scene_ = samples::flatScene(40, 30);
    sand::Replica replica_{scene_};
    std::mt19937 random_{71};
    std::uint64_t frame_ = 0;
    std::uintmax_t before_ = 0;                                // [byte], length of the part before the last write
    std::vector<std::uint64_t> hashes_{replica_.stateHash()};  // after every step, from 0
    std::optional<master::JournalKeeper> keeper_;
};

TEST_F(PowerLoss, AnyPagesOfTheLastWriteAreNoDamage) { loseEverySubset(master::kPartBytes); }

TEST_F(PowerLoss, AnyPagesOfTheLastWriteOfALaterPartAreNoDamage) {
    loseEverySubset(12'000);
    EXPECT_TRUE(std::filesystem::exists(master::partOf(journal(), 2)));
}

// The disk loses a synced write with all of its bytes, and later a page of it. No later record continues from its
// checksum, so only the place in the later records shows that the lost bytes had been on disk.
TEST_F(PowerLoss, AnEarlierWriteThatIsLostIsDamage) {
    begin({.checkpointSeconds = 0});
    std::vector<std::uintmax_t> ends;
    for (int frame = 0; frame < 8; ++frame) {
        showFrame((frame + 1) % 2);  // the last write has one record
        ends.push_back(std::filesystem::file_size(journal()));
    }
    keeper_.reset();
    const std::string whole = bytesOf(journal());
    for (std::size_t i = 0; i + 2 < ends.size(); ++i) {
        std::string bytes = whole;
        std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(ends[i]),
                  bytes.begin() + static_cast<std::ptrdiff_t>(ends[i + 1]), '\0');
        write(journal(), bytes);
        EXPECT_THROW((void)master::readJournal(journal()), base::InputError) << "write " << i + 2;
    }
}

}  // namespace
