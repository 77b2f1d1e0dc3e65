// SPDX-License-Identifier: Apache-2.0
#include "base/crc32.hpp"

#include <gtest/gtest.h>

namespace {

// The check value of the catalogue of CRCs: that of the digits 1 to 9.
TEST(Crc32, HasTheCheckValueOfItsDefinition) {
    EXPECT_EQ(base::crc32("123456789"), 0xcbf43926U);
    EXPECT_EQ(base::crc32(""), 0U);
}

TEST(Crc32, OfTwoPartsIsThatOfTheWhole) {
    EXPECT_EQ(base::crc32("6789", base::crc32("12345")), base::crc32("123456789"));
}

}  // namespace
