// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/link/address.hpp"

#include <charconv>

#include "base/input_error.hpp"

namespace haptic_bridge {

Address Address::parse(std::string_view text, std::string_view option) {
    const auto fail = [&](const std::string& what) {
        throw base::InputError(std::string(option) + ": '" + std::string(text) + "' " + what +
                               "; write HOST:PORT, such as 127.0.0.1:" + std::to_string(kDefaultPort));
    };
    Address address;
    std::string_view port;
    if (text.starts_with('[')) {
        const auto end = text.find(']');
        if (end == std::string_view::npos || (end + 1 < text.size() && text[end + 1] != ':')) {
            fail("is not an address");
        }
        address.host = text.substr(1, end - 1);
        port = text.substr(end + 1);
    } else {
        const auto colon = text.find(':');
        address.host = text.substr(0, colon);
        port = colon == std::string_view::npos ? std::string_view{} : text.substr(colon);
    }
    if (address.host.empty()) {
        fail("names no host");
    }
    if (!port.empty()) {
        port.remove_prefix(1);
        const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), address.port);
        if (error != std::errc{} || end != port.data() + port.size()) {
            fail("has no port from 0 to 65535");
        }
    }
    return address;
}

std::string Address::text() const {
    const bool six = host.find(':') != std::string::npos;
    return (six ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

}  // namespace haptic_bridge
