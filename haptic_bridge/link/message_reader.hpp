// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "haptic_bridge/link/protocol.hpp"

namespace haptic_bridge {

/// Cuts a stream of bytes into messages; keeps half a message until the rest arrives.
class MessageReader {
public:
    void feed(std::span<const std::uint8_t> bytes);
    /// The next whole message, or nothing yet. Throws base::FormatError for a stream that is no such stream (a length
    /// beyond the bounds, garbage), after which the link must be closed.
    [[nodiscard]] std::optional<Message> next();
    /// A State may come next, up to kMaxState long.
    void expectState(bool expected) { stateExpected_ = expected; }
    /// Sand to be loaded may come, in messages up to kMaxState long.
    void expectLoads(bool expected) { loadsExpected_ = expected; }
    /// Ordinary messages may be this long from now on [byte]; at first kMaxMessage.
    void limit(std::size_t most) { most_ = most; }
    /// Whether the stream stands in the middle of a message.
    [[nodiscard]] bool midMessage() const { return begin_ < buffer_.size(); }

private:
    [[nodiscard]] bool mayBeLong(std::uint8_t type) const;

    base::Bytes buffer_;
    std::size_t begin_ = 0, most_ = kMaxMessage;
    bool stateExpected_ = false, loadsExpected_ = false;
};

}  // namespace haptic_bridge
