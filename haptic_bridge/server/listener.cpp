// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/listener.hpp"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <utility>

#include "haptic_bridge/link/link_options.hpp"
#include "haptic_bridge/server/peer.hpp"
#include "host/clock.hpp"

namespace haptic_bridge {

namespace asio = boost::asio;
using boost::system::error_code;

Listener::Listener(asio::io_context& io, asio::ip::tcp::acceptor acceptor, Identity identity,
                   std::uint32_t stepsPerSecond, Sources sources, TimingTests tests, LinkSecurity security)
    : io_(io),
      acceptor_(std::move(acceptor)),
      pause_(io),
      identity_(std::move(identity)),
      stepsPerSecond_(stepsPerSecond),
      sources_(std::move(sources)),
      tests_(tests),
      security_(std::move(security)) {}

Listener::~Listener() = default;

std::shared_ptr<Peer> Listener::linked(std::uint32_t session) const {
    return current_ && current_->session() == session ? current_ : nullptr;
}

SandThread::Output Listener::output() {
    // What comes for a session that has ended meanwhile is for nobody.
    const auto hand = [this](std::uint32_t session, auto act) {
        asio::post(io_, [this, session, act = std::move(act)]() mutable {
            if (const auto peer = linked(session)) {
                act(*peer);
            }
        });
    };
    return {
        [hand](std::uint32_t session) { hand(session, [](Peer& peer) { peer.ready(); }); },
        [hand](std::uint32_t session, NeedState need) { hand(session, [need](Peer& peer) { peer.needState(need); }); },
        [hand](std::uint32_t session, std::string why) {
            hand(session, [why = std::move(why)](Peer& peer) { peer.unusable(why); });
        },
        [hand](std::uint32_t session, base::Bytes message) {
            hand(session, [message = std::move(message)](Peer& peer) mutable { peer.step(std::move(message)); });
        }};
}

void Listener::serve(SandThread& sandThread) {
    sandThread_ = &sandThread;
    accept();
}

void Listener::accept() {
    acceptor_.async_accept([this](error_code error, Connection::Socket socket) {
        if (shutting_) {
            return;
        }
        if (error) {  // out of descriptors, or the peer has gone again: try a little later
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
        } catch (const std::exception& failure) {  // no memory for TLS, say
            sources_.log(std::string("a guest cannot be answered: ") + failure.what());
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
    if (!limits_.mayCome(address, host::monotonicNs())) {
        refused(RefusalCode::limit, address, "comes too often, and is not answered for a while");
        return;
    }
    if (tooManyOf(address) || *connections_ >= kMaxConnections) {
        refused(RefusalCode::limit, address, "is one of too many that have not greeted, and is not answered");
        return;
    }
    if (guests_.size() >= kMaxGuests) {
        // Not the newcomer: sixteen who say nothing would keep out the master. A greeting takes milliseconds.
        guests_.front()->makeRoom();
    }
    guests_.push_back(std::make_shared<Peer>(*this, std::move(socket)));
    std::shared_ptr(guests_.back())->start();
}

bool Listener::tooManyOf(const asio::ip::address& address) const {
    const auto same = std::count_if(guests_.begin(), guests_.end(), [guest = guestOf(address)](const auto& one) {
        return guestOf(one->address()) == guest;
    });
    return same >= kMaxGuestsOfOne && !isLoopback(address);
}

void Listener::refused(RefusalCode code, const asio::ip::address& address, const std::string& line) {
    const std::int64_t now = host::monotonicNs();
    if (code != RefusalCode::limit && code != RefusalCode::busy) {
        limits_.refused(address, now);
    }
    if (line.empty()) {
        refusals_.count(code);
    } else if (const auto text =
                   refusals_.add(code, guestOf(address).to_string(), address.to_string() + ": " + line, now)) {
        sources_.log(*text);
    }
}

void Listener::guestWent(const Peer& guest) {
    std::erase_if(guests_, [&](const auto& one) { return one.get() == &guest; });
}

void Listener::shut(const std::string& reason) {
    shutting_ = true;
    error_code ignored;
    acceptor_.close(ignored);
    std::weak_ptr<Connection> last;
    for (const auto& guest : std::list(guests_)) {
        guest->makeRoom();
    }
    for (const auto& watcher : std::set(watchers_)) {
        watcher->sayGoodbye(reason);
    }
    if (current_) {
        last = current_->connection();
        current_->sayGoodbye(reason);
    }
    stopWhenGone(last, 60);
}

void Listener::stopWhenGone(const std::weak_ptr<Connection>& last, int polls) {
    if (last.expired() || polls == 0) {
        io_.stop();
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
