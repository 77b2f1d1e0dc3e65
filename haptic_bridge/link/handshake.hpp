// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "haptic_bridge/link/secret_file.hpp"
#include "haptic_bridge/link/security.hpp"

namespace haptic_bridge {

/// Returns the server's refusal of a master with another identity, with what the user should do; nullopt if both
/// identities are equal.
[[nodiscard]] std::optional<Refusal> refusalFor(const Identity& server, const Identity& master);
/// Compares only protocol and algorithm, which a server knows before its scene.
[[nodiscard]] std::optional<Refusal> refusalForVersions(const Identity& server, const Identity& master);

/// Secrets and TLS of one end of the link. The default has neither. Copies share the same TLS context.
struct LinkSecurity {
    const Security* functions = nullptr;  // null: this end has no secret
    Secrets secrets;
    std::shared_ptr<const TlsContext> tls;  // null: plain TCP
    [[nodiscard]] bool proves() const { return functions != nullptr; }
};

/// Everything that both sides have sent in the handshake. mac() signs it with the role's secret, as the proof of one
/// side. `binding` is TlsSession::binding(); it is empty over plain TCP.
struct Transcript {
    Hello hello;
    Challenge challenge;
    base::Bytes binding;
    enum class Side : std::uint8_t { master, server };
    /// Returns the MAC by which `side` proves that it knows `secret`.
    [[nodiscard]] MacBytes mac(const Security& functions, const std::string& secret, Side side) const;
};

/// The master's half of the handshake, or a watcher's. It does not use sockets.
class MasterHandshake {
public:
    /// `security` must outlive this object.
    MasterHandshake(const LinkSecurity& security, const Identity& identity, Role role, base::Bytes binding);

    [[nodiscard]] const Hello& hello() const { return transcript_.hello; }
    /// Returns the proof that answers `challenge`. Returns nullopt if it must not be answered; because() gives the
    /// reason.
    [[nodiscard]] std::optional<Proof> answer(const Challenge& challenge);
    /// Returns whether the server has proved the secret and granted the role. If it returns false, because() gives the
    /// reason.
    [[nodiscard]] bool accepts(const Welcome& welcome);
    /// Returns whether a server that reads its scene has proved the secret. If it returns false, because() gives the
    /// reason.
    [[nodiscard]] bool accepts(const Loading& loading);
    /// Returns whether a server without sand has proved the secret. If it returns false, because() gives the reason.
    [[nodiscard]] bool accepts(const PositionGreeting& greeting);
    [[nodiscard]] const Refusal& because() const { return because_; }

private:
    [[nodiscard]] bool refuse(RefusalCode code, std::string text);
    [[nodiscard]] bool proven(const Identity& server, const MacBytes& mac);

    const LinkSecurity& security_;
    Transcript transcript_;
    bool challenged_ = false;
    Refusal because_;
};

/// The server's half of the handshake. It does not use sockets.
class ServerHandshake {
public:
    explicit ServerHandshake(const LinkSecurity& security) : security_(security) {}

    /// Returns the reason to refuse a peer with this greeting; nullopt if it may continue. The caller has compared the
    /// identities before.
    [[nodiscard]] std::optional<Refusal> refusalFor(const Hello& hello, bool overTls) const;
    /// Returns the challenge that an unauthenticated connection must answer before the Welcome. Returns nullopt if this
    /// server has no secret.
    [[nodiscard]] std::optional<Challenge> challenge(const Hello& hello, const Identity& server, base::Bytes binding);
    /// Returns whether `proof` answers the challenge with the secret of the role.
    [[nodiscard]] bool accepts(const Proof& proof) const;
    /// Returns the MAC of the Welcome; zeros without a secret.
    [[nodiscard]] MacBytes mac() const;

private:
    [[nodiscard]] const std::string& secret() const { return *security_.secrets.of(transcript_.hello.role); }

    const LinkSecurity& security_;
    Transcript transcript_;
};

}  // namespace haptic_bridge
