// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <vector>

#include "haptic_bridge/link/protocol.hpp"

namespace hostile {

/// Makes what nobody should send: the same for the same seed.
class Frames {
public:
    Frames(std::uint32_t seed, haptic_bridge::Identity identity);

    /// Random bytes, a changed message, one with a length that lies, one said before, or one out of turn.
    [[nodiscard]] base::Bytes next();
    /// A message in good order that no session needs, as a master that streams positions takes it.
    [[nodiscard]] base::Bytes position();
    [[nodiscard]] std::uint32_t below(std::uint32_t bound) { return static_cast<std::uint32_t>(random_()) % bound; }

    [[nodiscard]] const haptic_bridge::Identity& identity() const { return identity_; }

private:
    [[nodiscard]] base::Bytes randomBytes();
    [[nodiscard]] base::Bytes changed();
    [[nodiscard]] base::Bytes lying();

    std::minstd_rand random_;
    haptic_bridge::Identity identity_;
    std::vector<base::Bytes> real_;  // one of each message
    base::Bytes last_;
    std::int64_t time_ = 0;
};

}  // namespace hostile
