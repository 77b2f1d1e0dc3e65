// SPDX-License-Identifier: Apache-2.0
// A simulated wireless link, and a hand that feels the sand over it.
#include "tests/impaired_link/impaired_link.hpp"

#include <boost/asio/connect.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <thread>

#include "host/clock.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/support/processes/server_process.hpp"
#include "tests/support/sand/sand_of.hpp"

namespace {

using namespace test;
using boost::asio::ip::tcp;
using impaired_link::ImpairedLink;
using impaired_link::Impairment;
using impaired_link::Schedule;

constexpr std::int64_t kMs = 1'000'000;  // [ns]

TEST(ImpairedSchedule, PiecesLeaveInOrderAndWithinDelayAndJitter) {
    Schedule schedule({.delayMs = 20, .jitterMs = 10, .seed = 5}, 0);
    std::int64_t before = 0, least = 1000 * kMs, most = 0;
    for (int i = 0; i < 10'000; ++i) {
        const std::int64_t arrived = i * 16 * kMs;
        const std::int64_t left = schedule.leaves(arrived);
        ASSERT_GE(left, before) << i;
        least = std::min(least, left - arrived);
        most = std::max(most, left - arrived);
        before = left;
    }
    EXPECT_GE(least, 20 * kMs);
    EXPECT_LT(least, 21 * kMs) << "the whole range of the jitter is used";
    EXPECT_LT(most, 30 * kMs);
    EXPECT_GT(most, 29 * kMs);
    EXPECT_EQ(schedule.stalls(), 0U);
}

TEST(ImpairedSchedule, WhatIsLostHoldsUpWhatIsBehindIt) {
    Schedule schedule({.delayMs = 1, .stallShare = 0.1, .stallMs = 100, .seed = 5}, 0);
    int late = 0;
    for (int i = 0; i < 10'000; ++i) {
        const std::uint64_t stalls = schedule.stalls();
        const std::int64_t left = schedule.leaves(i * 1000 * kMs);
        EXPECT_EQ(left - i * 1000 * kMs, schedule.stalls() > stalls ? 101 * kMs : kMs);
        late += schedule.stalls() > stalls ? 1 : 0;
    }
    // 10,000 trials with a probability of 0.1 have a mean of 1000 and a standard deviation of 30.
    EXPECT_GT(late, 880);
    EXPECT_LT(late, 1120);
    Schedule always({.delayMs = 1, .stallShare = 1, .stallMs = 100}, 0);
    const std::int64_t first = always.leaves(0);
    Schedule mixed({.stallShare = 0.5, .stallMs = 100, .seed = 3}, 0);
    while (mixed.stalls() == 0) {
        (void)mixed.leaves(first);
    }
    EXPECT_EQ(mixed.leaves(first), first + 100 * kMs) << "a piece close behind the lost one waits with it";
}

TEST(ImpairedSchedule, OneSeedIsOneScheduleAndEveryDirectionHasItsOwn) {
    const Impairment impairment{.delayMs = 3, .jitterMs = 6, .stallShare = 0.02, .stallMs = 40, .seed = 9};
    Schedule one(impairment, 4), again(impairment, 4), other(impairment, 5);
    int equal = 0;
    for (int i = 0; i < 1000; ++i) {
        const std::int64_t left = one.leaves(i * 100 * kMs);
        ASSERT_EQ(left, again.leaves(i * 100 * kMs));
        equal += left == other.leaves(i * 100 * kMs) ? 1 : 0;
    }
    EXPECT_LT(equal, 10);
}

/// A listening socket behind a link, and one connection through the link.
class Crossing {
public:
    explicit Crossing(const Impairment& impairment)
        : acceptor_(io_, tcp::endpoint(boost::asio::ip::address_v4::loopback(), 0)),
          link(impairment, "127.0.0.1", acceptor_.local_endpoint().port()),
          near(io_),
          far(io_) {
        near.connect({boost::asio::ip::address_v4::loopback(), link.port()});
        acceptor_.accept(far);
    }

private:
    boost::asio::io_context io_;
    tcp::acceptor acceptor_;

public:
    ImpairedLink link;
    tcp::socket near, far;
};

std::vector<std::uint8_t> noise(std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<std::uint8_t> bytes(count);
    std::generate(bytes.begin(), bytes.end(), [&] { return static_cast<std::uint8_t>(random()); });
    return bytes;
}

std::vector<std::uint8_t> readToEnd(tcp::socket& socket) {
    std::vector<std::uint8_t> bytes;
    boost::system::error_code error;
    boost::asio::read(socket, boost::asio::dynamic_buffer(bytes), error);
    EXPECT_EQ(error, boost::asio::error::eof);
    return bytes;
}

TEST(ImpairedLink, BytesOfBothDirectionsComeWholeInOrderAndHeldInBounds) {
    Crossing crossing({.delayMs = 2, .jitterMs = 3, .stallShare = 0.01, .stallMs = 5, .seed = 2});
    // This is more than the link and the sockets can hold, so the sender has to wait.
    const auto sent = noise(8'000'000, 1), answered = noise(300'000, 2);
    std::thread writer([&] {
        boost::asio::write(crossing.near, boost::asio::buffer(sent));
        crossing.near.shutdown(tcp::socket::shutdown_send);
    });
    std::this_thread::sleep_for(50ms);  // no reader yet
    std::thread answerer([&] {
        boost::asio::write(crossing.far, boost::asio::buffer(answered));
        crossing.far.shutdown(tcp::socket::shutdown_send);
    });
    EXPECT_EQ(readToEnd(crossing.far), sent);
    EXPECT_EQ(readToEnd(crossing.near), answered);
    writer.join();
    answerer.join();
    EXPECT_LE(crossing.link.mostHeld(), ImpairedLink::kMostHeld);
    EXPECT_GT(crossing.link.stalls(), 0U);
    EXPECT_EQ(crossing.link.resets(), 0);
}

TEST(ImpairedLink, NothingComesBeforeItsDelay) {
    Crossing crossing({.delayMs = 30});
    std::array<std::uint8_t, 50> message{};
    for (int i = 0; i < 3; ++i) {
        const std::int64_t sent = host::monotonicNs();
        boost::asio::write(crossing.near, boost::asio::buffer(message));
        boost::asio::read(crossing.far, boost::asio::buffer(message));
        boost::asio::write(crossing.far, boost::asio::buffer(message));
        boost::asio::read(crossing.near, boost::asio::buffer(message));
        EXPECT_GE(host::monotonicNs() - sent, 60 * kMs);
    }
}

TEST(ImpairedLink, ResetsAsManyConnectionsAsItWasToldAndNoMore) {
    Crossing crossing({.resetAfter = 1000, .resets = 1});
    std::array<std::uint8_t, 1000> message{};
    boost::asio::write(crossing.near, boost::asio::buffer(message));
    boost::system::error_code error;
    crossing.near.read_some(boost::asio::buffer(message), error);
    EXPECT_EQ(error, boost::asio::error::connection_reset);
    EXPECT_EQ(crossing.link.resets(), 1);
}

class HandOverABadLink : public testing::Test {
protected:
    Folder folder_;
    std::string sceneFile_ = folder_.write("small.toml", kSmallScene);
    scene::Scene scene_ = scene::loadScene(sceneFile_);
};

TEST_F(HandOverABadLink, TheSandIsTheSameAndAResetEndsNothing) {
    ServerProcess server(folder_, ServerProcess::usual(sceneFile_, folder_));
    const ImpairedLink link(
        {.delayMs = 20, .jitterMs = 10, .stallShare = 0.02, .stallMs = 60, .resetAfter = 25'000, .seed = 11},
        "127.0.0.1", server.port());
    haptic_bridge::Client client({"127.0.0.1", link.port()}, offerOf(scene_));
    Wall wall(scene_);
    ASSERT_TRUE(wall.follow(client, 20)) << client.link().message << "\n" << server.errors();
    // The wall reports after every frame which step it shows, so the reset comes soon.
    ASSERT_TRUE(eventually([&] {
        client.shown({wall.replica.stepNumber(), 16'666'667});
        return link.resets() == 1;
    }));
    const std::uint64_t then = wall.replica.stepNumber();
    const int engaged = wall.engaged;
    ASSERT_TRUE(wall.follow(client, then + 100)) << client.link().message << "\n" << server.errors();
    EXPECT_EQ(wall.epoch, 2U);
    EXPECT_EQ(client.counters().reconnects, 1U);
    EXPECT_EQ(wall.divergences, 0);
    EXPECT_EQ(wall.outOfOrder, 0);
    EXPECT_GT(wall.engaged, engaged) << "the hand continues";
    EXPECT_EQ(samples::fieldOf(wall.replica).volume() + wall.replica.outflow(), scene_.terrain.volume());
}

}  // namespace
