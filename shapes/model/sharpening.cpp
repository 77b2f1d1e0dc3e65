// SPDX-License-Identifier: Apache-2.0
#include "shapes/model/sharpening.hpp"

#include <algorithm>

namespace shapes {
namespace {

// More tiles than these are measured and drawn again over several steps, within a second.
constexpr std::uint64_t kFewTiles = 16;

std::uint64_t dividedUp(std::uint64_t number, std::uint64_t by) { return (number + by - 1) / by; }

}  // namespace

Sharpening::Sharpening(int stepsPerSecond, std::size_t tiles)
    : shortest_(std::max<std::uint64_t>(2, dividedUp(static_cast<std::uint64_t>(stepsPerSecond), 2))),
      tilesPerStep_(std::max<std::uint64_t>(kFewTiles, dividedUp(tiles, static_cast<std::uint64_t>(stepsPerSecond)))),
      longest_(shortest_ + dividedUp(tiles, tilesPerStep_) - 1) {}

bool Sharpening::allSharp(const sand::Movement& movement) const {
    return movement.newest == 0 || movement.step - movement.newest >= longest_;
}

/// Returns places in the queue of the tiles that wait. The age of a tile is the number of steps since its last
/// movement. For each age, returns the place of the first such tile in the step in which it began to wait.
std::vector<std::uint64_t> Sharpening::firstPlaces(const sand::Movement& movement) const {
    std::vector<std::uint64_t> counts(longest_ + 1, 0);
    for (const std::uint64_t moved : movement.moved) {
        if (const std::uint64_t age = movement.step - moved; moved != 0 && age <= longest_) {
            ++counts[age];
        }
    }
    std::vector<std::uint64_t> first(counts.size(), 0);
    std::uint64_t waiting = 0;
    for (std::uint64_t age = longest_; age >= shortest_; --age) {
        first[age] = waiting;
        waiting += counts[age];
        waiting -= std::min(waiting, tilesPerStep_);
    }
    return first;
}

void Sharpening::mark(const sand::Movement& movement, std::vector<std::uint8_t>& moving) const {
    moving.assign(movement.moved.size(), 0);
    if (allSharp(movement)) {
        return;
    }
    std::vector<std::uint64_t> places = firstPlaces(movement);
    for (std::size_t tile = 0; tile < moving.size(); ++tile) {
        const std::uint64_t age = movement.step - movement.moved[tile];
        if (movement.moved[tile] == 0 || age > longest_) {
            continue;
        }
        moving[tile] = age < shortest_ || places[age]++ / tilesPerStep_ > age - shortest_ ? 1 : 0;
    }
}

}  // namespace shapes
