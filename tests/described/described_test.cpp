// SPDX-License-Identifier: Apache-2.0
// Feeds every described type with changed and random bytes (base/fields.hpp).
#include <gtest/gtest.h>

#include <array>
#include <random>
#include <tuple>

#include "sand/model/step.hpp"
#include "tests/described/faults.hpp"
#include "tests/described/rank_types.hpp"
#include "tests/described/samples.hpp"
#include "tests/described/types.hpp"
#include "tests/support/machine/heap_count.hpp"
#include "tests/support/seed.hpp"

namespace {

using AllTypes = decltype(std::tuple_cat(std::declval<described::Types>(), std::declval<described::RankTypes>()));

// The worst list is one of steps, because a step of five bytes becomes a sand::Step. While the list grows, it asks for
// less than four times its last size.
constexpr std::size_t kMostPerByte = 4 * sizeof(sand::Step) / 5;
constexpr std::size_t kAround = 4096;  // [byte], for texts of errors

/// Decodes bytes as a T. A fault fails the test.
template <class T>
bool tryBytes(std::span<const std::uint8_t> bytes) {
    bool accepted = false;
    const std::size_t before = test::heapBytes();
    try {
        (void)base::decoded<T>(bytes);
    } catch (const base::FormatError&) {
    }
    const std::size_t asked = test::heapBytes() - before;
    EXPECT_LE(asked, kAround + kMostPerByte * bytes.size())
        << typeid(T).name() << " asks for " << asked << " bytes to decode " << bytes.size();
    EXPECT_EQ(described::faultOf<T>(bytes, accepted), "") << typeid(T).name();
    return accepted;
}

/// Returns a copy of `sample` with the low `count` bytes of `number` at a place.
base::Bytes withNumber(base::Bytes sample, std::size_t at, std::size_t count, std::uint64_t number) {
    for (std::size_t i = 0; i < count && at + i < sample.size(); ++i) {
        sample[at + i] = static_cast<std::uint8_t>(number >> (8 * i));
    }
    return sample;
}

/// Cuts a sample anywhere, and writes odd numbers of every size to every place.
template <class T>
void tryChanges(const base::Bytes& sample) {
    constexpr std::array<std::uint64_t, 6> kOdd{0, ~0ULL, 0x7fffffffffffffffULL, 0x8080808080808080ULL, 1ULL << 24U, 2};
    for (std::size_t at = 0; at < sample.size() && !testing::Test::HasFailure(); ++at) {
        (void)tryBytes<T>(std::span(sample).first(at));
        for (const std::uint64_t number : kOdd) {
            for (const std::size_t count : std::array<std::size_t, 4>{1, 2, 4, 8}) {
                (void)tryBytes<T>(withNumber(sample, at, count, number));
            }
        }
    }
    base::Bytes longer = sample;
    longer.push_back(0);
    (void)tryBytes<T>(longer);
}

/// Returns bytes of a random length. Half of them are small numbers.
base::Bytes randomBytes(std::mt19937& random) {
    base::Bytes bytes(random() % 100);
    for (std::uint8_t& byte : bytes) {
        byte = static_cast<std::uint8_t>(random() % 2 == 0 ? random() % 4 : random());
    }
    return bytes;
}

TEST(DescribedTypes, AreDecodedOrRefusedByNameInTheMemoryThatTheirBytesJustify) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    described::forEachType<AllTypes>([&]<class T>() {
        if (testing::Test::HasFailure()) {
            return;
        }
        int accepted = 0;
        for (const base::Bytes& sample : described::samplesOf<T>(random)) {
            accepted += tryBytes<T>(sample) ? 1 : 0;
            tryChanges<T>(sample);
        }
        EXPECT_GT(accepted, 0) << typeid(T).name() << " has no valid sample";
        for (int round = 0; round < 500; ++round) {
            (void)tryBytes<T>(randomBytes(random));
        }
    });
}

}  // namespace
