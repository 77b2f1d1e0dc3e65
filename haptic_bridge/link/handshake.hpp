// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "haptic_bridge/link/secret_file.hpp"
#include "haptic_bridge/link/security.hpp"

namespace haptic_bridge {

/// How this end of the link proves who it is, and whether it speaks TLS; the default does neither. Copies share.
struct LinkSecurity {
    const Security* functions = nullptr;  // there is a secret
    Secrets secrets;
    std::shared_ptr<const TlsContext> tls;  // null: plain TCP
    [[nodiscard]] bool proves() const { return functions != nullptr; }
};

/// The proof that one side gives the other: a MAC over all that both have said, under the role's secret. `binding` is
/// TlsSession::binding(), empty over plain TCP.
struct Transcript {
    Hello hello;
    Challenge challenge;
    base::Bytes binding;
    enum class Side : std::uint8_t { master, server };
    [[nodiscard]] MacBytes mac(const Security& functions, const std::string& secret, Side side) const;
};

/// The master's half of the greeting, or a watcher's. Knows no socket.
class MasterHandshake {
public:
    /// `security` outlives this.
    MasterHandshake(const LinkSecurity& security, const Identity& identity, Role role, base::Bytes binding);

    [[nodiscard]] const Hello& hello() const { return transcript_.hello; }
    /// Nothing when this challenge must not be answered: because().
    [[nodiscard]] std::optional<Proof> answer(const Challenge& challenge);
    /// Whether the server has shown what it must; if not: because().
    [[nodiscard]] bool accepts(const Welcome& welcome);
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

/// The server's half. Knows no socket.
class ServerHandshake {
public:
    explicit ServerHandshake(const LinkSecurity& security) : security_(security) {}

    /// Whether somebody with this greeting may go on; identities were compared before.
    [[nodiscard]] std::optional<Refusal> refusalFor(const Hello& hello, bool overTls) const;
    /// What the guest must answer before it is welcome; nothing when no secret is asked for.
    [[nodiscard]] std::optional<Challenge> challenge(const Hello& hello, const Identity& server, base::Bytes binding);
    [[nodiscard]] bool accepts(const Proof& proof) const;
    /// For the Welcome: zeros without a secret.
    [[nodiscard]] MacBytes mac() const;

private:
    [[nodiscard]] const std::string& secret() const { return *security_.secrets.of(transcript_.hello.role); }

    const LinkSecurity& security_;
    Transcript transcript_;
};

}  // namespace haptic_bridge
