// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <string>

namespace haptic_bridge {

/// Listens at "ADDRESS:PORT"; port 0 takes any free one. Throws base::InputError that begins with --listen when the
/// address cannot be had, or is one that others reach and there is no secret.
[[nodiscard]] boost::asio::ip::tcp::acceptor listenAt(boost::asio::io_context& io, const std::string& text,
                                                      bool secret);

/// Writes the port's number, unless `file` is empty. Written beside, then renamed: a reader sees no port, or the whole
/// of it. Throws base::InputError when the file cannot be written.
void writePortFile(const std::string& file, std::uint16_t port);

}  // namespace haptic_bridge
