// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/link/security.hpp"
#include "host/module.hpp"

namespace haptic_bridge {
namespace {

const Security& load(std::string_view option) {
    void* const symbol = host::loadModule({.file = "sandwall-security.so",
                                           .symbol = kSecuritySymbol,
                                           .askedBy = std::string(option),
                                           .ifMissing = "build Sandwall with Debian's libssl-dev",
                                           .ifNotLoaded = "install Debian's libssl3 (Debian 13: libssl3t64)"});
    return *reinterpret_cast<GetSecurity*>(symbol)();
}

}  // namespace

const Security& loadSecurity(std::string_view option) {
    static const Security& security = load(option);
    return security;
}

}  // namespace haptic_bridge
