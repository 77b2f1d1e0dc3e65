// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/spatial_order.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace sand::tin {
namespace {

constexpr unsigned kBits = 23;  // of a coordinate

/// How far along Hilbert's curve a place lies.
std::uint64_t hilbert(const Place& place) {
    auto x = static_cast<std::uint32_t>(place.x);
    auto y = static_cast<std::uint32_t>(place.y);
    std::uint64_t along = 0;
    for (std::uint32_t half = 1U << (kBits - 1); half > 0; half >>= 1U) {
        const bool right = (x & half) != 0;
        const bool up = (y & half) != 0;
        along = along * 4 + (right ? (up ? 2 : 3) : (up ? 1 : 0));
        if (!up) {
            if (right) {
                x = ~x;
                y = ~y;
            }
            std::swap(x, y);
        }
    }
    return along;
}

/// Half of all places belong to the last round, a quarter to the one before, and so on: by index, which is no pattern
/// that the places themselves could have.
std::uint64_t roundOf(std::uint32_t index) {
    std::uint32_t mixed = index * 2654435769U;
    mixed ^= mixed >> 15U;
    mixed *= 2246822519U;
    mixed ^= mixed >> 13U;
    return 15U - static_cast<std::uint64_t>(std::min(std::countl_zero(mixed | 1U), 15));
}

}  // namespace

std::vector<std::uint32_t> spatialOrder(std::span<const Place> places) {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
    keys.reserve(places.size());
    for (std::uint32_t index = 0; index < places.size(); ++index) {
        keys.emplace_back(roundOf(index) << (2 * kBits) | hilbert(places[index]), index);
    }
    std::sort(keys.begin(), keys.end());  // no ties: indices differ
    std::vector<std::uint32_t> order;
    order.reserve(keys.size());
    for (const auto& [key, index] : keys) {
        order.push_back(index);
    }
    return order;
}

}  // namespace sand::tin
