// SPDX-License-Identifier: Apache-2.0
#include "master/operator/background_jobs.hpp"

#include <gtest/gtest.h>

#include <future>
#include <stdexcept>

#include "base/input_error.hpp"

namespace {

using master::BackgroundJobs;

TEST(BackgroundJobs, AnswerWhenTheyHaveEndedAndNotBefore) {
    BackgroundJobs jobs;
    std::promise<void> gate;
    jobs.start(
        [&] {
            gate.get_future().wait();
            return BackgroundJobs::Result{"slow", {}};
        },
        {{.client = 1}});
    jobs.start([] { return BackgroundJobs::Result{"quick", sand::Edit::undo}; }, {{.client = 2}, {}});
    std::vector<BackgroundJobs::Done> done;
    while (done.empty()) {  // limited by the time-out of the test
        done = jobs.finished(false);
    }
    ASSERT_EQ(done.size(), 1U);
    EXPECT_EQ(done[0].result.json, "quick");
    EXPECT_EQ(done[0].result.edit.kind, sand::Edit::undo);
    EXPECT_EQ(done[0].askers, (master::Askers{{.client = 2}, {}}));
    EXPECT_TRUE(jobs.finished(false).empty());
    gate.set_value();
    done = jobs.finished(true);
    ASSERT_EQ(done.size(), 1U);
    EXPECT_EQ(done[0].result.json, "slow");
}

TEST(BackgroundJobs, TellWhyOneFailed) {
    BackgroundJobs jobs;
    jobs.start([]() -> BackgroundJobs::Result { throw std::runtime_error("disk full"); }, {{.client = 1}});
    const std::vector<BackgroundJobs::Done> done = jobs.finished(true);
    ASSERT_EQ(done.size(), 1U);
    EXPECT_EQ(done[0].error, "disk full");
}

TEST(BackgroundJobs, AreFourAtOnceAndKnowACapture) {
    BackgroundJobs jobs;
    EXPECT_FALSE(jobs.capturing());
    jobs.start([] { return BackgroundJobs::Result{}; }, {}, BackgroundJobs::Kind::capture);
    EXPECT_TRUE(jobs.capturing()) << "until its end was asked for";
    for (int i = 0; i < 3; ++i) {
        EXPECT_NO_THROW(jobs.requireRoom());
        jobs.start([] { return BackgroundJobs::Result{}; }, {});
    }
    EXPECT_THROW(jobs.requireRoom(), base::InputError);
    EXPECT_EQ(jobs.finished(true).size(), 4U);
    EXPECT_NO_THROW(jobs.requireRoom());
    EXPECT_FALSE(jobs.capturing());
}

}  // namespace
