// SPDX-License-Identifier: Apache-2.0
// The small files in a session's folder. A pipe of such a name must not stop the frames of a session.
#include <gtest/gtest.h>

#include <fstream>

#include "base/input_error.hpp"
#include "master/disagreement.hpp"
#include "master/drills.hpp"
#include "master/failure_report.hpp"
#include "master/incidents.hpp"
#include "master/recovery.hpp"
#include "master/summary.hpp"
#include "tests/support/blocked_child.hpp"
#include "tests/support/folder_test.hpp"

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
        master::tellRecovery({}, folder_);
        master::tell({"a divergence"}, folder_ / "divergence.txt");
        EXPECT_FALSE(master::writeFailure({"hung", 1, "host", "tile", "message"}, folder_));
        EXPECT_THROW(master::writeSummary(master::Summary(), folder_ / "summary.json"), base::InputError);
        (void)master::beginDrills(drills_, 5, folder_);
    }));
}

}  // namespace
