// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/link/message_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>
#include <utility>

namespace haptic_bridge {
namespace {

constexpr std::size_t kMaxKept = 1024 * 1024;  // [byte], largest capacity that a buffer keeps after a long message

template <class Kind>
constexpr std::uint8_t typeOf() {
    return []<std::size_t... index>(std::index_sequence<index...>) {
        std::uint8_t type = 0;
        ((std::is_same_v<Kind, std::variant_alternative_t<index, Message>> ? type = static_cast<std::uint8_t>(index + 1)
                                                                           : type),
         ...);
        return type;
    }
    (std::make_index_sequence<std::variant_size_v<Message>>{});
}

}  // namespace

std::size_t MessageReader::mostOf(std::uint8_t type) const {
    if (type == typeOf<State>() && stateExpected_) {
        return std::max(most_, mostState_);
    }
    return type == typeOf<EditRequest>() && loadsExpected_ ? std::max(most_, mostLoad_) : most_;
}

std::size_t MessageReader::mostLength() const {
    return std::max(mostOf(typeOf<State>()), mostOf(typeOf<EditRequest>()));
}

void MessageReader::freeLongMessage() {
    const auto rest = std::span<const std::uint8_t>(buffer_).subspan(begin_);
    if (buffer_.capacity() > kMaxKept && rest.size() <= kMaxKept) {
        buffer_ = base::Bytes(rest.begin(), rest.end());  // a new vector, because clear() and `= {}` keep the memory
        begin_ = 0;
    }
}

void MessageReader::feed(std::span<const std::uint8_t> bytes) {
    buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(begin_));
    begin_ = 0;
    const std::size_t end = buffer_.size();
    buffer_.resize(end + bytes.size());
    std::copy(bytes.begin(), bytes.end(), buffer_.begin() + static_cast<std::ptrdiff_t>(end));
}

std::optional<Message> MessageReader::next() {
    const auto stream = std::span<const std::uint8_t>(buffer_).subspan(begin_);
    if (stream.size() < kLengthBytes) {
        return std::nullopt;
    }
    const std::uint32_t length = framedLength(stream);
    if (length == 0 || length > mostLength()) {
        throw base::FormatError(fmt::format("a message of {} bytes; at most {} are allowed", length, mostLength()));
    }
    if (stream.size() > kLengthBytes && length > mostOf(stream[kLengthBytes])) {
        throw base::FormatError(fmt::format("a message of {} bytes and type {}; at most {} are allowed", length,
                                            stream[kLengthBytes], mostOf(stream[kLengthBytes])));
    }
    if (stream.size() < kLengthBytes + length) {
        if (length > kMaxKept && stream.size() > kLengthBytes) {
            // At once, because a buffer that grows is copied, and holds up to twice as much. The last bytes that are
            // read with this message may belong to the next one.
            buffer_.reserve(begin_ + kLengthBytes + length + kMaxKept);
        }
        return std::nullopt;
    }
    begin_ += kLengthBytes + length;
    if (stream[kLengthBytes] == typeOf<State>() && !std::exchange(stateExpected_, false)) {
        throw base::FormatError("a state that was not requested");
    }
    Message message = decode(stream.subspan(kLengthBytes, length));
    freeLongMessage();
    return message;
}

}  // namespace haptic_bridge
