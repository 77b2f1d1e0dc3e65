// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <vector>

#include "haptic_bridge/link/protocol.hpp"

namespace hostile {

/// Makes bad messages, the same ones for the same seed.
class Frames {
public:
    Frames(std::uint32_t seed, haptic_bridge::Identity identity);

    /// Returns random bytes, a changed message, a message with a wrong length, the last one again, or a message out of
    /// turn.
    [[nodiscard]] base::Bytes next();
    /// Returns a correctly encoded position with useless values. A master accepts it if the server streams positions.
    [[nodiscard]] base::Bytes position();
    [[nodiscard]] std::uint32_t below(std::uint32_t bound) { return static_cast<std::uint32_t>(random_()) % bound; }

    [[nodiscard]] const haptic_bridge::Identity& identity() const { return identity_; }

private:
    [[nodiscard]] base::Bytes randomBytes();
    [[nodiscard]] base::Bytes changed();
    [[nodiscard]] base::Bytes lying();

    std::minstd_rand random_;
    haptic_bridge::Identity identity_;
    std::vector<base::Bytes> real_;  // one message of each type
    base::Bytes last_;
    std::int64_t time_ = 0;
};

}  // namespace hostile
