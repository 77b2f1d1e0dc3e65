// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/ip/address.hpp>
#include <string>

#include "haptic_bridge/link/address.hpp"
#include "haptic_bridge/link/handshake.hpp"

namespace host {
class CommandLine;
}

namespace haptic_bridge {

/// Options for secrets and TLS, the same in every program of the link.
struct LinkOptions {
    std::string secretFile;
    bool tls = false;
    std::string certificate, key;  // PEM files of a server; empty: it makes a certificate at every start

    /// Adds these options to `line`. A server has two options more: certificate and key.
    void addTo(host::CommandLine& line, bool server);

    /// Returns the security of a server. Loads the security module if it is needed. Throws base::InputError.
    [[nodiscard]] LinkSecurity forServer() const;
    /// Returns the security of a client with `role`. Loads the security module if it is needed. Throws
    /// base::InputError.
    [[nodiscard]] LinkSecurity forClient(Role role) const;
};

/// Throws base::InputError that begins with `option` if `address` is an IP address of another machine and there is no
/// secret. Host names are not resolved here; the connection checks their addresses later.
void requireSecret(const Address& address, const LinkSecurity& security, const std::string& option);

/// Returns whether `address` is a loopback address, which only this machine can reach. An IPv4 address may also be
/// written as IPv6.
[[nodiscard]] bool isLoopback(const boost::asio::ip::address& address);

}  // namespace haptic_bridge
