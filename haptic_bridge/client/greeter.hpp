// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <boost/asio/ip/address.hpp>
#include <memory>
#include <optional>
#include <utility>

#include "haptic_bridge/client/client.hpp"
#include "haptic_bridge/link/handshake.hpp"
#include "haptic_bridge/link/link_options.hpp"

namespace haptic_bridge {

/// The master's greeting on one connection after another. Used by one thread.
class Greeter {
public:
    Greeter(Offer offer, LinkSecurity security)
        : identity_{kProtocolVersion, sand::kAlgorithmVersion, offer.rulesDigest, std::move(offer.sceneName)},
          security_(std::move(security)) {}

    /// Returns the TLS for a new connection; null without TLS.
    [[nodiscard]] std::unique_ptr<TlsSession> openTls() const {
        return security_.tls ? security_.tls->open() : nullptr;
    }
    /// Returns whether the master greets a server at this address. Without a secret it greets only its own machine.
    [[nodiscard]] bool greets(const boost::asio::ip::address& server) const {
        return security_.proves() || isLoopback(server);
    }
    /// Begins the handshake. Returns its first message.
    [[nodiscard]] Hello greet(base::Bytes binding) {
        handshake_.emplace(security_, identity_, Role::move, std::move(binding));
        return handshake_->hello();
    }
    /// Forgets the handshake of a connection that is gone.
    void forget() { handshake_.reset(); }
    /// Returns whether this connection has begun its handshake. The functions below may be called only then.
    [[nodiscard]] bool greeted() const { return handshake_.has_value(); }

    /// Returns the proof that answers `challenge`; nullopt if it must not be answered, see because().
    [[nodiscard]] std::optional<Proof> answer(const Challenge& challenge) { return handshake_->answer(challenge); }
    /// Returns why the master refuses the server of this greeting; nullopt if it accepts it.
    ///
    /// The server compares the identities as well. The client does not rely on that, because the wall must not show
    /// other sand than the hand feels.
    [[nodiscard]] std::optional<Refusal> refusalOf(const Welcome& welcome) {
        if (auto refusal = refusalFor(welcome.server, identity_)) {
            return refusal;
        }
        return handshake_->accepts(welcome) ? std::nullopt : std::optional(because());
    }
    [[nodiscard]] bool accepts(const Loading& loading) { return handshake_->accepts(loading); }
    [[nodiscard]] bool accepts(const PositionGreeting& greeting) { return handshake_->accepts(greeting); }
    [[nodiscard]] const Refusal& because() const { return handshake_->because(); }

private:
    const Identity identity_;
    const LinkSecurity security_;
    std::optional<MasterHandshake> handshake_;  // refers to security_
};

}  // namespace haptic_bridge
