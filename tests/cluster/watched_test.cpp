// SPDX-License-Identifier: Apache-2.0
// A rank that hangs before the first frame or after the last one is named, and the job ends.
#include <fmt/format.h>

#include "tests/cluster/session_fixture.hpp"

namespace {

class Watched : public SessionTest {
protected:
    static constexpr int kShortStart = 20;  // [s]
    // [s] for a limit of 18 s: a watchdog that gets little of a busy machine counts only the time in which it runs.
    static constexpr double kLongest = 300;

    /// Runs five frames on two tiles. `rank` hangs in `function` (tests/support/machine/hang_at.cpp). The start may
    /// take `startSeconds`: on a busy machine the ranks that do not hang need many seconds.
    Ended hang(int rank, const std::string& function, int startSeconds = 120, bool stopped = false) {
        environment_ = {"LD_PRELOAD=" + support::linkTo("hang-at.so", folder_),
                        "SANDWALL_HANG_RANK=" + std::to_string(rank), "SANDWALL_HANG_AT=" + function,
                        fmt::format("SANDWALL_START_TIMEOUT={}", startSeconds), "SANDWALL_EVENTS=1"};
        if (stopped) {
            environment_.emplace_back("SANDWALL_HANG_STOPPED=1");
        }
        return runToEnd(
            {"--wall", wall(1, 2, "mono"), "--scene", scene(), "--frames", "5", "--out", out(), "--frame-timeout", "5"},
            stopped ? kLongest : kLong);
    }
    void expectNamed(const std::string& function, int startSeconds = 120) {
        const Ended ended = hang(2, function, startSeconds);
        EXPECT_EQ(ended.status, 1) << ended.output;
        ASSERT_TRUE(std::filesystem::exists(folder_ / "out/failure.json")) << ended.output;
        const nlohmann::json failure = json("out/failure.json");
        EXPECT_TRUE(support::holds(failure, {{"what", "hung"}, {"rank", 2}, {"tile", "r1c2"}, {"host", host()}}))
            << failure;
        EXPECT_TRUE(ended.has("waiting", {{"by", 0}, {"ranks", {2}}, {"ends_job", true}})) << ended.output;
    }
};

TEST_F(Watched, ADriverThatHangsAtTheStart) { expectNamed("OSMesaCreateContextAttribs", kShortStart); }

TEST_F(Watched, ADriverThatHangsWhileAPictureIsRead) { expectNamed("glReadPixels"); }

TEST_F(Watched, ADriverThatHangsWhenItIsClosed) { expectNamed("OSMesaDestroyContext"); }

TEST_F(Watched, ARankThatHangsInMpiFinalize) { expectNamed("MPI_Finalize"); }

// No rank has MPI yet, so none can know which one is missing.
TEST_F(Watched, ARankThatHangsInMpiInitEndsTheJob) {
    const Ended ended = hang(2, "MPI_Init_thread", kShortStart);
    EXPECT_EQ(ended.status, 1) << ended.output;
    EXPECT_TRUE(ended.has("waiting", {{"ends_job", true}})) << ended.output;
}

// The first render rank has a watchdog of its own, and ends the job in the master's place.
TEST_F(Watched, AMasterThatHangsInMpiFinalize) {
    const Ended ended = hang(0, "MPI_Finalize");
    EXPECT_EQ(ended.status, 1) << ended.output;
    EXPECT_TRUE(ended.has("waiting", {{"by", 1}, {"ranks", {0}}, {"ends_job", true}}) ||
                ended.has("waiting", {{"by", 0}, {"ends_job", true}}))
        << ended.output;
}

// The watchdog of the master is stopped too. The first render rank names the master. On a busy machine another render
// rank, which prints nothing, may be the first to end the job.
TEST_F(Watched, AMasterThatIsStoppedInMpiFinalize) {
    const Ended ended = hang(0, "MPI_Finalize", 120, true);
    EXPECT_EQ(ended.status, 1) << ended.output;
    EXPECT_TRUE(ended.has("waiting", {{"by", 1}, {"ranks", {0}}})) << ended.output;
}

}  // namespace
