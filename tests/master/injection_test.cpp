// SPDX-License-Identifier: Apache-2.0
#include "master/injection.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "files/input_error.hpp"

namespace {

TEST(Injection, OfSlowDrawingIsForTheRestOfTheSessionOrForSomeFrames) {
    lockstep::SessionMessage message;
    master::inject("slow:rank=5,ms=30", 12, message);
    master::inject("slow:frames=10,ms=7,rank=12,frame=100", 12, message);
    ASSERT_EQ(message.slow.size(), 2U);
    EXPECT_EQ(message.slow[0], (lockstep::SlowDrawing{5, 30, 1, std::numeric_limits<std::uint64_t>::max()}));
    EXPECT_EQ(message.slow[1], (lockstep::SlowDrawing{12, 7, 100, 10}));
}

TEST(Injection, ThatCannotBeIsNamedInOneLine) {
    for (const auto& [text, part] : {std::pair{"", "no such fault; write slow:rank=R,ms=MS"},
                                     {"slow", "no such fault"},
                                     {"die:rank=5", "no such fault"},
                                     {"slow:", "rank is missing"},
                                     {"slow:rank=5", "ms is missing"},
                                     {"slow:rank=13,ms=30", "rank must be 1 to 12, got '13'"},
                                     {"slow:rank=0,ms=30", "rank must be 1 to 12, got '0'"},
                                     {"slow:rank=-1,ms=30", "rank must be 1 to 12, got '-1'"},
                                     {"slow:rank=5,ms=1e9", "ms must be 1 to 10000, got '1e9'"},
                                     {"slow:rank=5,ms=99999999999999999999", "ms must be 1 to 10000"},
                                     {"slow:rank=5,ms=", "ms must be 1 to 10000, got ''"},
                                     {"slow:rank=5,ms=30,frame=0", "frame must be a whole number from 1"},
                                     {"slow:rank=5,ms=30,rank=6", "'rank=6' is not understood"},
                                     {"slow:rank=5,ms=30,tile=6", "'tile=6' is not understood"},
                                     {"slow:rank=5;ms=30", "rank must be 1 to 12, got '5;ms=30'"}}) {
        lockstep::SessionMessage message;
        try {
            master::inject(text, 12, message);
            ADD_FAILURE() << text << " was taken";
        } catch (const files::InputError& error) {
            const std::string said = error.what();
            EXPECT_NE(said.find(part), std::string::npos) << said;
            EXPECT_EQ(said.find("--inject " + std::string(text) + ": "), 0U) << said;
            EXPECT_EQ(said.find('\n'), std::string::npos) << said;
        }
        EXPECT_TRUE(message.slow.empty());
    }
}

}  // namespace
