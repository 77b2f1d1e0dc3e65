// SPDX-License-Identifier: Apache-2.0
#include "base/zeroed_memory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "tests/support/machine/resident.hpp"

namespace {

using base::ZeroedMemory;

constexpr std::size_t kLarge = std::size_t{96} << 20U;  // [byte], more than the C library takes from its heap

bool isZero(const ZeroedMemory& memory, std::size_t first, std::size_t end) {
    return std::all_of(memory.data() + first, memory.data() + end, [](std::byte one) { return one == std::byte{0}; });
}

TEST(ZeroedMemory, IsZeroAtFirstAndCopiesWhatIsWritten) {
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{4096}, std::size_t{100'003}}) {
        ZeroedMemory memory(size);
        ASSERT_EQ(memory.size(), size);
        EXPECT_TRUE(isZero(memory, 0, size));
        for (std::size_t at = 0; at < size; at += 5000) {
            memory.data()[size - 1 - at] = std::byte{7};
        }
        ZeroedMemory copy(memory);
        EXPECT_TRUE(std::equal(memory.data(), memory.data() + size, copy.data()));
        ZeroedMemory same(size), other(3);
        std::fill(same.data(), same.data() + size, std::byte{9});
        same = memory;
        other = memory;
        EXPECT_TRUE(std::equal(memory.data(), memory.data() + size, same.data()));
        ASSERT_EQ(other.size(), size);
        EXPECT_TRUE(std::equal(memory.data(), memory.data() + size, other.data()));
        ZeroedMemory moved(std::move(other));
        EXPECT_TRUE(std::equal(memory.data(), memory.data() + size, moved.data()));
        moved = std::move(copy);
        EXPECT_EQ(moved.size(), size);
    }
}

TEST(ZeroedMemory, StaysZeroWhereItIsReleasedAndKeepsTheRest) {
    ZeroedMemory memory(kLarge);
    std::fill(memory.data(), memory.data() + 10, std::byte{1});
    std::fill(memory.data() + kLarge - 10, memory.data() + kLarge, std::byte{2});
    for (const auto& [first, end] : {std::pair<std::size_t, std::size_t>{10, kLarge - 10}, {11, 12}, {500, 500}}) {
        memory.release(first, end);
        EXPECT_TRUE(isZero(memory, 10, kLarge - 10));
        EXPECT_EQ(memory.data()[9], std::byte{1});
        EXPECT_EQ(memory.data()[kLarge - 10], std::byte{2});
    }
}

#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(ZeroedMemory, TakesMemoryOnlyForWhatIsWritten) {
    constexpr auto kAll = static_cast<std::int64_t>(kLarge);
    const std::int64_t before = test::residentBytes();
    ZeroedMemory memory(kLarge);
    EXPECT_TRUE(isZero(memory, 0, kLarge));
    const ZeroedMemory copy(memory);
    EXPECT_LE(test::residentBytes() - before, kAll / 10);
    std::fill(memory.data(), memory.data() + kLarge, std::byte{1});
    EXPECT_GE(test::residentBytes() - before, kAll / 10 * 9);
    std::fill(memory.data(), memory.data() + kLarge, std::byte{0});
    memory.release(0, kLarge);
    EXPECT_LE(test::residentBytes() - before, kAll / 10);
}
#endif

}  // namespace
