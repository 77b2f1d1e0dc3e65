// SPDX-License-Identifier: Apache-2.0
#include "sand/model/rules.hpp"

#include <xxhash.h>

namespace sand {

std::uint64_t Rules::digest() const {
    const base::Bytes bytes = base::encoded(*this);
    return XXH3_64bits_withSeed(bytes.data(), bytes.size(), kAlgorithmVersion);
}

}  // namespace sand
