// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/ip/address.hpp>
#include <string>

#include "haptic_bridge/client.hpp"
#include "haptic_bridge/handshake.hpp"

namespace haptic_bridge {

/// What a user says about who may come in, in every program of the link.
struct LinkOptions {
    std::string secretFile;
    bool tls = false;
    std::string certificate, key;  // of a server; empty: made at every start

    /// Options are added by whoever parses: addSecretFile and addTls take a CLI::App, which is not named here because
    /// it takes long to compile.
    template <class App>
    void addTo(App& app, bool server) {
        app.add_option("--secret-file", secretFile, "lines ROLE SECRET that both sides know (docs/security.md)");
        app.add_flag("--tls", tls, "TLS 1.3 on the haptic link; needs --secret-file");
        if (server) {
            app.add_option("--tls-cert", certificate, "PEM file, instead of a certificate made at the start");
            app.add_option("--tls-key", key, "PEM file of its key");
        }
    }

    /// Loads the module where it is needed. Throws files::InputError.
    [[nodiscard]] LinkSecurity forServer() const;
    [[nodiscard]] LinkSecurity forClient(Role role) const;
};

/// Throws files::InputError that begins with `option` for the address of another machine and no secret. Names are
/// looked up later, by whoever connects.
void requireSecret(const Address& address, const LinkSecurity& security, const std::string& option);

/// Addresses of this machine alone, IPv4 ones written as IPv6 too.
[[nodiscard]] bool isLoopback(const boost::asio::ip::address& address);

}  // namespace haptic_bridge
