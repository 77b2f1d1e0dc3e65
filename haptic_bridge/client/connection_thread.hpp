// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "haptic_bridge/client/client.hpp"
#include "haptic_bridge/client/clock_offset.hpp"
#include "haptic_bridge/link/connection.hpp"

namespace haptic_bridge {

/// What lies behind Client: a network thread that runs the whole conversation, and a locked shelf between it and the
/// callers. Members that end in an underscore and stand below `shelf` belong to the network thread.
class Client::Session {
public:
    Session(Address address, Offer offer, LinkSecurity security, LinkClock clock);
    ~Session() { stop(); }
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    void grant(Start start, base::Bytes state, StepRing recent);
    std::vector<TimedStep> drain(std::size_t most);
    void shown(const Shown& frame);
    void request(const EditRequest& request);
    void shareForce(double share);
    void drill(LinkDrill drill, std::chrono::milliseconds length);
    std::vector<TimedPosition> drainPositions();
    void stop();

    /// What callers see, under its mutex.
    struct Shelf {
        std::mutex mutex;
        LinkStatus status;
        std::deque<TimedStep> steps;
        struct Test {
            std::uint32_t id = 0;
            std::uint64_t after = 0;  // number of the step before it
        };
        std::deque<Test> tests;                   // that wait for a frame, as steps do
        std::vector<std::uint32_t> testsInFrame;  // to be echoed after the next swap
        std::vector<base::Bytes> ticks;
        std::vector<TimedPosition> positions;
        std::uint64_t floods = 0;
        std::optional<Report> report;
        LinkCounters counters;
        std::int64_t clockOffsetNs = 0;
        std::uint32_t stepsPerSecond = 0;
        bool full = false;  // reading is paused until somebody drains
    } shelf;

private:
    using Timer = boost::asio::steady_timer;
    using Milliseconds = std::chrono::milliseconds;
    static constexpr Milliseconds kFirstBackOff{100}, kLastBackOff{2000};

    void tell(Link link, const std::string& message);
    [[nodiscard]] Link link();
    void run();
    void connect();
    void connected(Connection::Socket socket);
    void failed(const std::string& why);
    void closed(const std::string& why);
    void greet();
    void refuse(const std::string& why, Connection::Fault fault);
    void countRefusal(RefusalCode code);
    void prove(const Challenge& challenge);
    [[nodiscard]] bool up() { return link() >= Link::offered && link() <= Link::streaming; }
    void handOver(const NeedState& need);
    void retry();
    void watch();
    void ping();
    void receive(Message&& message);
    void welcome(const Welcome& welcome);
    void accept(StepMessage&& message);
    void accept(const TimingTest& test);
    void greet(const PositionGreeting& greeting);
    void accept(const Position& position);
    void resumeReading();
    [[nodiscard]] bool silent() const;  // on purpose

    const Address address_;
    const Offer offer_;
    const LinkSecurity security_;
    const LinkClock now_;
    std::optional<MasterHandshake> handshake_;
    boost::asio::io_context io_;
    boost::asio::ip::tcp::resolver resolver_{io_};
    Timer retryTimer_{io_}, pingTimer_{io_}, watchTimer_{io_}, drillTimer_{io_};
    Timer goodbyeTimer_{io_};  // nothing else's: a handler that is due already must not put off the end
    std::shared_ptr<Connection> connection_;
    std::string peer_;
    Start granted_;
    base::Bytes state_;
    StepRing recent_;
    int handOvers_ = 0;  // answers to NeedState since the grant
    std::uint64_t lastStep_ = 0;
    ClockOffset clock_;
    Milliseconds backOff_{};
    std::int64_t heardNs_ = 0;  // by now_
    std::chrono::steady_clock::time_point silentUntil_;
    int pings_ = 0;
    bool everWelcomed_ = false, stopping_ = false;
    std::thread thread_;
};

}  // namespace haptic_bridge
