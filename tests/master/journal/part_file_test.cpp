// SPDX-License-Identifier: Apache-2.0
#include "master/journal/part_file.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include "base/byte_stream.hpp"
#include "base/input_error.hpp"
#include "tests/support/files/folder_test.hpp"

namespace {

using master::PartFile;
using namespace std::chrono_literals;

/// Two sessions that write the same file. The second one counts its waits instead of waiting.
class TwoWriters : public test::FolderTest {
protected:
    /// Returns the error of the second session; "nothing" if it may continue. The first session ends when the second
    /// one has waited for `until`.
    template <class Second>
    std::string report(const Second& second, std::chrono::milliseconds until) {
        try {
            second([this, until](std::chrono::milliseconds length) {
                waited_ += length;
                if (waited_ >= until) {
                    first_.reset();
                }
            });
        } catch (const std::runtime_error& error) {
            return error.what();
        }
        return "nothing";
    }
    std::string open(std::chrono::milliseconds until) {
        return report([this](const master::Pause& pause) { (void)PartFile::open(file_, 3, 3, pause); }, until);
    }
    std::string begin(std::chrono::milliseconds until) {
        return report([this](const master::Pause& pause) { PartFile::requireNoWriter(file_, pause); }, until);
    }

    static constexpr std::chrono::milliseconds kNever = 24h;
    const std::filesystem::path file_ = folder_ / "session.journal";
    std::optional<PartFile> first_ = PartFile::make(file_, base::Bytes{1, 2, 3});
    std::chrono::milliseconds waited_{0};
};

TEST_F(TwoWriters, TheSecondGoesOnWhenTheFirstEndsWithinFiveSeconds) {
    EXPECT_EQ(open(4900ms), "nothing");
    EXPECT_EQ(waited_, 4900ms);
}

TEST_F(TwoWriters, TheSecondIsRefusedAfterFiveSecondsAndHasTouchedNothing) {
    EXPECT_EQ(open(kNever), file_.string() + ": another session writes it; stop that session first");
    EXPECT_EQ(waited_, 5000ms);
    first_->write(base::Bytes{4});
    EXPECT_EQ(std::filesystem::file_size(file_), 4U);
}

TEST_F(TwoWriters, ASecondThatBeginsAnewWaitsAsLong) {
    EXPECT_EQ(begin(4900ms), "nothing");
    EXPECT_EQ(waited_, 4900ms);
    first_ = PartFile::open(file_, 3, 3);
    waited_ = 0ms;
    EXPECT_EQ(begin(kNever), file_.string() + ": another session writes it; stop that session first");
    EXPECT_EQ(waited_, 5000ms);
}

TEST_F(TwoWriters, ALinkIsNeitherContinuedNorReplaced) {
    first_.reset();
    const std::filesystem::path other = folder_ / "other";
    std::filesystem::rename(file_, other);
    std::filesystem::create_symlink(other, file_);
    EXPECT_EQ(open(kNever), file_.string() + ": the journal cannot be continued (Too many levels of symbolic links)");
    EXPECT_THROW((void)PartFile::make(file_, base::Bytes{4}), base::InputError);
    EXPECT_TRUE(std::filesystem::is_symlink(file_));
    EXPECT_EQ(std::filesystem::file_size(other), 3U);
}

TEST_F(TwoWriters, NobodyWaitsForAFileThatNobodyWrites) {
    first_.reset();
    EXPECT_EQ(open(kNever), "nothing");
    EXPECT_EQ(begin(kNever), "nothing");
    std::filesystem::remove(file_);
    EXPECT_EQ(begin(kNever), "nothing");
    EXPECT_EQ(waited_, 0ms);
}

}  // namespace
