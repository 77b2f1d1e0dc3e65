// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/link/protocol.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>

#include "haptic_bridge/link/handshake.hpp"
#include "haptic_bridge/link/message_reader.hpp"
#include "tests/support/sand_samples.hpp"
#include "tests/support/seed.hpp"

namespace {

using namespace haptic_bridge;

sand::Step someStep() { return {3, 77, true, {{100, -200, 300}, {101, -200, 299}, {110, 5, 299}}}; }

/// One message of each kind, with values that differ from all defaults.
std::vector<Message> oneOfEach() {
    const Identity identity{kProtocolVersion, sand::kAlgorithmVersion, 0x0123456789abcdefULL, "dunes"};
    Report report;
    report.hapticPeriodUsP50 = 1000.5;
    report.forceUsP99 = 2.25;
    report.toWall = {13.6, 9.8, 12, 40, 70};
    report.toMaster = {0.2, 0.1, 0.15, 1, 71};
    report.stepBytesMean = 84;
    report.steps = 9;
    report.stepsWithheld = {4, 3, 2, 1};
    report.samplesDropped = 1;
    report.ticksMissed = 3;
    report.guards.back() = 7;
    report.refused.back() = 6;
    report.handTicks = 5;
    report.feltTicks = 4;
    report.faultedTicks = 2;
    report.literal = true;
    report.audited = Audited::differed;
    return {Hello{identity, Role::watch, true, true, {1, 2}},
            Welcome{identity, 60, Role::watch, {3, 4}},
            Refusal{RefusalCode::busy, "busy"},
            Start{2, 40, 99, {0.5, true}},
            Ready{},
            NeedState{8, 9},
            State{{1, 2, 3}},
            StepMessage{-5, 17, someStep()},
            TimingTest{7, 50},
            Shown{41, 16'666'667, Held::pause},
            TimingEcho{7, Leg::shown},
            Ping{123},
            Pong{123, -9},
            report,
            Bye{"good night"},
            EditRequest{samples::withNumber(300, sand::Edit::undo)},
            ForceShare{0.25, true},
            TickPiece{{4, 5}},
            PositionGreeting{kProtocolVersion, "glove", {5}},
            Position{-7, 0.5, -0.25, 1.5, true},
            Challenge{identity, {6}},
            Proof{{7}},
            CatchUp{true, {someStep(), someStep()}}};
}

std::span<const std::uint8_t> withoutLength(const base::Bytes& framed) {
    return std::span(framed).subspan(sizeof(std::uint32_t));
}

TEST(Protocol, EveryMessageComesBackAsItWent) {
    const auto messages = oneOfEach();
    ASSERT_EQ(messages.size(), std::variant_size_v<Message>);
    for (std::size_t i = 0; i < messages.size(); ++i) {
        EXPECT_EQ(messages[i].index(), i);
        const base::Bytes framed = encode(messages[i]);
        EXPECT_EQ(framed[4], i + 1) << "the type byte";
        EXPECT_EQ(decode(withoutLength(framed)), messages[i]) << "message " << i;
    }
}

TEST(Protocol, BytesOnTheWireAreThoseOfTheDocument) {
    base::Bytes shown{66, 0, 0, 0, 10, 2, 1, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0, 0, 0, 0, 0, 1};
    for (std::uint8_t i = 4; i < 10; ++i) {
        shown.insert(shown.end(), {i, 0, 0, 0, 0, 0, 0, 0});
    }
    const FrameCost cost{.sweeps = 4, .substeps = 5, .sweepNs = 6, .dragNs = 7, .hashNs = 8, .drawNs = 9};
    EXPECT_EQ(encode(Shown{0x0102, 3, Held::disk, cost}), shown);
    base::Bytes hello{60, 0, 0, 0, 1, 'S', 'W', 'H', 'B', 6, 0, 0, 0, 1,   0, 0,
                      0,  2, 0, 0, 0, 0,   0,   0,   0,   1, 0, 0, 0, 'a', 2, 3};
    for (std::uint8_t i = 0; i < 32; ++i) {
        hello.push_back(i);
    }
    Nonce nonce;
    std::iota(nonce.begin(), nonce.end(), std::uint8_t{0});
    EXPECT_EQ(encode(Hello{{6, 1, 2, "a"}, Role::watch, true, true, nonce}), hello);
}

// Each of 52 numbers of the same type must be at its documented place. Otherwise both ends would make the same mistake.
TEST(Protocol, TheNumbersOfAReportStandInTheOrderOfTheDocument) {
    Report report{.hapticPeriodUsP50 = 1,
                  .hapticPeriodUsP99 = 2,
                  .hapticPeriodUsMax = 3,
                  .forceUsP50 = 4,
                  .forceUsP99 = 5,
                  .toWall = {6, 7, 8, 9, 19},
                  .toMaster = {10, 11, 12, 13, 20},
                  .stepBytesMean = 14,
                  .steps = 15,
                  .stepsWithheld = {24, 25, 26, 27},
                  .samplesDropped = 16,
                  .ticks = 17,
                  .ticksMissed = 18,
                  .guards = {},
                  .refused = {},
                  .handTicks = 21,
                  .feltTicks = 22,
                  .faultedTicks = 23,
                  .literal = true,
                  .audited = Audited::differed};
    std::iota(report.guards.begin(), report.guards.end(), std::uint64_t{28});
    std::iota(report.refused.begin(), report.refused.end(), std::uint64_t{43});
    const base::Bytes framed = encode(report);
    base::ByteReader reader(withoutLength(framed).subspan(1));
    for (int number = 1; number <= 14; ++number) {
        EXPECT_EQ(reader.get<double>(), number);
    }
    for (std::uint64_t number = 15; number <= 52; ++number) {
        EXPECT_EQ(reader.get<std::uint64_t>(), number);
    }
    EXPECT_EQ(reader.get<std::uint8_t>(), 1) << "literal guards";
    EXPECT_EQ(reader.get<std::uint8_t>(), 2) << "the audit: differed";
    EXPECT_TRUE(reader.atEnd());
    EXPECT_EQ(decode(withoutLength(framed)), Message(report));
}

TEST(Protocol, RefusesEveryTruncationAndEveryTrailingByte) {
    for (const Message& message : oneOfEach()) {
        const base::Bytes framed = encode(message);
        const auto whole = withoutLength(framed);
        // A state, and the padding of a timing test, may have any length.
        const bool open = std::holds_alternative<State>(message) || std::holds_alternative<TimingTest>(message) ||
                          std::holds_alternative<TickPiece>(message);
        for (std::size_t length = 0; length < (open ? 1 : whole.size()); ++length) {
            EXPECT_THROW((void)decode(whole.first(length)), base::FormatError) << message.index() << " at " << length;
        }
        if (!open) {
            base::Bytes longer(whole.begin(), whole.end());
            longer.push_back(0);
            EXPECT_THROW((void)decode(longer), base::FormatError) << message.index();
        }
    }
}

TEST(Protocol, RefusesAnEchoOfNoLeg) {
    base::Bytes framed = encode(TimingEcho{7, Leg::shown});
    for (const int leg : {0, 3, 255}) {
        framed.back() = static_cast<std::uint8_t>(leg);
        EXPECT_THROW((void)decode(withoutLength(framed)), base::FormatError) << leg;
    }
}

TEST(Protocol, RefusesACauseOrAResultThatHasNoName) {
    const auto refuses = [](const Message& message, std::size_t fromTheEnd, std::uint8_t value) {
        base::Bytes framed = encode(message);
        framed[framed.size() - fromTheEnd] = value;
        try {
            (void)decode(withoutLength(framed));
            return false;
        } catch (const base::FormatError&) {
            return true;
        }
    };
    const std::size_t held = 1 + 6 * sizeof(std::int64_t);  // in front of the cost of the frame
    EXPECT_FALSE(refuses(Shown{}, held, 2));
    EXPECT_TRUE(refuses(Shown{}, held, 3)) << "a reason to hold the sand";
    EXPECT_TRUE(refuses(Shown{}, 1, 255)) << "a time below zero";
    EXPECT_FALSE(refuses(Report{}, 2, 1));
    EXPECT_TRUE(refuses(Report{}, 2, 2)) << "a mark of literal guards";
    EXPECT_FALSE(refuses(Report{}, 1, 2));
    EXPECT_TRUE(refuses(Report{}, 1, 3)) << "the result of an audit";
}

TEST(Protocol, RefusesAShareOfTheForceThatNoOperatorCanSet) {
    const auto refuses = [](double share, std::uint8_t byOperator) {
        base::Bytes bytes = encode(ForceShare{0.5, true});
        std::memcpy(bytes.data() + 5, &share, sizeof share);
        bytes.back() = byOperator;
        try {
            (void)decode(std::span(bytes).subspan(4));
            return false;
        } catch (const base::FormatError&) {
            return true;
        }
    };
    EXPECT_FALSE(refuses(0, 0));
    EXPECT_FALSE(refuses(1, 1));
    EXPECT_TRUE(refuses(1, 2));
    for (const double share : {-0.001, 1.001, std::nan(""), std::numeric_limits<double>::infinity()}) {
        EXPECT_TRUE(refuses(share, 1)) << share;
    }
}

TEST(Protocol, AnEditTakesItsDetailsAlong) {
    for (sand::Edit edit : {sand::Edit::tuned({7, 11, 13, {.radius = 17}}), sand::Edit::loaded({3, 1, 4})}) {
        EXPECT_THROW((void)decode(withoutLength(encode(EditRequest{edit}))), base::FormatError) << "it has no number";
        edit.number = 1;
        const base::Bytes framed = encode(EditRequest{edit});
        EXPECT_EQ(decode(withoutLength(framed)), Message(EditRequest{edit}));
        for (std::size_t length = 0; length < framed.size() - 4; ++length) {
            EXPECT_THROW((void)decode(withoutLength(framed).first(length)), base::FormatError) << length;
        }
    }
}

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

// A load has up to 192 MiB, and its step may wait for seconds.
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

TEST(Protocol, TakesAStateOnceAndOnlyWhenExpected) {
    MessageReader reader;
    const base::Bytes large = encode(State{base::Bytes(3 * kMaxMessage, 9)});
    reader.expectState(true);
    reader.feed(large);
    EXPECT_TRUE(reader.next());
    reader.feed(encode(State{{1}}));
    EXPECT_THROW((void)reader.next(), base::FormatError);
}

TEST(Protocol, ReadsOnlyTheVersionOfAnotherProtocol) {
    base::ByteWriter payload;
    payload.put(std::uint8_t{1});
    payload.put(kMagic);
    payload.put(kProtocolVersion + 1);
    payload.putText("an unknown layout");
    const auto hello = std::get<Hello>(decode(payload.bytes()));
    EXPECT_EQ(hello.master.protocol, kProtocolVersion + 1);
    const auto refusal = refusalFor({}, hello.master);
    ASSERT_TRUE(refusal);
    EXPECT_EQ(refusal->code, RefusalCode::protocol);
}

TEST(Protocol, RefusesWithTheReason) {
    const Identity mine{kProtocolVersion, sand::kAlgorithmVersion, 1, "dunes"};
    EXPECT_FALSE(refusalFor(mine, mine));
    Identity other = mine;
    other.algorithm += 1;
    EXPECT_EQ(refusalFor(mine, other)->code, RefusalCode::algorithm);
    other = mine;
    other.sceneName = "beach";
    EXPECT_EQ(refusalFor(mine, other)->text,
              "the server has scene 'dunes', the master 'beach'; start both with the same scene");
    other = mine;
    other.rulesDigest = 2;
    EXPECT_NE(refusalFor(mine, other)->text.find("0000000000000002"), std::string::npos);
}

TEST(Protocol, PrintsNoControlCharactersOfTheOtherSide) {
    const base::Bytes framed = encode(Bye{"bad\nline\x1b[31m"});
    EXPECT_EQ(std::get<Bye>(decode(withoutLength(framed))).reason, "bad?line?[31m");
    const base::Bytes longer =
        encode(Bye{"\xc2\x9b"
                   "31m, caf\xc3\xa9, \xc2\xb5m\xc2"});
    EXPECT_EQ(std::get<Bye>(decode(withoutLength(longer))).reason, "??31m, caf\xc3\xa9, \xc2\xb5m\xc2");
}

// A message may hold 64 KiB of text, and a server may end each link with it.
TEST(Protocol, CutsALongReasonOffBetweenTwoCharacters) {
    std::string longText(kMaxReason - 4, 'x');
    for (int i = 0; i < 100; ++i) {
        longText += "\xc3\xa9";
    }
    const std::string cut = std::string(kMaxReason - 4, 'x') + "...";
    EXPECT_EQ(std::get<Bye>(decode(withoutLength(encode(Bye{longText})))).reason, cut);
    EXPECT_EQ(std::get<Refusal>(decode(withoutLength(encode(Refusal{RefusalCode::busy, longText})))).text, cut);
    const std::string fits(kMaxReason, 'y');
    EXPECT_EQ(std::get<Bye>(decode(withoutLength(encode(Bye{fits})))).reason, fits);
}

TEST(Protocol, RefusesACatchUpOfTooManyStepsOrWithSand) {
    CatchUp most{true, std::vector<sand::Step>(kMaxCatchUp, someStep())};
    EXPECT_NO_THROW((void)decode(withoutLength(encode(most))));
    CatchUp more = most;
    more.steps.push_back(someStep());
    EXPECT_THROW((void)decode(withoutLength(encode(more))), base::FormatError);
    most.steps[3].edit = sand::Edit::loaded({1, 2, 3});
    EXPECT_THROW((void)decode(withoutLength(encode(most))), base::FormatError);
}

}  // namespace
