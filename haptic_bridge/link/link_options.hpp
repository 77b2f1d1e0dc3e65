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

/// What a user says about who may come in, in every program of the link.
struct LinkOptions {
    std::string secretFile;
    bool tls = false;
    std::string certificate, key;  // of a server; empty: made at every start

    /// Adds the options of either end; a server has two more.
    void addTo(host::CommandLine& line, bool server);

    /// Loads the module where it is needed. Throws base::InputError.
    [[nodiscard]] LinkSecurity forServer() const;
    [[nodiscard]] LinkSecurity forClient(Role role) const;
};

/// Throws base::InputError that begins with `option` for the address of another machine and no secret. Names are
/// looked up later, by whoever connects.
void requireSecret(const Address& address, const LinkSecurity& security, const std::string& option);

/// Addresses of this machine alone, IPv4 ones written as IPv6 too.
[[nodiscard]] bool isLoopback(const boost::asio::ip::address& address);

}  // namespace haptic_bridge
