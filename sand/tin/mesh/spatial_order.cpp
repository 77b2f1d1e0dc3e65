// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/mesh/spatial_order.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace sand::tin {
namespace {

constexpr unsigned kBits = 23;  // bits of a coordinate
constexpr std::size_t kRounds = 16;

/// Returns the position of a place along Hilbert's curve. Different places have different positions.
std::uint64_t hilbert(const LatticePoint& place) {
    // Both tables are indexed by the curve's orientation in this square and by the quarter. kDigit has the digit, and
    // kWithin the orientation in that quarter. Orientations: unchanged, swapped, turned by half, swapped and turned.
    constexpr std::array<std::array<std::uint8_t, 4>, 4> kDigit{
        {{0, 1, 3, 2}, {0, 3, 1, 2}, {2, 3, 1, 0}, {2, 1, 3, 0}}};
    constexpr std::array<std::array<std::uint8_t, 4>, 4> kWithin{
        {{1, 0, 3, 0}, {0, 2, 1, 1}, {2, 1, 2, 3}, {3, 3, 0, 2}}};
    const auto x = static_cast<std::uint32_t>(place.x);
    const auto y = static_cast<std::uint32_t>(place.y);
    std::uint64_t along = 0;
    std::size_t way = 0;
    for (unsigned bit = kBits; bit-- > 0;) {
        const std::size_t quarter = (x >> bit & 1U) * 2 + (y >> bit & 1U);
        along = along << 2U | kDigit[way][quarter];
        way = kWithin[way][quarter];
    }
    return along;
}

/// Returns the round of a place. Half of all places belong to the last round, a quarter to the one before, and so on.
/// The index alone decides, mixed so that the result follows no pattern in the places.
std::size_t roundOf(std::uint32_t index) {
    std::uint32_t mixed = index * 2654435769U;
    mixed ^= mixed >> 15U;
    mixed *= 2246822519U;
    mixed ^= mixed >> 13U;
    return kRounds - 1 - std::min(static_cast<std::size_t>(std::countl_zero(mixed)), kRounds - 1);
}

}  // namespace

SpatialOrder spatialOrder(std::span<const LatticePoint> places) {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(places.size());
    for (std::uint32_t index = 0; index < places.size(); ++index) {
        keys[index] = {hilbert(places[index]), index};
    }
    std::sort(keys.begin(), keys.end());  // no ties, because the indices differ
    SpatialOrder result;
    result.first.resize(places.size());
    std::array<std::vector<std::uint32_t>, kRounds> rounds;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const auto [along, index] = keys[i];
        const bool again = i > 0 && keys[i - 1].first == along;
        result.first[index] = again ? result.first[keys[i - 1].second] : index;
        if (!again) {
            rounds.at(roundOf(index)).push_back(index);
        }
    }
    for (const std::vector<std::uint32_t>& round : rounds) {
        result.order.insert(result.order.end(), round.begin(), round.end());
    }
    return result;
}

}  // namespace sand::tin
