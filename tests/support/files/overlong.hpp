// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <string>

#include "base/byte_stream.hpp"

namespace test {

/// Returns `bytes` with one byte more: the byte at `place` says that another one follows, and a 0 follows. If a varint
/// ends at `place`, that is the same number in a form that no writer uses.
inline base::Bytes widenedAt(const base::Bytes& bytes, std::size_t place) {
    base::Bytes wide = bytes;
    wide[place] |= 0x80U;
    wide.insert(wide.begin() + static_cast<std::ptrdiff_t>(place) + 1, 0);
    return wide;
}

/// Widens `bytes` at each place. `readAndWrite` reads them, and returns what a writer makes of them, or throws
/// base::FormatError. Expects that it never returns `bytes`. Returns at how many places it has refused the form of a
/// number.
template <class ReadAndWrite>
int widenedNumbers(const base::Bytes& bytes, const ReadAndWrite& readAndWrite) {
    int refused = 0;
    for (std::size_t place = 0; place < bytes.size(); ++place) {
        if ((bytes[place] & 0x80U) != 0) {
            continue;  // no number ends here
        }
        const base::Bytes wide = widenedAt(bytes, place);
        try {
            EXPECT_NE(readAndWrite(wide), bytes) << "a number that ends at byte " << place << " has two forms";
        } catch (const base::FormatError& error) {
            refused += std::string(error.what()).find("in more bytes than it needs") != std::string::npos ? 1 : 0;
        }
    }
    return refused;
}

}  // namespace test
