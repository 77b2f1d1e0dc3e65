// SPDX-License-Identifier: Apache-2.0
#include "master/operator/answers.hpp"

#include <gtest/gtest.h>

namespace {

using lockstep::Answer;
using master::Answers;
using Shown = std::vector<Answer>;

constexpr std::int64_t kNow = 5'000'000'000, kEnd = kNow + Answers::kLife;

TEST(Answers, AreShownForTwoSecondsInTheirWindow) {
    Answers answers;
    EXPECT_TRUE(answers.at(kNow).empty());
    answers.show(3, "undone", kNow);
    EXPECT_EQ(answers.at(kNow), (Shown{{3, "undone"}}));
    EXPECT_EQ(answers.at(kEnd - 1), (Shown{{3, "undone"}}));
    EXPECT_TRUE(answers.at(kEnd).empty());
    EXPECT_EQ(Answers::kLife, 2'000'000'000);
}

TEST(Answers, OfOneWindowReplaceEachOther) {
    Answers answers;
    answers.show(3, "undone", kNow);
    answers.show(1, "paused", kNow);
    answers.show(3, "reset", kNow + 1);
    EXPECT_EQ(answers.at(kNow + 1), (Shown{{1, "paused"}, {3, "reset"}}));
    EXPECT_EQ(answers.at(kEnd), (Shown{{3, "reset"}}));
    answers.show(3, "", kEnd);
    EXPECT_EQ(answers.at(kEnd), (Shown{{3, "reset"}})) << "no text is no answer";
}

TEST(Answers, ThatAreTooLongAreCutBetweenTwoCharacters) {
    Answers answers;
    answers.show(1, std::string(Answer::kLongest - 1, 'x') + "°", kNow);
    EXPECT_EQ(answers.at(kNow).at(0).text, std::string(Answer::kLongest - 1, 'x'));
    answers.show(1, std::string(Answer::kLongest, 'y'), kNow);
    EXPECT_EQ(answers.at(kNow).at(0).text.size(), Answer::kLongest);
    answers.show(1, std::string(Answer::kLongest + 1, '\x80'), kNow);
    EXPECT_EQ(answers.at(kNow).at(0).text, "") << "bytes that are only the middle of characters";
}

// Somebody may hold a key at each window of a large wall.
TEST(Answers, AreAsManyAsAMessageHolds) {
    Answers answers;
    for (int rank = 1; rank <= 1000; ++rank) {
        answers.show(rank, "paused", kNow);
    }
    EXPECT_EQ(answers.at(kNow).size(), lockstep::kMostAnswers);
}

}  // namespace
