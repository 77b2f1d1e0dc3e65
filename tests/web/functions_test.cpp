// SPDX-License-Identifier: Apache-2.0
// The functions of web/dig.cpp as the page calls them. tests/web/dig_test.mjs tests all of them in WebAssembly.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string_view>

extern "C" {
std::uint8_t* sw_add_part(std::uint32_t size);
int sw_dig_grid(const char* name, std::uint32_t high, std::uint32_t low);
int sw_set_material(const char* word, double value);
const char* sw_material();
}

namespace {

TEST(PageFunctions, TellTheMaterialThatThePageHasSet) {
    constexpr std::string_view kGrid = "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n4 5 6\n";
    std::copy(kGrid.begin(), kGrid.end(), sw_add_part(kGrid.size()));
    ASSERT_EQ(sw_dig_grid("t.asc", 0, 7), 0);
    ASSERT_EQ(sw_set_material("talus", 31), 0);
    EXPECT_NE(std::string_view(sw_material()).find(R"("talus":31,)"), std::string_view::npos) << sw_material();
}

}  // namespace
