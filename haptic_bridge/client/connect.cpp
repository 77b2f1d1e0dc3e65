// SPDX-License-Identifier: Apache-2.0
// The master's end of the link: connecting, ending and trying again.
#include <fmt/format.h>

#include <utility>

#include "haptic_bridge/client/connection_thread.hpp"
#include "host/clock.hpp"

namespace haptic_bridge {

void Client::Conversation::connect() {
    if (stopping_) {  // the retry was already due when stop() cancelled it
        return;
    }
    connector_.connect(address_, {[this](Connection::Socket socket) { connected(std::move(socket)); },
                                  [this](const std::string& why) { failed(why); }});
}

void Client::Conversation::connected(Connection::Socket socket) {
    connection_ = std::make_shared<Connection>(std::move(socket), greeter_.openTls());
    connection_->limit(kMaxGreeting);
    greeter_.forget();
    drill_.forget();
    grant_.reset();
    loaded_ = 0;
    shelf.dropTests();
    silence_.start([this] { return shelf.full(); }, [this] { fallSilent(); });
    connection_->start({[this](Message&& message) { receive(std::move(message)); },
                        [this](const std::string& why, Connection::Fault fault) {
                            fault ? refuse("closed, " + why, fault) : closed(why);
                        },
                        false, [this] { greet(); }});
}

void Client::Conversation::failed(const std::string& why) {
    shelf.fail(fmt::format("no answer ({})", why));
    shelf.setStatus(shelf.counters().links > 0 ? Link::lost : Link::connecting,
                    fmt::format("haptic server {} does not answer ({}); trying again", address_.text(), why));
    retry();
}

void Client::Conversation::closed(const std::string& why) {
    const Link before = shelf.link();
    if (stopping_) {
        io_.stop();
        return;
    }
    if (isUp(before)) {
        if (before == Link::linked || before == Link::streaming) {
            retryPause_.lost(host::monotonicNs());
        }
        shelf.setStatus(Link::lost, fmt::format("{}: link lost, {}; trying again", peer(), why));
    } else if (before == Link::loading) {
        retryPause_.lost(host::monotonicNs());
        shelf.fail(why);
        shelf.setStatus(shelf.counters().links > 0 ? Link::lost : Link::connecting,
                        fmt::format("{}: {}; connecting again", peer(), why));
    } else if (before != Link::refused) {
        failed(why);
        return;
    }
    retry();
}

void Client::Conversation::countRefusal(RefusalCode code) {
    shelf.count([code](LinkCounters& counters) { ++counters.refused[static_cast<std::size_t>(code) - 1]; });
}

void Client::Conversation::refuse(const std::string& why, Connection::Fault fault) {
    shelf.fail(why);
    if (fault) {
        countRefusal(*fault);
    }
    shelf.setStatus(Link::refused, fmt::format("{}: {}", peer(), why));
    retryPause_.lengthen();
    if (stopping_) {
        io_.stop();
        return;
    }
    retry();
}

void Client::Conversation::retry() {
    if (connection_) {
        const auto gone = std::exchange(connection_, nullptr);
        gone->finish();
    }
    pings_.cancel();
    silence_.cancel();
    if (!stopping_) {
        retryPause_.start([this] { connect(); });
    }
}

}  // namespace haptic_bridge
