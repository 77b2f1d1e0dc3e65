// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/listener.hpp"

#include <boost/asio/post.hpp>
#include <utility>

#include "haptic_bridge/server/peer.hpp"
#include "host/clock.hpp"

namespace haptic_bridge {

namespace asio = boost::asio;
using boost::system::error_code;

Listener::Listener(Service service, asio::ip::tcp::acceptor acceptor)
    : service_(std::move(service)),
      acceptor_(std::move(acceptor)),
      pause_(service_.io),
      gate_(std::make_unique<Gate>(service_.log)),
      roster_(std::make_unique<Roster<Peer>>()) {}

Listener::~Listener() = default;

SandThread::Output Listener::output() {
    // Calls for a session that has ended meanwhile are dropped.
    const auto hand = [this](std::uint32_t session, auto act) {
        asio::post(service_.io, [this, session, act = std::move(act)]() mutable {
            if (const auto master = roster_->master(); master && master->session() == session) {
                act(*master);
            }
        });
    };
    return {
        [hand](std::uint32_t session) { hand(session, [](Peer& peer) { peer.ready(); }); },
        [hand](std::uint32_t session, NeedState need) { hand(session, [need](Peer& peer) { peer.needState(need); }); },
        [hand](std::uint32_t session, std::string why) {
            hand(session, [why = std::move(why)](Peer& peer) { peer.unusable(why); });
        },
        [hand](std::uint32_t session, base::Bytes message, std::uint64_t edit) {
            hand(session,
                 [message = std::move(message), edit](Peer& peer) mutable { peer.step(std::move(message), edit); });
        },
        [hand](std::uint32_t session, Audited result) {
            hand(session, [result](Peer& peer) { peer.audited(result); });
        }};
}

void Listener::serve(SandThread& sandThread) {
    service_.sandThread = &sandThread;
    accept();
}

void Listener::answerLoading(std::chrono::milliseconds quiet) {
    pause_.expires_after(quiet);
    pause_.async_wait([this](error_code cancelled) {
        if (!cancelled && !shutting_) {
            accept();
        }
    });
}

asio::ip::tcp::acceptor Listener::endLoading() {
    shutting_ = true;
    pause_.cancel();
    error_code ignored;
    acceptor_.cancel(ignored);
    for (const auto& peers : {roster_->unauthenticated(), roster_->watchers()}) {
        for (const auto& peer : peers) {
            peer->endLoading();
        }
    }
    return std::move(acceptor_);
}

void Listener::accept() {
    acceptor_.async_accept([this](error_code error, Connection::Socket socket) {
        if (shutting_) {
            return;
        }
        if (error) {  // out of file descriptors, or the peer has already gone: try again a little later
            pause_.expires_after(std::chrono::milliseconds(100));
            pause_.async_wait([this](error_code cancelled) {
                if (!cancelled) {
                    accept();
                }
            });
            return;
        }
        try {
            admit(std::move(socket));
        } catch (const std::exception& failure) {  // for example, no memory for TLS
            service_.log(std::string("an unauthenticated connection cannot be answered: ") + failure.what());
        }
        accept();
    });
}

void Listener::admit(Connection::Socket socket) {
    error_code gone;
    const asio::ip::address address = socket.remote_endpoint(gone).address();
    if (gone) {
        return;
    }
    const std::int64_t now = host::monotonicNs();
    if (!gate_->mayCome(address, now)) {
        gate_->refused(RefusalCode::limit, address, "connects too often, and is not answered for a while", now);
    } else if (!roster_->hasRoomFor(address)) {
        gate_->refused(RefusalCode::limit, address,
                       "is one of too many unauthenticated connections, and is not answered", now);
    } else {
        const auto connection = std::make_shared<Peer>(service_, *gate_, *roster_, std::move(socket));
        roster_->add(connection);
        connection->start();
    }
}

void Listener::shut(const std::string& reason) {
    shutting_ = true;
    error_code ignored;
    acceptor_.close(ignored);
    std::weak_ptr<Connection> last;
    for (const auto& connection : roster_->unauthenticated()) {
        connection->makeRoom();
    }
    for (const auto& watcher : roster_->watchers()) {
        watcher->sendGoodbye(reason);
    }
    if (const auto master = roster_->master()) {
        last = master->connection();
        master->sendGoodbye(reason);
    }
    stopWhenGone(last, 60);
}

void Listener::stopWhenGone(const std::weak_ptr<Connection>& last, int polls) {
    if (last.expired() || polls == 0) {
        service_.io.stop();
        return;
    }
    pause_.expires_after(std::chrono::milliseconds(10));
    pause_.async_wait([this, last, polls](error_code error) {
        if (!error) {
            stopWhenGone(last, polls - 1);
        }
    });
}

}  // namespace haptic_bridge
