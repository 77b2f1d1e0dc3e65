// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <xxhash.h>

#include "tests/fuzz/fuzz_target.hpp"

namespace fuzz {

/// Returns a file that holds the input behind its first byte. If the lowest bit of that byte is 1, the checksum
/// follows, with which checkpoints and saved sand end. A fuzzer would never find a correct checksum. The input is not
/// empty.
inline base::Bytes checksummed(Input input) {
    const Input content = input.subspan(1);
    base::ByteWriter bytes;
    bytes.putBytes(content);
    if ((input[0] & 1U) != 0) {
        bytes.put(XXH3_64bits(content.data(), content.size()));
    }
    return bytes.take();
}

}  // namespace fuzz
