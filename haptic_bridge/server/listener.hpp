// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <memory>
#include <string>

#include "haptic_bridge/link/connection.hpp"
#include "haptic_bridge/server/service.hpp"

namespace haptic_bridge {

class Gate;
class Peer;
template <class Member>
class Roster;

/// Accepts masters, one at a time, and sends the steps of the sand thread to the master and to watchers.
///
/// Everything runs on the streaming thread: the server's main thread, which runs the service's `io`. A master that
/// leaves, fails or sends garbage ends only its own link, and another master may connect. Roster and Gate limit how
/// many unauthenticated connections there are and how often they come.
class Listener {
public:
    /// Takes over `acceptor`, which must listen.
    Listener(Service service, boost::asio::ip::tcp::acceptor acceptor);
    ~Listener();

    /// Returns callbacks for the sand thread. Each hands its call over to the streaming thread.
    [[nodiscard]] SandThread::Output output();
    /// Accepts masters from now on.
    void serve(SandThread& sandThread);
    /// Answers peers with Loading, after `quiet`. A short load needs no answer: its peers wait to be accepted.
    void answerLoading(std::chrono::milliseconds quiet);
    /// Ends that. Says goodbye to these peers, and returns the acceptor. Their connections close later, so this object
    /// must outlive the io context's next run.
    [[nodiscard]] boost::asio::ip::tcp::acceptor endLoading();
    /// Says goodbye to the master and stops listening. Stops the io context when the master's connection has closed, or
    /// after 0.6 s.
    void shut(const std::string& reason);

private:
    void accept();
    void admit(Connection::Socket socket);
    void stopWhenGone(const std::weak_ptr<Connection>& last, int polls);

    Service service_;
    boost::asio::ip::tcp::acceptor acceptor_;
    boost::asio::steady_timer pause_;
    std::unique_ptr<Gate> gate_;
    std::unique_ptr<Roster<Peer>> roster_;
    bool shutting_ = false;
};

}  // namespace haptic_bridge
