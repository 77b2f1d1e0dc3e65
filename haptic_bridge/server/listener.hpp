// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <list>
#include <memory>
#include <set>
#include <string>

#include "haptic_bridge/link/connection.hpp"
#include "haptic_bridge/link/handshake.hpp"
#include "haptic_bridge/server/guest_limits.hpp"
#include "haptic_bridge/server/sand_thread.hpp"

namespace haptic_bridge {

class Peer;

/// At which times a master is sent timing tests: at random, from a seed, because nothing in a session should differ by
/// chance.
struct TimingTests {
    double perSecond = 4;  // mean
    double after = 0;      // [s] from when the server numbers the steps: a wall's first frames compile shaders
    std::uint32_t seed = 7;
};

/// The streaming thread: accepts masters, one at a time, and sends the sand thread's steps to the master and to
/// watchers.
///
/// Everything runs on the thread that runs `io`. A master that leaves, breaks or sends garbage ends its own link and
/// nothing else; the next one may come. A guest is a connection before its welcome. There
/// are at most kMaxGuests at once, and the oldest is closed when another comes; at most kMaxGuestsOfOne come from one
/// address beyond this machine; GuestLimits bounds how often they come.
class Listener {
public:
    struct Sources {
        std::function<Report()> report;               // the parts of a report that the link does not measure itself
        std::function<void(const std::string&)> log;  // one line for a person
        /// Pieces of the tick track that are there for the master's journal; with `all`, waits for the last ones. Empty
        /// where nothing is recorded.
        std::function<std::vector<base::Bytes>(bool all)> ticks = {};
        std::function<void(double share)> shareForce = {};  // an operator's wish
    };

    /// Takes over a listening acceptor.
    Listener(boost::asio::io_context& io, boost::asio::ip::tcp::acceptor acceptor, Identity identity,
             std::uint32_t stepsPerSecond, Sources sources, TimingTests tests = {}, LinkSecurity security = {});
    ~Listener();

    /// Callbacks for the sand thread. Each hands its call over to the streaming thread.
    [[nodiscard]] SandThread::Output output();
    /// Masters are taken in from now on.
    void serve(SandThread& sandThread);
    /// Says goodbye to the master and stops listening; stops the io context when that has arrived, or after 0.6 s.
    void shut(const std::string& reason);
    [[nodiscard]] const RefusalCounts& refused() const { return refusals_.counts(); }

    static constexpr std::size_t kMaxGuests = 16;  // connections that have not been welcomed yet
    static constexpr int kMaxGuestsOfOne = 4;      // of those, from one address beyond this machine
    static constexpr std::size_t kMaxWatchers = 8;
    static constexpr int kMaxConnections = 64;  // of all kinds, those included that are being closed

private:
    friend class Peer;
    void accept();
    void admit(Connection::Socket socket);
    /// Counts it, and says so unless `line` is empty.
    void refused(RefusalCode code, const boost::asio::ip::address& address, const std::string& line);
    [[nodiscard]] bool tooManyOf(const boost::asio::ip::address& address) const;
    void guestWent(const Peer& guest);
    void stopWhenGone(const std::weak_ptr<Connection>& last, int polls);
    [[nodiscard]] std::shared_ptr<Peer> linked(std::uint32_t session) const;

    boost::asio::io_context& io_;
    boost::asio::ip::tcp::acceptor acceptor_;
    boost::asio::steady_timer pause_;
    Identity identity_;
    std::uint32_t stepsPerSecond_;
    Sources sources_;
    TimingTests tests_;
    LinkSecurity security_;
    SandThread* sandThread_ = nullptr;
    std::shared_ptr<Peer> current_;  // the one that passed the handshake and may move
    std::set<std::shared_ptr<Peer>> watchers_;
    GuestLimits limits_;
    RefusalLog refusals_;
    std::uint32_t sessions_ = 0;
    std::list<std::shared_ptr<Peer>> guests_;  // not welcomed yet, the oldest first
    std::shared_ptr<int> connections_ = std::make_shared<int>(0);
    bool shutting_ = false;
};

}  // namespace haptic_bridge
