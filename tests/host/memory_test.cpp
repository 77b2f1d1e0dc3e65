// SPDX-License-Identifier: Apache-2.0
#include "host/memory.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <fstream>

namespace {

TEST(Memory, ThisMachineHasSome) {
    EXPECT_GT(host::freeMemory(), 1 << 20);
    EXPECT_LT(host::freeMemory(), std::int64_t{1} << 50);
}

/// Returns the memory that this process has mapped [byte].
std::int64_t mapped() {
    std::ifstream stream("/proc/self/statm");
    std::int64_t pages = 0;
    stream >> pages;
    return pages * 4096;
}

// The limit is a little above the mapped memory. So only this little is free, however much memory the machine has.
TEST(Memory, AProcessWithALimitHasWhatTheLimitLeaves) {
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
    const std::int64_t room = 32 << 20;
    rlimit limit = before;
    limit.rlim_cur = static_cast<rlim_t>(mapped() + room);
    ASSERT_EQ(setrlimit(RLIMIT_AS, &limit), 0);
    const std::int64_t left = host::freeMemoryOfProcess();
    ASSERT_EQ(setrlimit(RLIMIT_AS, &before), 0);
    EXPECT_LE(left, room);
    EXPECT_GT(left, room / 2) << "only a stream and its buffer may have been mapped meanwhile";
    if (before.rlim_cur == RLIM_INFINITY) {
        EXPECT_GT(host::freeMemoryOfProcess(), room) << "without a limit the machine's memory counts";
    }
}

}  // namespace
