// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/link/security.hpp"
#include "host/module.hpp"

namespace haptic_bridge {
namespace {

const Security& load(const std::string& option) {
    void* const symbol = host::loadModule({.file = "sandwall-security.so",
                                           .symbol = kSecuritySymbol,
                                           .askedBy = option,
                                           .ifMissing = "build Sandwall with Debian's libssl-dev",
                                           .ifNotLoaded = "install Debian's libssl3"});
    return *reinterpret_cast<GetSecurity*>(symbol)();
}

}  // namespace

const Security& loadSecurity(const std::string& option) {
    static const Security& security = load(option);
    return security;
}

}  // namespace haptic_bridge
