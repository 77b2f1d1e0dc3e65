// SPDX-License-Identifier: Apache-2.0
// The barrier between ranks that MPI has started, and its verdict on each thing that a rank may do wrong.
#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <string>

#include "tests/support/processes/run_ranks.hpp"

namespace {

/// The lines that the master printed in one run of barrier_ranks, which serves all tests. The key is the text before
/// the first blank.
class Barrier : public testing::Test {
protected:
    static void SetUpTestSuite() {
        const support::Ran ran = support::runRanks(4, "barrier_ranks", "");
        ASSERT_EQ(ran.status, 0) << ran.output;
        std::istringstream lines(ran.output);
        for (std::string line; std::getline(lines, line);) {
            const std::size_t blank = line.find(' ');
            said()[line.substr(0, blank)] = line.substr(std::min(line.size(), blank + 1));
        }
    }
    static std::map<std::string, std::string>& said() {
        static std::map<std::string, std::string> lines;
        return lines;
    }
    static void expectFrame(int frame, const std::string& wanted, const std::string& arrivals = "101 102 103") {
        EXPECT_EQ(said()[std::to_string(frame) + ":"], wanted + "; arrivals " + arrivals) << "frame " << frame;
    }
};

TEST_F(Barrier, AgreesWhenAllSayTheSame) {
    expectFrame(1, "equal");
    expectFrame(8, "equal");
}

TEST_F(Barrier, SeesOtherSandOfAnyRankAndOfTheMaster) {
    expectFrame(2, "other sand");
    expectFrame(5, "other sand");
}

TEST_F(Barrier, SeesAnotherViewAndOtherSandFirst) {
    expectFrame(3, "other view");
    expectFrame(4, "other sand");
}

// If a rank sends an arrival twice, the second one arrives at the next frame.
TEST_F(Barrier, RefusesAnArrivalAtAnotherFrame) {
    expectFrame(6, "nonsense of rank 1 (frame 6: rank 1 sent an invalid arrival (of frame 5))", "0 102 103");
}

TEST_F(Barrier, KnowsWhoseArrivalEachIsWhateverTheirOrder) { expectFrame(7, "equal"); }

// The drill's noise in frames 30, 31 and 32 is as long as an arrival, longer, and longer than the buffer.
TEST_F(Barrier, RefusesEachKindOfGarbageOfTheDrillAndGoesOn) {
    const std::string& first = said()["30:"];
    EXPECT_TRUE(first.starts_with("nonsense of rank 2 (frame 30: rank 2 sent an invalid arrival (of frame ")) << first;
    EXPECT_TRUE(first.ends_with("; arrivals 101 0 103")) << first;
    expectFrame(31, "nonsense of rank 2 (frame 31: rank 2 sent an invalid arrival (200 bytes instead of 112))",
                "101 0 103");
    expectFrame(32, "nonsense of rank 2 (frame 32: rank 2 sent an invalid arrival (longer than 512 bytes))",
                "101 0 103");
    expectFrame(33, "equal");
}

TEST_F(Barrier, GivesEveryRankTheMessageHoweverLongItIs) {
    for (int frame = 9; frame <= 14; ++frame) {
        expectFrame(frame, "equal");
    }
}

TEST_F(Barrier, HandsBytesToWhomTheyAreFor) {
    EXPECT_EQ(said()["collected"], "1x0 1001x1 2001x2 3001x3; passed and told 0+7 5+7 0+7 5+7");
}

TEST_F(Barrier, GathersWhatRanksSayOfThemselves) {
    EXPECT_EQ(said()["ready"],
              "[host of rank 0, build, error of rank 0, renderer, a+b of rank 0, 7] "
              "[host of rank 1, build, error of rank 1, renderer, a+b of rank 1, 8] "
              "[host of rank 2, build, error of rank 2, renderer, a+b of rank 2, 9] "
              "[host of rank 3, build, error of rank 3, renderer, a+b of rank 3, 10]");
    EXPECT_EQ(said()["reports"],
              "[host 1, renderer, lock, 101 102 103 104 105 6 7 8 9 10 111] "
              "[host 2, renderer, lock, 201 202 203 204 205 6 7 8 9 10 211] "
              "[host 3, renderer, lock, 301 302 303 304 305 6 7 8 9 10 311]");
}

}  // namespace
