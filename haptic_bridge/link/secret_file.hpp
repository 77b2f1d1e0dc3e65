// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "haptic_bridge/link/protocol.hpp"

namespace haptic_bridge {

/// Secrets by role. A peer must know the secret of its role.
struct Secrets {
    std::optional<std::string> move, watch;
    [[nodiscard]] const std::optional<std::string>& of(Role role) const { return role == Role::move ? move : watch; }
    [[nodiscard]] bool any() const { return move || watch; }
};

inline constexpr std::size_t kMinSecret = 16;        // [byte]
inline constexpr std::size_t kMaxSecret = 256;       // [byte]
inline constexpr std::size_t kMaxSecretFile = 4096;  // [byte]

/// Reads lines of the form "ROLE SECRET". ROLE is move or watch, and each may occur once. Empty lines and lines that
/// begin with # are ignored. The characters of the secret are the key, without decoding. Throws base::InputError with
/// `file` and the line; its text never contains a secret.
[[nodiscard]] Secrets parseSecrets(std::string_view text, const std::string& file);

/// Reads the secrets in `file`. Throws base::InputError also if `file` is not a regular file, or if other users than
/// its owner may read or change it.
[[nodiscard]] Secrets readSecrets(const std::string& file);

}  // namespace haptic_bridge
