// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace base {

/// Returns the CRC-32 of zlib, PNG and Ethernet for `bytes` that follow bytes with the checksum `before`. It reads bit
/// by bit, so it is for short texts.
[[nodiscard]] constexpr std::uint32_t crc32(std::string_view bytes, std::uint32_t before = 0) {
    constexpr std::uint32_t kPolynomial = 0xedb88320;  // with its lowest power first
    std::uint32_t rest = ~before;
    for (const char byte : bytes) {
        rest ^= static_cast<std::uint8_t>(byte);
        for (int bit = 0; bit < 8; ++bit) {
            rest = (rest >> 1U) ^ ((rest & 1U) != 0 ? kPolynomial : 0);
        }
    }
    return ~rest;
}

}  // namespace base
