// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "base/byte_stream.hpp"

/// What OpenSSL does for the link, as sandwall-security.so hands it out: a program that uses neither a secret nor TLS
/// maps no OpenSSL.
namespace haptic_bridge {

using ByteSpan = std::span<const std::uint8_t>;

/// One end of one TLS 1.3 connection, without a socket: bytes in, bytes out. One thread at a time.
///
/// The other end's certificate is not judged: whoever is there must prove a secret over binding().
class TlsSession {
public:
    virtual ~TlsSession() = default;
    TlsSession() = default;
    TlsSession(const TlsSession&) = delete;
    TlsSession& operator=(const TlsSession&) = delete;

    /// Takes what came from the other end; appends what it says to `plain`, and what must be sent to `reply`. Throws
    /// std::runtime_error that says why this is no such connection, after which it is of no use; `reply` then holds the
    /// alert for the other end.
    virtual void receive(ByteSpan bytes, base::Bytes& plain, base::Bytes& reply) = 0;
    /// Of a client: its first bytes.
    virtual void begin(base::Bytes& reply) = 0;
    /// Once established: appends what carries `plain`. Throws std::runtime_error when that cannot be, as before.
    virtual void seal(ByteSpan plain, base::Bytes& sealed) = 0;
    [[nodiscard]] virtual bool established() const = 0;
    /// Once established: the same 32 bytes at both ends of this connection and nowhere else (tls-exporter, RFC 9266).
    [[nodiscard]] virtual base::Bytes binding() const = 0;
};

/// Makes the ends of connections; TLS 1.3 and nothing older. Any thread.
class TlsContext {
public:
    virtual ~TlsContext() = default;
    TlsContext() = default;
    TlsContext(const TlsContext&) = delete;
    TlsContext& operator=(const TlsContext&) = delete;
    [[nodiscard]] virtual std::unique_ptr<TlsSession> open() const = 0;
};

/// The functions of the module. Any thread.
class Security {
public:
    virtual ~Security() = default;
    Security() = default;
    Security(const Security&) = delete;
    Security& operator=(const Security&) = delete;

    /// Throws std::runtime_error when the system has no random bytes.
    virtual void random(std::span<std::uint8_t> bytes) const = 0;
    [[nodiscard]] virtual std::array<std::uint8_t, 32> hmacSha256(ByteSpan key, ByteSpan message) const = 0;
    /// Takes the same time wherever they differ.
    [[nodiscard]] virtual bool equal(ByteSpan one, ByteSpan other) const = 0;
    /// Throws std::runtime_error with words when the PEM files cannot be used; both empty: a certificate made now.
    [[nodiscard]] virtual std::unique_ptr<TlsContext> tlsServer(const std::string& certificate,
                                                                const std::string& key) const = 0;
    [[nodiscard]] virtual std::unique_ptr<TlsContext> tlsClient() const = 0;
};

/// What the module defines, with C linkage: the one object, never deleted.
inline constexpr const char* kSecuritySymbol = "sandwallSecurity1";
using GetSecurity = const Security*();

/// Loads sandwall-security.so from beside this program; the same object at every call. Throws base::InputError that
/// begins with `option` when it is missing.
[[nodiscard]] const Security& loadSecurity(const std::string& option);

}  // namespace haptic_bridge
