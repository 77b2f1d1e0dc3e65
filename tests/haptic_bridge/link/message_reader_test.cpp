// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/link/message_reader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <span>

#include "haptic_bridge/link/protocol.hpp"
#include "tests/haptic_bridge/link/sample_messages.hpp"
#include "tests/support/sand/sand_samples.hpp"
#include "tests/support/seed.hpp"

namespace {

using namespace haptic_bridge;

// A peer that is not linked, or was not asked for sand, cannot make this side hold more than an ordinary message.
TEST(Protocol, SandToBeLoadedPassesWhereItIsExpectedAndNothingElseAsLong) {
    sand::Step step = someStep();
    step.edit = samples::withNumber(3, sand::Edit::loaded(base::Bytes(100'000, 7)));
    const Message load = EditRequest{step.edit};
    MessageReader expecting;
    expecting.expectLoads(true);
    expecting.feed(encode(load));
    EXPECT_EQ(expecting.next(), load);
    for (const bool state : {false, true}) {
        MessageReader other;
        other.expectState(state);
        other.feed(encode(load));
        EXPECT_THROW((void)other.next(), base::FormatError);
    }
    for (const Message& other : {Message(Bye{std::string(100'000, 'x')}), Message(StepMessage{-5, 17, step})}) {
        MessageReader reader;
        reader.expectLoads(true);
        reader.feed(encode(other));
        EXPECT_THROW((void)reader.next(), base::FormatError);
    }
}

// A load has hundreds of MiB, and its step may wait for seconds.
TEST(Protocol, ALongMessageIsNotKeptAfterItWasRead) {
    const base::Bytes load = encode(EditRequest{samples::withNumber(3, sand::Edit::loaded(base::Bytes(8 << 20, 7)))});
    const base::Bytes next = encode(Ping{5});
    for (const std::size_t behind : {std::size_t{0}, std::size_t{3}, next.size()}) {
        MessageReader reader;
        reader.expectLoads(true);
        reader.feed(load);
        reader.feed(std::span(next).first(behind));
        ASSERT_TRUE(reader.next());
        EXPECT_LE(reader.bytes(), std::size_t{1} << 20) << behind << " bytes of the next message";
        reader.feed(std::span(next).subspan(behind));
        EXPECT_EQ(reader.next(), Message(Ping{5}));
    }
}

TEST(Protocol, SurvivesRandomMutations) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    const auto messages = oneOfEach();
    int refused = 0;
    for (int round = 0; round < 20'000; ++round) {
        base::Bytes framed = encode(messages[random() % messages.size()]);
        for (unsigned flips = 1 + random() % 4; flips > 0; --flips) {
            framed[random() % framed.size()] = static_cast<std::uint8_t>(random());
        }
        MessageReader reader;
        reader.expectState(random() % 2 == 0);
        reader.feed(framed);
        try {
            // Every accepted message must encode again.
            if (const auto message = reader.next()) {
                (void)encode(*message);
            }
        } catch (const base::FormatError&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 1000);
}

TEST(Protocol, ReadsAStreamCutAnywhere) {
    base::Bytes stream;
    for (const Message& message : oneOfEach()) {
        const base::Bytes framed = encode(message);
        stream.insert(stream.end(), framed.begin(), framed.end());
    }
    for (const std::size_t piece : {1UL, 2UL, 3UL, 7UL, 64UL, stream.size()}) {
        MessageReader reader;
        reader.expectState(true);
        std::vector<Message> read;
        for (std::size_t begin = 0; begin < stream.size(); begin += piece) {
            reader.feed(std::span(stream).subspan(begin, std::min(piece, stream.size() - begin)));
            while (auto message = reader.next()) {
                read.push_back(std::move(*message));
            }
        }
        EXPECT_EQ(read, oneOfEach()) << "pieces of " << piece;
        EXPECT_FALSE(reader.midMessage());
    }
}

TEST(Protocol, BoundsTheLengthBeforeTheBytesCome) {
    const auto lengthOnly = [](std::uint32_t length, std::uint8_t type, bool stateExpected) {
        base::ByteWriter writer;
        writer.put(length);
        writer.put(type);
        MessageReader reader;
        reader.expectState(stateExpected);
        reader.feed(writer.bytes());
        return reader.next();
    };
    constexpr std::uint8_t kStateType = 7, kByeType = 15;
    EXPECT_THROW((void)lengthOnly(0, kByeType, false), base::FormatError);
    EXPECT_THROW((void)lengthOnly(kMaxMessage + 1, kStateType, false), base::FormatError);
    EXPECT_THROW((void)lengthOnly(kMaxMessage + 1, kByeType, true), base::FormatError);
    EXPECT_THROW((void)lengthOnly(kMaxState + 1, kStateType, true), base::FormatError);
    EXPECT_FALSE(lengthOnly(kMaxState, kStateType, true));
    EXPECT_FALSE(lengthOnly(kMaxMessage, kByeType, false));
}

// A large field has longer messages with sand. One kind of them does not lift the bound of the other.
TEST(Protocol, BoundsTheSandOfALargeFieldByItsKind) {
    constexpr std::uint8_t kStateType = 7, kLoadType = 16, kByeType = 15;
    constexpr std::uint32_t kState = kMaxState + 500, kLoad = kMaxState + 5;
    const auto header = [](std::uint32_t length, std::uint8_t type, std::size_t bytes) {
        base::ByteWriter writer;
        writer.put(length);
        writer.put(type);
        MessageReader reader;
        reader.expectLoads(true, kLoad);
        reader.expectState(true, kState);
        reader.feed(std::span(writer.bytes()).first(bytes));
        return reader.next();
    };
    constexpr std::size_t kLengthOnly = kLengthBytes, kWithType = kLengthBytes + 1;
    EXPECT_FALSE(header(kState, kStateType, kWithType));
    EXPECT_FALSE(header(kState, kStateType, kLengthOnly));
    EXPECT_THROW((void)header(kState + 1, kStateType, kLengthOnly), base::FormatError);
    EXPECT_FALSE(header(kLoad, kLoadType, kWithType));
    EXPECT_THROW((void)header(kLoad + 1, kLoadType, kWithType), base::FormatError);
    EXPECT_THROW((void)header(kMaxMessage + 1, kByeType, kWithType), base::FormatError);
    MessageReader noLoads;
    noLoads.expectState(true, kState);
    noLoads.expectLoads(false, kLoad);  // another load waits for its step
    base::ByteWriter writer;
    writer.put(std::uint32_t{kMaxMessage + 1});
    writer.put(kLoadType);
    noLoads.feed(writer.bytes());
    EXPECT_THROW((void)noLoads.next(), base::FormatError);
}

TEST(Protocol, TakesAStateOnceAndOnlyWhenExpected) {
    MessageReader reader;
    const base::Bytes large = encode(State{base::Bytes(3 * kMaxMessage, 9)});
    reader.expectState(true);
    reader.feed(large);
    EXPECT_TRUE(reader.next());
    reader.feed(encode(State{{1}}));
    EXPECT_THROW((void)reader.next(), base::FormatError);
}

}  // namespace
