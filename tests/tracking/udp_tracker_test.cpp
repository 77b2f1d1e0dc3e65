// SPDX-License-Identifier: Apache-2.0
#include "tracking/udp_tracker.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/udp.hpp>
#include <chrono>
#include <thread>

#include "tests/support/refusal.hpp"
#include "tests/tracking/tracking_samples.hpp"
#include "tracking/dtrack.hpp"
#include "tracking/opentrack.hpp"

namespace {

using namespace tracking;
using test::near;

/// Tracker on a free port of loopback, and a sender to it. Its clock stops unless the test moves it.
class UdpTrackerTest : public testing::Test {
protected:
    void open(const std::string& source) {
        tracker = openTracker(
            Source::parse(source, "--track"), {0, 1.6, 2}, [this](const std::string& line) { lines.push_back(line); },
            [this] { return now; });
        sender = std::make_unique<UdpSender>("127.0.0.1", tracker->port());
    }
    /// Reads the tracker until `packets` packets have come. Loopback loses no packet while the socket has room.
    std::optional<Pose> lookUntil(std::uint64_t packets) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
        std::optional<Pose> pose = tracker->newest(0);
        while (tracker->counters().packets < packets && std::chrono::steady_clock::now() < end) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            pose = tracker->newest(0);
        }
        EXPECT_EQ(tracker->counters().packets, packets);
        return pose;
    }

    std::int64_t now = 0;  // [ns]
    std::vector<std::string> lines;
    std::unique_ptr<HeadTracker> tracker;
    std::unique_ptr<UdpSender> sender;
};

TEST_F(UdpTrackerTest, GivesNothingBeforeTheFirstPacket) {
    open("opentrack:0");
    EXPECT_FALSE(tracker->newest(0));
}

TEST_F(UdpTrackerTest, TakesTheNewestOfWhatHasArrived) {
    open("opentrack:0");
    for (const double up : {1.0, 2.0, 3.0}) {
        sender->send(test::doubles({0, up, 0, 0, 0, 0}));
    }
    const std::optional<Pose> pose = lookUntil(3);
    ASSERT_TRUE(pose);
    EXPECT_TRUE(near(pose->position, {0, 1.63, 2})) << "from the resting eye";
    EXPECT_EQ(tracker->newest(0), pose) << "held";
}

TEST_F(UdpTrackerTest, CountsAndIgnoresWhatIsNoPacket) {
    open("opentrack:0 origin=0,0,0");
    sender->send(test::doubles({0, 10, 0, 0, 0, 0}));
    sender->send(base::Bytes{});
    sender->send(base::Bytes(47, 1));
    sender->send(base::Bytes(65507, 1));
    sender->send(test::doubles({0, 1e9, 0, 0, 0, 0}));
    sender->send(test::doubles({0, std::nan(""), 0, 0, 0, 0}));
    const std::optional<Pose> pose = lookUntil(6);
    ASSERT_TRUE(pose);
    EXPECT_TRUE(near(pose->position, {0, 0.1, 0}));
    EXPECT_EQ(tracker->counters().refused, 5U);
}

TEST_F(UdpTrackerTest, ListensBeyondThisMachineToOneAddressAlone) {
    const std::string line = test::refusalOf([&] { open("opentrack:0.0.0.0:0"); });
    EXPECT_NE(line.find("from="), std::string::npos) << line;
    open("opentrack:0.0.0.0:0 from=127.0.0.2 origin=0,0,0");
    // Far more packets than the kernel has room for. Packets from the wrong address must take none of it.
    constexpr std::uint64_t kMany = 5'000;
    for (std::uint64_t i = 0; i < kMany; ++i) {
        sender->send(test::doubles({0, 10, 0, 0, 0, 0}));
    }
    namespace ip = boost::asio::ip;
    boost::asio::io_context io;
    ip::udp::socket known(io, {ip::make_address("127.0.0.2"), 0});
    known.send_to(boost::asio::buffer(test::doubles({0, 10, 0, 0, 0, 0})),
                  {ip::make_address("127.0.0.1"), tracker->port()});
    EXPECT_TRUE(lookUntil(1));
    EXPECT_GE(tracker->counters().strangers, kMany);
    open("opentrack:0.0.0.0:0 from=127.0.0.1 origin=0,0,0");
    sender->send(test::doubles({0, 10, 0, 0, 0, 0}));
    EXPECT_TRUE(lookUntil(1));
}

TEST_F(UdpTrackerTest, DropsWhatTheNetworkReordered) {
    open("dtrack:0");
    for (const unsigned frame : {1U, 3U, 2U, 3U}) {
        sender->send(dtrackPacket({{0.1 * frame, 1.6, 2}, {1, 0, 0}}, frame, 0));
    }
    sender->send(dtrackPacket({{0, 0, 0}, {1, 0, 0}}, 4, 7));
    const std::optional<Pose> pose = lookUntil(5);
    ASSERT_TRUE(pose);
    EXPECT_TRUE(near(pose->position, {0.3, 1.6, 2}));
    EXPECT_EQ(tracker->counters().old, 2U);
    EXPECT_EQ(tracker->counters().absent, 1U) << "another body";
}

TEST_F(UdpTrackerTest, HoldsTheLastPoseWhileLostAndTakesANewStart) {
    open("dtrack:0");
    sender->send(dtrackPacket({{0.5, 1.6, 2}, {1, 0, 0}}, 900, 0));
    const std::optional<Pose> pose = lookUntil(1);
    for (int frame = 0; frame < 100; ++frame) {
        now += 16'666'667;
        EXPECT_EQ(tracker->newest(0), pose);
    }
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_NE(lines[0].find("no pose from dtrack:0 for 0.5 s"), std::string::npos) << lines[0];
    // A restarted tracker counts from 1. Among packets that arrive together, the order counts again.
    sender->send(dtrackPacket({{0.7, 1.6, 2}, {1, 0, 0}}, 2, 0));
    sender->send(dtrackPacket({{0.9, 1.6, 2}, {1, 0, 0}}, 1, 0));
    EXPECT_TRUE(near(lookUntil(3).value().position, {0.7, 1.6, 2}));
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_EQ(lines[1], "head tracking: dtrack:0 is back after 1.7 s");
    EXPECT_EQ(tracker->counters().timesLost, 1U);
}

TEST_F(UdpTrackerTest, AFloodDoesNotHoldTheFrameUp) {
    open("opentrack:0");
    // The sender may send more than one read takes or the socket has room for. The read must end in any case.
    for (int i = 0; i < 3 * UdpTracker::kMostPackets; ++i) {
        sender->send(test::doubles({0, 0, 0, 0, 0, 0}));
    }
    (void)tracker->newest(0);
    EXPECT_LE(tracker->counters().packets, static_cast<std::uint64_t>(UdpTracker::kMostPackets));
}

TEST_F(UdpTrackerTest, SaysThatAPortIsTaken) {
    open("opentrack:0");
    const std::string source = "opentrack:" + std::to_string(tracker->port());
    EXPECT_EQ(test::refusalOf([&] { open(source); }), source + ": port " + std::to_string(tracker->port()) +
                                                          " is in use; stop the program that has it, or take another "
                                                          "port");
}

TEST_F(UdpTrackerTest, SaysThatAnAddressIsNotOurs) {
    // This address is reserved for documentation, so that no machine has it.
    EXPECT_NE(test::refusalOf([&] {
                  open("opentrack:192.0.2.1:4242 from=192.0.2.2");
              }).find("cannot listen on 192.0.2.1 port 4242"),
              std::string::npos);
}

TEST(OpenTracker, NoneIsNoTracker) {
    EXPECT_EQ(openTracker(Source::parse("none", "--track"), {}, [](const std::string&) {}), nullptr);
}

}  // namespace
