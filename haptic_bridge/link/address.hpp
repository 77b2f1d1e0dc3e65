// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "haptic_bridge/link/protocol.hpp"

namespace haptic_bridge {

/// Address at which a haptic server listens.
struct Address {
    std::string host;  // a name, an IPv4 address, or an IPv6 address without brackets
    std::uint16_t port = kDefaultPort;
    /// Reads "HOST:PORT", "HOST" or "[IPV6]:PORT". Throws base::InputError whose text begins with `option`.
    static Address parse(std::string_view text, std::string_view option);
    /// Returns "HOST:PORT", with brackets around an IPv6 address.
    [[nodiscard]] std::string text() const;
};

}  // namespace haptic_bridge
