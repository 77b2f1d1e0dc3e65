// SPDX-License-Identifier: Apache-2.0
// The small files in a session's folder. A pipe of such a name must not stop the frames of a session.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "base/input_error.hpp"
#include "master/check/disagreement.hpp"
#include "master/drills/drills.hpp"
#include "master/measure/failure_report.hpp"
#include "master/measure/incidents.hpp"
#include "master/measure/recovery.hpp"
#include "master/measure/summary.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/processes/blocked_child.hpp"

namespace {

class SessionFiles : public test::FolderTest {
protected:
    void SetUp() override {
        for (const char* name :
             {"incidents.json", "recoveries.jsonl", "drills.done", "divergence.txt", "failure.json", "summary.json"}) {
            support::makePipe(folder_ / name);
        }
    }

    const std::vector<master::Drill> drills_{
        master::Drill{"die", {.kind = lockstep::Fault::Kind::die, .rank = 2, .frame = 5}}};
};

TEST_F(SessionFiles, APipeIsNotReadWhenASessionIsResumed) {
    EXPECT_TRUE(support::endsByItself([this] {
        EXPECT_EQ(master::IncidentFile(folder_, true).before(), master::Incidents{});
        EXPECT_TRUE(master::recoveriesOf(folder_).empty());
        EXPECT_EQ(master::withoutDone(drills_, folder_, true).size(), 1U);
    }));
}

TEST_F(SessionFiles, APipeIsNotWrittenToWhileFramesWait) {
    EXPECT_TRUE(support::endsByItself([this] {
        master::IncidentFile(folder_, false).keepLast({.divergences = 1});
        master::reportRecovery({}, folder_);
        master::report({"a divergence"}, folder_ / "divergence.txt");
        EXPECT_FALSE(master::writeFailure({"hung", 1, "host", "tile", "message"}, folder_));
        EXPECT_THROW(master::writeSummary(master::Summary(), folder_ / "summary.json"), base::InputError);
        (void)master::beginDrills(drills_, 5, folder_);
    }));
}

using Recoveries = test::FolderTest;

// Without the end of the torn line, both recoveries would be lost.
TEST_F(Recoveries, ALineThatACrashHasTornIsEndedBeforeTheNext) {
    const std::filesystem::path file = folder_ / "recoveries.jsonl";
    const auto lines = [&file] {
        std::vector<std::string> all;
        std::ifstream stream(file);
        for (std::string line; std::getline(stream, line);) {
            all.push_back(line);
        }
        return all;
    };
    for (const std::uint64_t step : {7U, 8U}) {
        master::reportRecovery({.failure = {.what = "rank 2 died", .rank = 2, .how = "SIGKILL"}, .step = step},
                               folder_);
    }
    const std::vector<std::string> whole = lines();
    ASSERT_EQ(whole.size(), 2U) << "a whole line needs no end";
    const std::string torn = whole[1].substr(0, whole[1].size() / 2);
    std::ofstream(file) << whole[0] << "\n" << torn;
    master::reportRecovery({.failure = {.what = "rank 3 died", .rank = 3, .how = "SIGKILL"}, .step = 9}, folder_);
    const std::vector<std::string> after = lines();
    ASSERT_EQ(after.size(), 3U);
    EXPECT_EQ(after[0], whole[0]);
    EXPECT_EQ(after[1], torn);
    EXPECT_EQ(master::recoveriesOf(folder_), (std::vector<std::string>{whole[0], after[2]}));
    EXPECT_NE(after[2].find(R"("step":9)"), std::string::npos) << after[2];
    EXPECT_EQ(master::RecoveryCount(folder_).count(), 2U);
}

// The steady clock of a machine counts from its start. `startedNs` is when the master started.
TEST_F(Recoveries, CountBySteadyClocksFromTheFailure) {
    constexpr std::int64_t kStarted = 5'000'000'000, kNow = 6'500'000'000;  // [ns]
    master::Failure failure;
    EXPECT_DOUBLE_EQ(failure.secondsAgo(kNow, kStarted, "here/1"), 1.5) << "without a failure, since the start";
    failure.noticed = 3;
    failure.machine = "here/1";
    failure.before = 0.25;
    EXPECT_DOUBLE_EQ(failure.secondsAgo(kNow, kStarted, "here/1"), 3.5);
    EXPECT_DOUBLE_EQ(failure.secondsAgo(kNow, kStarted, "there/1"), 1.75) << "another machine has another clock";
    EXPECT_DOUBLE_EQ(failure.secondsAgo(kNow, kStarted, "here/2"), 1.75) << "it has started again";
    failure.noticed = 1.8e9;  // Unix time, as of a supervisor of an earlier release
    EXPECT_DOUBLE_EQ(failure.secondsAgo(kNow, kStarted, "here/1"), 0);
}

TEST(FailureInAJournal, NamesTheRankAndHowItFailedAndNoHost) {
    const auto text = [](std::optional<int> rank, const std::string& how) {
        return master::withoutHosts({"rank 3 on node02 was killed (its output: node02:/tmp/x)", rank, how, 0});
    };
    EXPECT_EQ(text(3, "SIGKILL"), "rank 3: SIGKILL");
    EXPECT_EQ(text(0, "status 3"), "rank 0: status 3");
    EXPECT_EQ(text(1, "SIGRTMIN+5"), "rank 1: SIGRTMIN+5");
    EXPECT_EQ(text({}, "signal 64"), "signal 64");
    for (const char* how : {"hung", "broken", "disk"}) {
        EXPECT_EQ(text({}, how), how);
    }
    EXPECT_EQ(text({}, ""), "the start");
    for (const char* other : {"node02", "status 3 on node02", "SIGKILL@node02", "hung on node02", "status\n3"}) {
        EXPECT_EQ(text(2, other), "rank 2: failed") << other;
    }
}

TEST_F(Recoveries, ALineWithAValueThatNoSessionWritesIsNamedAndLeftOut) {
    master::reportRecovery({.failure = {.what = "rank 2 died", .rank = 2, .how = "SIGKILL"}, .step = 7, .frame = 8},
                           folder_);
    std::string good;
    std::getline(std::ifstream(folder_ / "recoveries.jsonl"), good);
    const auto with = [&good](const std::string& key, const std::string& value) {
        const std::size_t begin = good.find("\"" + key + "\":") + key.size() + 3;
        return std::string(good).replace(begin, good.find_first_of(",}", begin) - begin, value);
    };
    std::ofstream(folder_ / "recoveries.jsonl") << good << "\n"
                                                << with("seconds_to_next_frame", "-2.5") << "\n"
                                                << with("frame", "-1") << "\n"
                                                << good.substr(0, 30) << "\n"  // cut off by a crash
                                                << with("cut_bytes", "3e19") << "\n"
                                                << with("failed_how", "17") << "\n"
                                                << with("failed_rank", "null") << "\n";
    testing::internal::CaptureStderr();
    EXPECT_EQ(master::recoveriesOf(folder_), (std::vector<std::string>{good, with("failed_rank", "null")}));
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 4) << said;
    EXPECT_NE(said.find("recoveries.jsonl:2: seconds_to_next_frame must be a number from 0 to 1000000000000 or null, "
                        "got -2.5; "),
              std::string::npos)
        << said;
    EXPECT_NE(said.find("recoveries.jsonl:3: frame must be "), std::string::npos) << said;
    EXPECT_EQ(master::RecoveryCount(folder_).count(), 2U);
}

}  // namespace
