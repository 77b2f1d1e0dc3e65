// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/link/link_options.hpp"

#include <string_view>

#include "base/input_error.hpp"
#include "host/command_line.hpp"
#include "host/regular_file.hpp"

namespace haptic_bridge {
namespace {

LinkSecurity withSecrets(const LinkOptions& options) {
    LinkSecurity security;
    if (!options.secretFile.empty()) {
        security.secrets = readSecrets(options.secretFile);
        security.functions = &loadSecurity("--secret-file");
    } else if (options.tls) {
        throw base::InputError("--tls: needs --secret-file, which detects an attacker in between");
    }
    return security;
}

/// Throws base::InputError if the certificate cannot be read. The file may also hold the key, and must then be private.
void requireCertificate(const std::string& file) {
    constexpr std::size_t kMostBytes = 1 << 20;  // of a chain of certificates, some kilobytes each
    const host::RegularFile opened(file);
    requireOpen(opened, file, "--tls-cert");
    const auto bytes = opened.read(kMostBytes);
    if (!bytes) {
        throw base::InputError(file + ": cannot be read; check the disk");
    }
    const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    if (text.find("PRIVATE KEY-----") != std::string_view::npos) {
        requirePrivate(opened, file, "--tls-cert", "key");
    }
}

}  // namespace

void LinkOptions::addTo(host::CommandLine& line, bool server) {
    line.option("--secret-file", secretFile,
                "file of lines ROLE SECRET, the same for both ends of the haptic link; docs/security.md")
        .metavar("FILE")
        .offeredBy({"run"});
    line.flag("--tls", tls, "TLS 1.3 on the haptic link; needs --secret-file").offeredBy({"run"});
    if (server) {
        line.option("--tls-cert", certificate,
                    "PEM file with a certificate; without it the server makes one at the start");
        line.option("--tls-key", key, "PEM file with the key of the certificate");
    }
}

LinkSecurity LinkOptions::forServer() const {
    LinkSecurity security = withSecrets(*this);
    if (certificate.empty() != key.empty() || (!tls && !certificate.empty())) {
        throw base::InputError("--tls-cert and --tls-key: give both or neither, and --tls with them");
    }
    if (!key.empty()) {
        requirePrivate(host::RegularFile(key), key, "--tls-key", "key");
        requireCertificate(certificate);
    }
    try {
        security.tls = tls ? security.functions->tlsServer(certificate, key) : nullptr;
    } catch (const std::runtime_error& error) {
        throw base::InputError(std::string("--tls: ") + error.what());
    }
    return security;
}

LinkSecurity LinkOptions::forClient(Role role) const {
    LinkSecurity security = withSecrets(*this);
    if (security.proves() && !security.secrets.of(role)) {
        throw base::InputError(secretFile + ": holds no secret of role " + std::string(base::nameOf(role)) +
                               ", which this program needs");
    }
    security.tls = tls ? security.functions->tlsClient() : nullptr;
    return security;
}

void requireSecret(const Address& address, const LinkSecurity& security, const std::string& option) {
    boost::system::error_code name;
    const auto literal = boost::asio::ip::make_address(address.host, name);
    if (!security.proves() && !name && !isLoopback(literal)) {
        throw base::InputError(option + ": " + address.text() +
                               " is another machine, and a link over a network needs --secret-file on both sides "
                               "(docs/security.md)");
    }
}

bool isLoopback(const boost::asio::ip::address& address) {
    if (address.is_v6() && address.to_v6().is_v4_mapped()) {
        return boost::asio::ip::make_address_v4(boost::asio::ip::v4_mapped, address.to_v6()).is_loopback();
    }
    return address.is_loopback();
}

}  // namespace haptic_bridge
