// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>

/// A TCP link that is impaired on purpose. Between two programs on one machine it simulates a wireless network.
namespace impaired_link {

/// The impairment of each direction of a connection. The default changes nothing.
struct Impairment {
    double delayMs = 0;            // least delay of every piece
    double jitterMs = 0;           // largest additional delay, evenly spread
    double stallShare = 0;         // share of the pieces that are lost once
    double stallMs = 0;            // additional delay of a lost piece and of all pieces behind it
    std::uint64_t resetAfter = 0;  // [byte], in both directions, after which a connection is reset; 0: never
    int resets = 1;                // largest number of connections to reset
    std::uint32_t seed = 1;        // seed of the random numbers
};

inline constexpr std::size_t kPiece = 1448;  // [byte], TCP payload of an Ethernet frame

/// The times at which the pieces of one direction leave. They leave in order, as with TCP, also if pieces are lost.
/// Reads no clock.
class Schedule {
public:
    /// `stream` is a different number for each direction of each connection of a link.
    Schedule(const Impairment& impairment, std::uint32_t stream);
    /// Returns the time at which the next piece leaves [ns]. Call it once per piece, in their order.
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
