// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/link/protocol.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "haptic_bridge/link/handshake.hpp"
#include "haptic_bridge/link/message_reader.hpp"
#include "tests/haptic_bridge/link/sample_messages.hpp"
#include "tests/support/files/overlong.hpp"
#include "tests/support/sand/sand_samples.hpp"
#include "tests/support/seed.hpp"

namespace {

using namespace haptic_bridge;

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

TEST(Protocol, HasOneFormOfEachNumber) {
    const auto numbersIn = [](const Message& message) {
        const base::Bytes framed = encode(message);
        const auto payload = withoutLength(framed);
        return test::widenedNumbers({payload.begin(), payload.end()}, [](const base::Bytes& wide) {
            const base::Bytes again = encode(decode(wide));
            const auto written = withoutLength(again);
            return base::Bytes(written.begin(), written.end());
        });
    };
    EXPECT_EQ(numbersIn(StepMessage{-5, 17, someStep()}), 3 + 9) << "epoch, number and sweeps, and three points";
    EXPECT_EQ(numbersIn(EditRequest{samples::withNumber(300, sand::Edit::undo)}), 1);
    EXPECT_EQ(numbersIn(CatchUp{true, {someStep(), someStep()}}), 2 * (3 + 9));
}

TEST(Protocol, BytesOnTheWireAreThoseOfTheDocument) {
    base::Bytes shown{82, 0, 0, 0, 10, 2, 1, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0, 0, 0, 0, 0, 1};
    for (std::uint8_t i = 4; i < 12; ++i) {
        shown.insert(shown.end(), {i, 0, 0, 0, 0, 0, 0, 0});
    }
    const FrameCost cost{
        .sweeps = 4, .substeps = 5, .phases = 6, .sweepNs = 7, .dragNs = 8, .phaseNs = 9, .hashNs = 10, .drawNs = 11};
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

// Each of 74 numbers of the same type must be at its documented place. Otherwise both ends would make the same mistake.
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
                  .stepsWithheld = {43, 44, 45, 46},
                  .samplesDropped = 16,
                  .ticks = 17,
                  .ticksMissed = 18,
                  .guards = {},
                  .refused = {},
                  .handTicks = 21,
                  .feltTicks = 22,
                  .faultedTicks = 23,
                  .handSeconds = 24,
                  .faultedSeconds = 25,
                  .asked = {},
                  .literal = true,
                  .deviceLosses = 71,
                  .deviceAway = true,
                  .arm = true,
                  .audited = Audited::differed};
    std::iota(report.asked.begin(), report.asked.end(), std::uint64_t{26});
    std::iota(report.guards.begin(), report.guards.end(), std::uint64_t{47});
    std::iota(report.refused.begin(), report.refused.end(), std::uint64_t{65});
    const base::Bytes framed = encode(report);
    base::ByteReader reader(withoutLength(framed).subspan(1));
    for (int number = 1; number <= 14; ++number) {
        EXPECT_EQ(reader.get<double>(), number);
    }
    for (std::uint64_t number = 15; number <= 74; ++number) {
        EXPECT_EQ(reader.get<std::uint64_t>(), number);
    }
    EXPECT_EQ(reader.get<std::uint8_t>(), 1) << "literal guards";
    EXPECT_EQ(reader.get<std::uint64_t>(), 71) << "losses of the device";
    EXPECT_EQ(reader.get<std::uint8_t>(), 1) << "it is away";
    EXPECT_EQ(reader.get<std::uint8_t>(), 1) << "an arm";
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
    const std::size_t held = 1 + 8 * sizeof(std::int64_t);  // in front of the cost of the frame
    EXPECT_FALSE(refuses(Shown{}, held, 2));
    EXPECT_TRUE(refuses(Shown{}, held, 3)) << "a reason to hold the sand";
    EXPECT_TRUE(refuses(Shown{}, 1, 255)) << "a time below zero";
    EXPECT_FALSE(refuses(Report{}, 3, 1));
    EXPECT_TRUE(refuses(Report{}, 3, 2)) << "a mark of literal guards";
    EXPECT_TRUE(refuses(Report{}, 2, 2)) << "a mark of an arm";
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

// A watcher that does not know an edit or a tool cannot read its step. A new one therefore raises the version, and its
// writer puts both numbers here.
TEST(Protocol, HasTheEditsAndToolsOfItsVersion) {
    EXPECT_EQ(sand::kEdits, 6);
    EXPECT_EQ(sand::kToolKinds, 6);
    EXPECT_GE(kProtocolVersion, 10U) << "the first with so many";
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
