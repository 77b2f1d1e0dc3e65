// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <string>

namespace haptic_bridge {

/// Listens at `text`, "ADDRESS:PORT"; port 0 takes any free one. Throws base::InputError that begins with --listen if
/// the address cannot be used. Also throws if other machines can reach the address and `secret` is false.
[[nodiscard]] boost::asio::ip::tcp::acceptor listenAt(boost::asio::io_context& io, const std::string& text,
                                                      bool secret);

/// Writes the port's number to `file`, unless `file` is empty. It writes another file and renames it, so that a reader
/// never sees half a number. Throws base::InputError, which names `option`, if the file cannot be written.
void writePortFile(const std::string& option, const std::string& file, std::uint16_t port);

}  // namespace haptic_bridge
