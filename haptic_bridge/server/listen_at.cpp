// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/listen_at.hpp"

#include "base/input_error.hpp"
#include "haptic_bridge/link/connection.hpp"
#include "haptic_bridge/link/link_options.hpp"
#include "host/whole_file.hpp"

namespace haptic_bridge {

namespace asio = boost::asio;

asio::ip::tcp::acceptor listenAt(asio::io_context& io, const std::string& text, bool secret) {
    const Address address = Address::parse(text, "--listen");
    boost::system::error_code error;
    const auto host = asio::ip::make_address(address.host == "localhost" ? "127.0.0.1" : address.host, error);
    if (error) {
        throw base::InputError("--listen: '" + address.host +
                               "' is not an IP address; write one such as 127.0.0.1, or "
                               "0.0.0.0 for every network");
    }
    if (!secret && !isLoopback(host)) {
        throw base::InputError("--listen " + text +
                               ": other machines can reach that address, so it needs --secret-file (docs/security.md); "
                               "127.0.0.1 needs none");
    }
    const asio::ip::tcp::endpoint endpoint(host, address.port);
    asio::ip::tcp::acceptor acceptor(io);
    acceptor.open(endpoint.protocol());
    acceptor.set_option(asio::socket_base::reuse_address(true));
    acceptor.bind(endpoint, error);
    if (!error) {
        acceptor.listen(asio::socket_base::max_listen_connections, error);
    }
    if (error == asio::error::address_in_use) {
        throw base::InputError("--listen " + textOf(endpoint) +
                               ": the port is in use; stop the program that has it, "
                               "or give another port (0 takes any free one)");
    }
    if (error) {
        throw base::InputError("--listen " + textOf(endpoint) + ": " + error.message());
    }
    return acceptor;
}

void writePortFile(const std::string& option, const std::string& file, std::uint16_t port) {
    if (file.empty()) {
        return;
    }
    try {
        host::WholeFile whole(file);
        whole.stream() << port << '\n';
        whole.keep();
    } catch (const base::InputError& error) {
        throw base::InputError(option + " " + error.what());
    }
}

}  // namespace haptic_bridge
