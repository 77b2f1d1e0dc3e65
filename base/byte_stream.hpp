// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace base {

using Bytes = std::vector<std::uint8_t>;

static_assert(std::endian::native == std::endian::little,
              "journal and link use little-endian numbers, so every host must too");

/// Error of a decoder: the bytes end too early, or hold a value that is not allowed.
class FormatError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Takes the bytes of a ByteWriter in order, for example into a file.
class ByteSink {
public:
    ByteSink() = default;
    ByteSink(const ByteSink&) = delete;
    ByteSink& operator=(const ByteSink&) = delete;
    virtual ~ByteSink() = default;
    virtual void write(std::span<const std::uint8_t> bytes) = 0;
    /// Replaces bytes that were written `place` bytes after the first one.
    virtual void overwrite(std::uint64_t place, std::span<const std::uint8_t> bytes) = 0;
};

/// Appends little-endian numbers to bytes. Link, frame messages and journal consist of such bytes.
class ByteWriter {
public:
    ByteWriter() = default;
    /// Passes the bytes to `sink` in pieces, so that it holds only kPiece bytes and what was appended last. `sink` must
    /// outlive the writer. Call flush() at the end, and neither bytes() nor take().
    explicit ByteWriter(ByteSink& sink) : sink_(&sink) {}
    static constexpr std::size_t kPiece = std::size_t{1} << 20;  // [byte]

    /// Takes the memory for `bytes` in all, so that it does not grow step by step.
    void reserve(std::size_t bytes) { bytes_.reserve(bytes); }
    /// Passes all bytes to the sink.
    void flush() {
        sink_->write(bytes_);
        passed_ += bytes_.size();
        bytes_.clear();
    }

    template <class Number>
    requires std::is_arithmetic_v<Number>
    void put(Number value) { append(&value, sizeof value); }
    void putBytes(std::span<const std::uint8_t> bytes) { append(bytes.data(), bytes.size()); }
    /// Appends the length, then the bytes.
    void putBlock(std::span<const std::uint8_t> bytes) {
        put(static_cast<std::uint32_t>(bytes.size()));
        putBytes(bytes);
    }
    /// Begins a block whose length endBlock() writes. Returns its place. All bytes up to endBlock() belong to it.
    [[nodiscard]] std::uint64_t beginBlock() {
        put(std::uint32_t{0});
        return passed_ + bytes_.size();
    }
    /// Throws std::length_error if the block has 2^32 bytes or more.
    void endBlock(std::uint64_t place) {
        const std::uint64_t size = passed_ + bytes_.size() - place;
        const auto length = static_cast<std::uint32_t>(size);
        if (length != size) {
            throw std::length_error("a block of " + std::to_string(size) + " bytes, which is too long");
        }
        if (const std::uint64_t at = place - sizeof length; at >= passed_) {
            std::memcpy(bytes_.data() + (at - passed_), &length, sizeof length);
        } else {
            std::uint8_t bytes[sizeof length];
            std::memcpy(bytes, &length, sizeof length);
            sink_->overwrite(at, bytes);
        }
    }
    void putText(std::string_view text) { putBlock({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}); }
    /// Appends a number with 7 bits in each byte, lowest bits first. Small numbers take few bytes.
    void putVarint(std::uint64_t value) {
        for (; value >= 0x80; value >>= 7) {
            bytes_.push_back(static_cast<std::uint8_t>(value | 0x80));
        }
        bytes_.push_back(static_cast<std::uint8_t>(value));
    }
    /// Appends a signed number. Small magnitudes of either sign take few bytes.
    void putSigned(std::int64_t value) {
        putVarint((static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63));
    }

    [[nodiscard]] const Bytes& bytes() const { return bytes_; }
    [[nodiscard]] Bytes take() { return std::move(bytes_); }

private:
    // Not inlined: g++ 12 warns of an overflow in vector::insert, and g++ 14 of one in resize after several calls.
    [[gnu::noinline]] void append(const void* from, std::size_t size) {
        const std::size_t end = bytes_.size();
        bytes_.resize(end + size);
        if (size > 0) {
            std::memcpy(bytes_.data() + end, from, size);
        }
        if (sink_ != nullptr && bytes_.size() >= kPiece) {
            flush();
        }
    }

    Bytes bytes_;
    ByteSink* sink_ = nullptr;  // null: bytes_ has all bytes
    std::uint64_t passed_ = 0;  // bytes that the sink has
};

/// Reads what ByteWriter wrote. Throws FormatError if the bytes end before a value does.
class ByteReader {
public:
    explicit ByteReader(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

    template <class Number>
    requires std::is_arithmetic_v<Number> Number get() {
        Number value;
        std::memcpy(&value, getBytes(sizeof value).data(), sizeof value);
        return value;
    }
    std::span<const std::uint8_t> getBytes(std::size_t count) {
        if (count > rest_.size()) {
            throw FormatError("cut short: " + std::to_string(count) + " bytes wanted, " + std::to_string(rest_.size()) +
                              " there");
        }
        const auto bytes = rest_.first(count);
        rest_ = rest_.subspan(count);
        return bytes;
    }
    std::span<const std::uint8_t> getBlock() { return getBytes(get<std::uint32_t>()); }
    std::string getText() {
        const auto block = getBlock();
        return {block.begin(), block.end()};
    }
    /// Reads what putVarint() wrote. A number has one form: more bytes than putVarint() writes are refused.
    std::uint64_t getVarint() {
        std::uint64_t value = 0;
        for (unsigned shift = 0; shift < 64; shift += 7) {
            const auto byte = get<std::uint8_t>();
            const std::uint64_t bits = byte & 0x7fU;
            if (bits << shift >> shift != bits) {
                break;
            }
            value |= bits << shift;
            if ((byte & 0x80) == 0) {
                if (byte == 0 && shift > 0) {
                    throw FormatError("a number in more bytes than it needs");
                }
                return value;
            }
        }
        throw FormatError("a number longer than 64 bits");
    }
    std::int64_t getSigned() {
        const std::uint64_t value = getVarint();
        return static_cast<std::int64_t>(value >> 1) ^ -static_cast<std::int64_t>(value & 1);
    }
    [[nodiscard]] std::span<const std::uint8_t> rest() const { return rest_; }
    [[nodiscard]] bool atEnd() const { return rest_.empty(); }

private:
    std::span<const std::uint8_t> rest_;
};

}  // namespace base
