// SPDX-License-Identifier: Apache-2.0
#include "base/text_reader.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "base/input_error.hpp"
#include "tests/support/refusal.hpp"

namespace {

std::string fromHex(const std::string& digits) {
    std::string bytes;
    for (std::size_t i = 0; i < digits.size(); i += 2) {
        bytes.push_back(static_cast<char>(std::stoi(digits.substr(i, 2), nullptr, 16)));
    }
    return bytes;
}

std::vector<std::string> linesOf(base::TextReader& reader) {
    std::vector<std::string> lines;
    for (std::string_view line; reader.nextLine(line);) {
        lines.emplace_back(line);
        EXPECT_EQ(reader.line(), static_cast<long>(lines.size()));
    }
    return lines;
}

/// Returns the lines of a text. `most` bytes come at a time, so that a character can be cut anywhere.
std::vector<std::string> linesOfPieces(const std::string& bytes, std::size_t most) {
    base::TextDecoder decoder("t");
    std::string text;
    for (std::size_t at = 0; at < bytes.size(); at += most) {
        decoder.add(std::string_view(bytes).substr(at, most), text);
    }
    decoder.finish(text);
    base::TextReader reader(text, "t");
    return linesOf(reader);
}

/// The table that tests/scripts/launcher/base/text_file_test.py reads, too.
TEST(TextReader, ReadsEveryEncodingOfTheTableHoweverItIsCut) {
    std::ifstream file(SANDWALL_SOURCE_DIR "/tests/base/text_cases.json");
    const nlohmann::json cases = nlohmann::json::parse(file);
    ASSERT_GT(cases.size(), 30U);
    for (const nlohmann::json& given : cases) {
        const std::string name = given.at("name");
        const std::string bytes = fromHex(given.at("bytes"));
        for (const std::size_t piece : {std::size_t{1}, std::size_t{2}, std::size_t{3}, std::size_t{1000}}) {
            std::vector<std::string> lines;
            const std::string refused = test::refusalOf([&] { lines = linesOfPieces(bytes, piece); });
            if (given.contains("lines")) {
                EXPECT_EQ(refused, "nothing") << name;
                EXPECT_EQ(lines, given.at("lines").get<std::vector<std::string>>()) << name << ", pieces of " << piece;
            } else {
                const std::string expected =
                    "t:" + std::to_string(given.at("line").get<int>()) + ": " + given.at("error").get<std::string>();
                EXPECT_TRUE(refused.starts_with(expected)) << name << ": " << refused;
            }
        }
    }
}

TEST(TextReader, TakesWordsAndKnowsTheirLines) {
    std::istringstream stream("one\ttwo\r\n\r\n  three \rfour");
    base::TextReader reader(stream, "t");
    EXPECT_EQ(reader.nextWord(), "one");
    EXPECT_EQ(reader.peekWord(), "two");
    EXPECT_EQ(reader.nextWord(), "two");
    EXPECT_EQ(reader.line(), 1);
    EXPECT_EQ(reader.peekWord(), "three");
    EXPECT_EQ(reader.line(), 1) << "peekWord() changes nothing";
    EXPECT_EQ(reader.nextWord(), "three");
    EXPECT_EQ(reader.line(), 3);
    EXPECT_EQ(reader.nextWord(), "four");
    EXPECT_EQ(reader.line(), 4);
    EXPECT_EQ(reader.nextWord(), "");
    EXPECT_EQ(test::refusalOf([&] { reader.fail("what"); }), "t:4: what");
}

TEST(TextReader, ReadsWordsAndLinesAcrossPieces) {
    std::string text;
    for (int i = 0; i < 50000; ++i) {
        text += std::to_string(i) + (i % 10 == 9 ? "\n" : " ");
    }
    std::istringstream words(text), lines(text);
    base::TextReader byWord(words, "t"), byLine(lines, "t");
    for (int i = 0; i < 50000; ++i) {
        ASSERT_EQ(byWord.nextWord(), std::to_string(i));
        ASSERT_EQ(byWord.line(), 1 + i / 10);
    }
    const std::vector<std::string> read = linesOf(byLine);
    ASSERT_EQ(read.size(), 5000U);
    EXPECT_EQ(read.back(), "49990 49991 49992 49993 49994 49995 49996 49997 49998 49999");
}

TEST(TextReader, FindsTheSeparatorInTheFirstLine) {
    EXPECT_EQ(base::separatorOf("time,x,y,z"), ',');
    EXPECT_EQ(base::separatorOf("time;x;y;z"), ';');
    EXPECT_EQ(base::separatorOf("time\tx\ty"), '\t');
    EXPECT_EQ(base::separatorOf("1,5;2,5"), ';');
    EXPECT_EQ(base::separatorOf("time"), ',');
    EXPECT_EQ(base::unquoted("\"x\""), "x");
    EXPECT_EQ(base::unquoted("\""), "\"");
    EXPECT_EQ(base::unquoted("x"), "x");
}

}  // namespace
