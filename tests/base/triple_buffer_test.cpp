// SPDX-License-Identifier: Apache-2.0
#include "base/triple_buffer.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace {

TEST(TripleBuffer, HandsOverWholeValuesAndTheNewest) {
    struct Pair {
        std::uint64_t a = 0, b = 0;
    };
    base::TripleBuffer<Pair> latest;
    constexpr std::uint64_t kLast = 200'000;
    std::thread writer([&] {
        for (std::uint64_t i = 1; i <= kLast; ++i) {
            latest.next() = {i, ~i};
            latest.publish();
        }
    });
    std::uint64_t seen = 0;
    int torn = 0, backwards = 0;
    while (seen < kLast) {
        const Pair& pair = latest.latest();
        torn += pair.a != 0 && pair.b != ~pair.a ? 1 : 0;
        backwards += pair.a < seen ? 1 : 0;
        seen = pair.a;
    }
    writer.join();
    EXPECT_EQ(torn, 0);
    EXPECT_EQ(backwards, 0);
}

}  // namespace
