// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <memory>
#include <string>

#include "haptic_bridge/link/connection.hpp"
#include "haptic_bridge/server/service.hpp"

namespace haptic_bridge {

class Gate;
class Peer;
template <class Member>
class Roster;

/// The streaming thread: accepts masters, one at a time, and sends the sand thread's steps to the master and to
/// watchers.
///
/// Everything runs on the thread that runs the service's `io`. A master that leaves, breaks or sends garbage ends its
/// own link and nothing else; the next one may come. A guest is a connection before its welcome. Roster and Gate bound
/// how many guests there are and how often they come.
class Listener {
public:
    /// Takes over a listening acceptor.
    Listener(Service service, boost::asio::ip::tcp::acceptor acceptor);
    ~Listener();

    /// Callbacks for the sand thread. Each hands its call over to the streaming thread.
    [[nodiscard]] SandThread::Output output();
    /// Masters are taken in from now on.
    void serve(SandThread& sandThread);
    /// Says goodbye to the master and stops listening; stops the io context when that has arrived, or after 0.6 s.
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
