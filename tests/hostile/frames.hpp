// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <vector>

#include "haptic_bridge/protocol.hpp"

namespace hostile {

/// Makes what nobody should send: the same for the same seed.
class Frames {
public:
    Frames(std::uint32_t seed, haptic_bridge::Identity identity);

    /// Random bytes, a changed message, one with a length that lies, one said before, or one out of turn.
    [[nodiscard]] files::Bytes next();
    /// A message in good order that no session needs, as a master that streams positions takes it.
    [[nodiscard]] files::Bytes position();
    [[nodiscard]] std::uint32_t below(std::uint32_t bound) { return static_cast<std::uint32_t>(random_()) % bound; }

    [[nodiscard]] const haptic_bridge::Identity& identity() const { return identity_; }

private:
    [[nodiscard]] files::Bytes randomBytes();
    [[nodiscard]] files::Bytes changed();
    [[nodiscard]] files::Bytes lying();

    std::minstd_rand random_;
    haptic_bridge::Identity identity_;
    std::vector<files::Bytes> real_;  // one of each message
    files::Bytes last_;
    std::int64_t time_ = 0;
};

}  // namespace hostile
