// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "base/byte_stream.hpp"

/// Functions of OpenSSL that the link uses. The module sandwall-security.so provides them, so that a program without a
/// secret and without TLS never loads OpenSSL.
namespace haptic_bridge {

using ByteSpan = std::span<const std::uint8_t>;

/// The session does not check the certificate of the other end, because the other end must prove a secret over
/// binding().
class TlsSession {
public:
    virtual ~TlsSession() = default;
    TlsSession() = default;
    TlsSession(const TlsSession&) = delete;
    TlsSession& operator=(const TlsSession&) = delete;

    /// Takes `bytes` from the other end. Appends the decrypted bytes to `plain`, and the bytes that must be sent to
    /// `reply`. Throws std::runtime_error with the reason if the TLS connection fails. The session is then of no
    /// further use, and `reply` holds the alert for the other end.
    virtual void receive(ByteSpan bytes, base::Bytes& plain, base::Bytes& reply) = 0;
    /// Appends the first bytes of a client to `reply`.
    virtual void begin(base::Bytes& reply) = 0;
    /// Encrypts `plain` and appends the result to `sealed`. Only after the handshake. Throws std::runtime_error if the
    /// connection cannot send.
    virtual void seal(ByteSpan plain, base::Bytes& sealed) = 0;
    /// Returns whether the TLS handshake is complete.
    [[nodiscard]] virtual bool established() const = 0;
    /// Returns 32 bytes that only the two ends of this connection share (tls-exporter, RFC 9266). Only after the
    /// handshake.
    [[nodiscard]] virtual base::Bytes binding() const = 0;
};

/// Factory of TLS sessions. It accepts only TLS 1.3. Any thread may use it.
class TlsContext {
public:
    virtual ~TlsContext() = default;
    TlsContext() = default;
    TlsContext(const TlsContext&) = delete;
    TlsContext& operator=(const TlsContext&) = delete;
    [[nodiscard]] virtual std::unique_ptr<TlsSession> open() const = 0;
};

/// Functions of the security module. Any thread may call them.
class Security {
public:
    virtual ~Security() = default;
    Security() = default;
    Security(const Security&) = delete;
    Security& operator=(const Security&) = delete;

    /// Fills `bytes` with random bytes. Throws std::runtime_error if the system has none.
    virtual void random(std::span<std::uint8_t> bytes) const = 0;
    [[nodiscard]] virtual std::array<std::uint8_t, 32> hmacSha256(ByteSpan key, ByteSpan message) const = 0;
    /// Compares two byte strings. The time does not depend on where they differ.
    [[nodiscard]] virtual bool equal(ByteSpan one, ByteSpan other) const = 0;
    /// Returns the context of a server with these PEM files. If both names are empty, makes a certificate now. Throws
    /// std::runtime_error with a reason if the files cannot be used.
    [[nodiscard]] virtual std::unique_ptr<TlsContext> tlsServer(const std::string& certificate,
                                                                const std::string& key) const = 0;
    [[nodiscard]] virtual std::unique_ptr<TlsContext> tlsClient() const = 0;
};

/// Name of the function that the module defines, with C linkage. It returns one object that is never deleted.
inline constexpr const char* kSecuritySymbol = "sandwallSecurity1";
using GetSecurity = const Security*();

/// Loads sandwall-security.so from the folder of this program. Returns the same object at every call. Throws
/// base::InputError that begins with `option` if the module is missing.
[[nodiscard]] const Security& loadSecurity(std::string_view option);

}  // namespace haptic_bridge
