// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "haptic_bridge/link/protocol.hpp"

namespace haptic_bridge {

/// What somebody knows who may connect, by role.
struct Secrets {
    std::optional<std::string> move, watch;
    [[nodiscard]] const std::optional<std::string>& of(Role role) const { return role == Role::move ? move : watch; }
    [[nodiscard]] bool any() const { return move || watch; }
};

inline constexpr std::size_t kMinSecret = 16;        // [byte]
inline constexpr std::size_t kMaxSecret = 256;       // [byte]
inline constexpr std::size_t kMaxSecretFile = 4096;  // [byte]

/// Reads lines "ROLE SECRET", ROLE move or watch, each once at most; empty lines and those that begin with # say
/// nothing. The secret's characters, as they stand, are the key. Throws base::InputError with `file` and the line, and
/// never with a secret in it.
[[nodiscard]] Secrets parseSecrets(std::string_view text, const std::string& file);

/// Throws base::InputError also for what is no regular file, or may be read by anybody but its owner.
[[nodiscard]] Secrets readSecrets(const std::string& file);

}  // namespace haptic_bridge
