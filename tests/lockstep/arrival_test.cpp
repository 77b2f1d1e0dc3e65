// SPDX-License-Identifier: Apache-2.0
#include "lockstep/arrival.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <set>
#include <string>

#include "sand/model/step.hpp"

namespace {

using lockstep::Arrival;

constexpr std::uint64_t kFrame = 30;
constexpr base::Keystroke kKey{'q', base::Keystroke::kControl, 1};
constexpr int kLength = static_cast<int>(sizeof(Arrival));
using Room = std::array<std::uint8_t, lockstep::kArrivalRoom>;

/// Returns the bytes of an arrival at frame `frame`, as MPI writes them into the buffer.
Room letterOf(std::uint64_t frame) {
    const Arrival arrival{frame, 1, 2, 3, 4, 5, 6, kKey};
    Room room{};
    std::memcpy(room.data(), &arrival, sizeof arrival);
    return room;
}

/// Returns the error for a message at the barrier of kFrame; "nothing" if it is an arrival.
std::string faultOf(const Room& room, int length) {
    try {
        (void)lockstep::readArrival(room, length, kFrame);
    } catch (const base::FormatError& error) {
        return error.what();
    }
    return "nothing";
}

TEST(Arrival, ComesBackAsItWent) {
    const Arrival read = lockstep::readArrival(letterOf(kFrame), kLength, kFrame);
    EXPECT_EQ(read.frame, kFrame);
    EXPECT_EQ(read.arrived, 1);
    EXPECT_EQ(read.lastSwap, 2);
    EXPECT_EQ(read.drawn, 3);
    EXPECT_EQ(read.stateHash, 4U);
    EXPECT_EQ(read.movement, 5U);
    EXPECT_EQ(read.viewHash, 6U);
    EXPECT_EQ(read.key, kKey);
}

// An arrival of the frame before comes from a slow rank, or from a rank that has sent it twice.
TEST(Arrival, AtAnotherFrameIsNone) {
    for (const std::uint64_t frame : {kFrame - 1, kFrame + 1, std::uint64_t{0}, ~std::uint64_t{0}}) {
        EXPECT_EQ(faultOf(letterOf(frame), kLength), "of frame " + std::to_string(frame));
    }
}

TEST(Arrival, OfAnotherLengthIsNoneThoughItsFrameIsRight) {
    for (const int length : {0, 8, kLength - 1, kLength + 1, static_cast<int>(lockstep::kArrivalRoom)}) {
        EXPECT_EQ(faultOf(letterOf(kFrame), length),
                  std::to_string(length) + " bytes instead of " + std::to_string(kLength));
    }
    EXPECT_EQ(faultOf(letterOf(kFrame), lockstep::kCutShort), "longer than 512 bytes");
}

/// Returns the bytes of an arrival with a pointer behind it.
Room letterWith(const haptic_bridge::PointerReport& pointer) {
    Room room = letterOf(kFrame);
    std::memcpy(room.data() + kLength, &pointer, sizeof pointer);
    return room;
}

constexpr int kWithPointer = kLength + static_cast<int>(sizeof(haptic_bridge::PointerReport));

TEST(Arrival, CarriesAPointerIfTheSessionsHandIsOne) {
    haptic_bridge::PointerReport pointer;
    pointer.touch = 3;
    pointer.count = 1;
    pointer.samples[0] = {7, {1, -2, 3}, 1, 1, {}};
    haptic_bridge::PointerReport read;
    EXPECT_EQ(lockstep::readArrival(letterWith(pointer), kWithPointer, kFrame, &read).key, kKey);
    EXPECT_EQ(read, pointer);
    EXPECT_THROW((void)lockstep::readArrival(letterWith(pointer), kLength, kFrame, &read), base::FormatError);
    EXPECT_THROW((void)lockstep::readArrival(letterWith(pointer), kWithPointer, kFrame), base::FormatError)
        << "other sessions keep their messages small";
}

TEST(Arrival, WithAnImpossiblePointerIsNone) {
    const auto fault = [](const haptic_bridge::PointerReport& pointer) {
        haptic_bridge::PointerReport read;
        try {
            (void)lockstep::readArrival(letterWith(pointer), kWithPointer, kFrame, &read);
        } catch (const base::FormatError& error) {
            EXPECT_EQ(read, haptic_bridge::PointerReport{});
            return std::string(error.what());
        }
        return std::string("nothing");
    };
    haptic_bridge::PointerReport many;
    many.count = haptic_bridge::PointerReport::kMostSamples + 1;
    EXPECT_EQ(fault(many), "a pointer with 7 places");
    haptic_bridge::PointerReport far;
    far.count = 1;
    far.samples[0].probe.y = sand::kMaxProbe;
    EXPECT_EQ(fault(far), "a pointer at 16777216");
    for (const std::int64_t time : {std::int64_t{-1}, std::numeric_limits<std::int64_t>::max()}) {
        haptic_bridge::PointerReport late;
        late.count = 1;
        late.samples[0].readNs = time;
        EXPECT_EQ(fault(late), "a pointer at the time " + std::to_string(time) + " ns");
    }
    for (float haptic_bridge::PointerReport::*const number :
         {&haptic_bridge::PointerReport::wheel, &haptic_bridge::PointerReport::depth,
          &haptic_bridge::PointerReport::size, &haptic_bridge::PointerReport::turnX,
          &haptic_bridge::PointerReport::turnY}) {
        haptic_bridge::PointerReport endless;
        endless.*number = std::numeric_limits<float>::infinity();
        EXPECT_EQ(fault(endless), "a pointer with a number that is not finite");
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        haptic_bridge::PointerReport pan, zoom;
        pan.pan.at(axis) = std::numeric_limits<float>::quiet_NaN();
        zoom.wheelAt.at(axis) = -std::numeric_limits<float>::infinity();
        EXPECT_EQ(fault(pan), "a pointer with a number that is not finite");
        EXPECT_EQ(fault(zoom), "a pointer with a number that is not finite");
    }
}

// Frames 30, 31 and 32 are those of the drill in tests/cluster/drills_test.cpp.
TEST(Arrival, OfADrillIsNoiseOfThreeKindsByTurns) {
    std::set<base::Bytes> all;
    for (std::uint64_t frame = kFrame; frame < kFrame + 30; ++frame) {
        const base::Bytes noise = lockstep::noiseForArrival(frame);
        const std::array<std::size_t, 3> lengths{sizeof(Arrival), 200, 4000};
        EXPECT_EQ(noise.size(), lengths.at(frame % 3)) << frame;
        EXPECT_GT(std::set(noise.begin(), noise.end()).size(), 16U) << frame << " is noise";
        Room room{};
        std::copy_n(noise.begin(), std::min(noise.size(), room.size()), room.begin());
        const bool fits = noise.size() <= room.size();
        EXPECT_THROW(
            (void)lockstep::readArrival(room, fits ? static_cast<int>(noise.size()) : lockstep::kCutShort, frame),
            base::FormatError)
            << frame;
        all.insert(noise);
    }
    EXPECT_EQ(all.size(), 30U) << "each frame has other noise";
    EXPECT_LT(sizeof(Arrival), 200U);
    EXPECT_LT(lockstep::kArrivalRoom, 4000U) << "the longest noise is longer than the buffer";
}

TEST(Arrival, WithAnUnknownStateOfAMonitorIsNone) {
    Arrival arrival{kFrame, 1, 2, 3, 4, 5, 6, kKey};
    arrival.monitors = {1, 2};
    Room room{};
    std::memcpy(room.data(), &arrival, sizeof arrival);
    EXPECT_EQ(lockstep::readArrival(room, kLength, kFrame).monitors, arrival.monitors);
    arrival.monitors[1] = 3;
    std::memcpy(room.data(), &arrival, sizeof arrival);
    EXPECT_EQ(faultOf(room, kLength), "with a monitor in state 3");
}

}  // namespace
