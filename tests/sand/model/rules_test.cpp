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

// As docs/protocol.md describes a tuning: three numbers, and the tool. 2000 is 0x7d0, and -2001 is 0xfffff82f.
TEST(Rules, ATuningHasTheBytesOfTheProtocol) {
    const Bytes ball{7, 0, 0, 0, 11, 0, 0, 0, 13, 0, 0, 0, 0xd0, 7, 0, 0};
    EXPECT_EQ(base::encoded(sand::Tuning{7, 11, 13, {.radius = 2000}}), ball);
    const Bytes foot{7,    0,    0,    0,    11,   0,    0, 0, 13, 0, 0, 0,   0x2f,
                     0xf8, 0xff, 0xff, 0x85, 0xbc, 0x02, 0, 0, 0,  0, 0, 0x40};
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
            .ground = 9};
}

constexpr std::size_t kSchemeAt = 8 * 4;  // behind seven numbers and the radius of the tool

TEST(Rules, OnlyThoseOfATinEndWithItsDigest) {
    Rules rules = someRules();
    const Bytes grid = base::encoded(rules);
    EXPECT_EQ(grid, (Bytes{3, 0, 0, 0,  4, 0, 0, 0,    5, 0, 0, 0, 7, 0, 0, 0, 11, 0, 0, 0, 13,
                           0, 0, 0, 60, 0, 0, 0, 0xd0, 7, 0, 0, 2, 1, 9, 0, 0, 0,  0, 0, 0, 0}));
    EXPECT_EQ(base::decoded<Rules>(grid), rules);
    rules.tin = 0x1234;
    Bytes tin = base::encoded(rules);
    ASSERT_EQ(tin.size(), grid.size() + 8);
    EXPECT_EQ(tin[kSchemeAt], 0x82);
    EXPECT_EQ(base::decoded<Rules>(tin), rules);
    tin[grid.size()] = tin[grid.size() + 1] = 0;
    EXPECT_EQ(refusalOf(tin), "tin: is 0, not from 1 to 18446744073709551615");
}

TEST(Rules, ARefusalNamesTheNumber) {
    Rules steep = someRules();
    steep.tuning.startThreshold = 6;
    EXPECT_EQ(refusalOf(base::encoded(steep)), "start_threshold: is 6, not from 7 to 1073741824");
    Bytes unknown = base::encoded(someRules());
    unknown[kSchemeAt] = 1;
    EXPECT_EQ(refusalOf(unknown), "scheme: is 1, which is unknown");
    unknown[kSchemeAt] = 0;
    unknown[kSchemeAt + 1] = 2;
    EXPECT_EQ(refusalOf(unknown), "rim: is 2, which is unknown");
    Rules wide = someRules();
    wide.tuning.tool = {ToolKind::ellipse, 17, 18};
    EXPECT_EQ(refusalOf(base::encoded(wide)), "tool: is larger or wider than a tool can be");
}

TEST(Rules, ATunedToolKeepsTheHeadingOfTheHandUnlessTheOperatorTurnsIt) {
    const Heading byHand{-Heading::kLength, 0};
    Tool smaller = kLeftFoot;
    smaller.radius /= 2;
    EXPECT_EQ(headingAfter(kLeftFoot, smaller, byHand), byHand);
    const Tool turned = smaller.turnedTo({Heading::kLength, 0});
    EXPECT_EQ(headingAfter(kLeftFoot, turned, byHand), turned.heading);
}

}  // namespace
