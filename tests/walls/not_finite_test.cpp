// SPDX-License-Identifier: Apache-2.0
// nan and inf in place of every number of a wall file.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/support/files/not_finite_toml.hpp"
#include "tests/walls/sample_walls.hpp"

namespace walls {
namespace {

std::string complaintAboutFile(const std::string& text) {
    try {
        (void)parseWall(text, "f.toml");
    } catch (const base::InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(NotFiniteWall, IsRefusedWithTheLineOfEachNumberAndOfEachKeyThatATableKnows) {
    std::set<std::string> tried;
    for (const std::string& name : configNames()) {
        SCOPED_TRACE(name);
        std::ifstream file(configFolder() / name);
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        EXPECT_GE(support::tryEachNumber(text, complaintAboutFile), 10);
        tried.merge(support::tryEachOtherKey(text, complaintAboutFile));
    }
    for (const char* key : {"[stage] turn_deg"}) {
        EXPECT_TRUE(tried.contains(key)) << key;
    }
}

}  // namespace
}  // namespace walls
