// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "haptic_bridge/link/protocol.hpp"

namespace haptic_bridge {

/// Cuts a stream of bytes into messages. Keeps a partial message until the rest of it arrives.
class MessageReader {
public:
    void feed(std::span<const std::uint8_t> bytes);
    /// Returns the next whole message; nullopt if it has not arrived yet. Throws base::FormatError if a length is out
    /// of bounds or the bytes are not a message. The link must then be closed.
    [[nodiscard]] std::optional<Message> next();
    /// Sets whether a State may come next, of up to `most` bytes.
    void expectState(bool expected, std::size_t most = kMaxState) {
        stateExpected_ = expected;
        mostState_ = most;
    }
    /// Sets whether an EditRequest that loads sand, of up to `most` bytes, may come.
    void expectLoads(bool expected, std::size_t most = kMaxState) {
        loadsExpected_ = expected;
        mostLoad_ = most;
    }
    /// Sets the largest length of an ordinary message from now on [byte]; kMaxMessage at first.
    void limit(std::size_t most) { most_ = most; }
    /// Returns whether the stream ends in the middle of a message.
    [[nodiscard]] bool midMessage() const { return begin_ < buffer_.size(); }
    /// Returns the memory that the reader holds [byte]. It holds no long message that next() has returned.
    [[nodiscard]] std::size_t bytes() const { return buffer_.capacity(); }

private:
    void freeLongMessage();
    /// Returns the largest length of a message of `type`.
    [[nodiscard]] std::size_t mostOf(std::uint8_t type) const;
    /// Returns the largest length of a message of any type.
    [[nodiscard]] std::size_t mostLength() const;

    base::Bytes buffer_;
    std::size_t begin_ = 0, most_ = kMaxMessage, mostState_ = kMaxState, mostLoad_ = kMaxState;
    bool stateExpected_ = false, loadsExpected_ = false;
};

}  // namespace haptic_bridge
