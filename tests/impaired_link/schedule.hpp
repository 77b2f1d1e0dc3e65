// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>

/// A TCP link that is worse than it is: between two programs on one machine it stands in for a wireless network.
namespace impaired_link {

/// What happens to each direction of a connection. The default does nothing.
struct Impairment {
    double delayMs = 0;            // every piece takes at least as long
    double jitterMs = 0;           // and up to so much longer, evenly spread
    double stallShare = 0;         // of all pieces: those that are lost once,
    double stallMs = 0;            // and wait so much longer, with all that is behind them, until they are sent again
    std::uint64_t resetAfter = 0;  // [byte], both directions together: then the connection is reset; 0: never
    int resets = 1;                // so many connections at most
    std::uint32_t seed = 1;        // of all that is random
};

inline constexpr std::size_t kPiece = 1448;  // [byte]: what one Ethernet frame carries of TCP

/// When the pieces of one direction leave: in order, as TCP hands them over, whatever is lost on the way. Knows no
/// clock.
class Schedule {
public:
    /// `stream` tells the directions of all connections of one link apart.
    Schedule(const Impairment& impairment, std::uint32_t stream);
    /// For each piece in turn.
    [[nodiscard]] std::int64_t leaves(std::int64_t arrivedNs);
    [[nodiscard]] std::uint64_t stalls() const { return stalls_; }

private:
    [[nodiscard]] double chance();  // [0, 1)

    Impairment impairment_;
    std::mt19937 random_;
    std::int64_t last_ = 0;  // [ns]
    std::uint64_t stalls_ = 0;
};

}  // namespace impaired_link
