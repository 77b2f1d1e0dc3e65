// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "haptic_bridge/link/protocol.hpp"

namespace host {
class RegularFile;
}

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

/// Throws base::InputError if `opened`, the file that `option` names, is not open.
void requireOpen(const host::RegularFile& opened, const std::string& file, const std::string& option);
/// Throws base::InputError as requireOpen() does, and if the file belongs to another user, or is one that other users
/// may read or change. `thing` is what the file holds, such as "secret".
void requirePrivate(const host::RegularFile& opened, const std::string& file, const std::string& option,
                    const std::string& thing);

/// Reads the secrets in `file`. From then on this process makes no core dumps. Throws base::InputError also as
/// requirePrivate() does.
[[nodiscard]] Secrets readSecrets(const std::string& file);

}  // namespace haptic_bridge
