// SPDX-License-Identifier: Apache-2.0
#include "sand/model/rules.hpp"

#include <gtest/gtest.h>

#include <string>

namespace {

using base::Bytes;
using sand::Heading;
using sand::Rules;
using sand::Tool;
using sand::ToolKind;

const Tool kLeftFoot{ToolKind::footprint, 2000, 700, {0, Heading::kLength, true}};

std::string refusalOf(const Bytes& bytes) {
    try {
        (void)base::decoded<Rules>(bytes);
    } catch (const base::FormatError& error) {
        return error.what();
    }
    return {};
}

// As docs/protocol.md describes a tuning: three numbers, and the tool. 2000 is 0x7d0, and 700 is 0x2bc.
TEST(Rules, ATuningHasTheBytesOfTheProtocol) {
    const Bytes foot{7, 0, 0, 0, 11, 0, 0, 0, 13, 0, 0, 0, 5, 0xd0, 7, 0, 0, 0xbc, 2, 0, 0, 0, 0, 0, 0x40, 1};
    EXPECT_EQ(base::encoded(sand::Tuning{7, 11, 13, kLeftFoot}), foot);
    EXPECT_EQ(base::decoded<sand::Tuning>(foot).tool, kLeftFoot);
}

Rules someRules() {
    return {.columns = 3,
            .rows = 4,
            .aspect = 5,
            .tuning = {7, 11, 13, {.radius = 2000}},
            .stepsPerSecond = 60,
            .scheme = sand::Scheme::plainIsotropic,
            .rim = sand::Rim::open,
            .ground = 9,
            .tin = 0x1234};
}

TEST(Rules, ALoadMayHaveAsMuchSandAsTheFieldCanNeed) {
    const auto mostOf = [](std::int32_t side, std::uint64_t tin) {
        return Rules{.columns = side, .rows = side, .tin = tin}.stepLimits().mostSandBytes;
    };
    EXPECT_EQ(mostOf(512, 0), sand::kMaxSandBytes);
    EXPECT_EQ(mostOf(10'012, 0), 13LL * 10'014 * 10'014 + (1 << 20));
    EXPECT_EQ(mostOf(10'012, 7), sand::kMaxSandBytes) << "a TIN has few vertices";
    const Rules largest{.columns = sand::kMaxSide, .rows = sand::kMaxSide};
    EXPECT_EQ(largest.mostBytesOf(6), (std::int64_t{1} << 32) - (1 << 26)) << "a length has 32 bits";
    EXPECT_EQ(largest.stepLimits().mostSandBytes, largest.mostBytesOf(3));
}

constexpr std::size_t kSchemeAt = 7 * 4 + 14;  // behind seven numbers and the tool

TEST(Rules, ARefusalNamesTheNumber) {
    Rules steep = someRules();
    EXPECT_EQ(base::decoded<Rules>(base::encoded(steep)), steep);
    steep.tuning.startThreshold = 6;
    EXPECT_EQ(refusalOf(base::encoded(steep)), "tuning: start_threshold: is 6, not from 7 to 1073741824");
    Bytes unknown = base::encoded(someRules());
    unknown[kSchemeAt] = 1;
    EXPECT_EQ(refusalOf(unknown), "scheme: is 1, which is unknown");
    unknown[kSchemeAt] = 0;
    unknown[kSchemeAt + 1] = 2;
    EXPECT_EQ(refusalOf(unknown), "rim: is 2, which is unknown");
    Rules wide = someRules();
    wide.tuning.tool = {ToolKind::ellipse, 17, 18};
    EXPECT_EQ(refusalOf(base::encoded(wide)), "tuning: tool: half_width: is 18, not from 0 to 17");
    wide.tuning.tool = {ToolKind::circle, 17, 1};
    EXPECT_EQ(refusalOf(base::encoded(wide)), "tuning: tool: is round, but has a width of its own");
}

TEST(Rules, ATunedToolKeepsTheHeadingOfTheHandUnlessTheOperatorTurnsIt) {
    const Heading byHand{-Heading::kLength, 0};
    Tool smaller = kLeftFoot;
    smaller.radius /= 2;
    EXPECT_EQ(headingAfter(kLeftFoot, smaller, byHand), byHand);
    const Tool turned = smaller.turnedTo({Heading::kLength, 0});
    EXPECT_EQ(headingAfter(kLeftFoot, turned, byHand), turned.heading);
}

// A step that a frame cannot divide must end soon. Each sub-step visits the cells below the tool, which are a square.
TEST(Rules, APathHasSoManySubstepsThatItsCellsHaveALimit) {
    struct Row {
        std::int32_t radius, side;  // [cell]
        std::uint64_t tin;
        std::int64_t most;
    };
    constexpr std::int64_t kOfGrid = 1 << 27, kOfTin = 1 << 25;
    for (const Row& row : {Row{0, 4096, 0, 1 << 21}, Row{3, 4096, 0, 1 << 21}, Row{12, 4096, 0, kOfGrid / (26 * 26)},
                           Row{60, 4096, 0, kOfGrid / (122 * 122)}, Row{60, 100, 0, kOfGrid / (100 * 100)},
                           Row{2048, 4096, 0, kOfGrid / (4096 * 4096)}, Row{2048, 16384, 0, kOfGrid / (4098 * 4098)},
                           Row{12, 512, 1, 1 << 14}, Row{60, 512, 1, kOfTin / (122 * 122)}, Row{2048, 16384, 1, 1}}) {
        Rules rules = someRules();
        rules.columns = rules.rows = row.side;
        rules.tuning.tool = {.radius = row.radius * sand::kProbePerCell};
        rules.tin = row.tin;
        EXPECT_EQ(rules.mostSubsteps(), row.most) << row.radius << " cells on " << row.side << ", TIN " << row.tin;
    }
}

}  // namespace
