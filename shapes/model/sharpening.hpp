// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sand/model/movement.hpp"

namespace shapes {

/// Rule for the hash tiles of a height field whose sand counts as moving, so that it is drawn more coarsely.
///
/// A tile counts as moving for half a second of steps, and at least two steps, after the last step that has moved its
/// sand. Then it waits until it is sharpened. Each step sharpens a fixed number of tiles: the tiles that have waited
/// longest, row by row. So a field that comes to rest as a whole costs no long frame.
///
/// The result follows from sand::Movement alone, so that all replicas agree. This includes a replica that was resumed.
class Sharpening {
public:
    /// `tiles` is the number of hash tiles of the field.
    Sharpening(int stepsPerSecond, std::size_t tiles);

    /// Returns whether no tile counts as moving.
    [[nodiscard]] bool allSharp(const sand::Movement& movement) const;
    /// Sets `moving` to 1 for each tile that counts as moving, and to 0 for all others.
    void mark(const sand::Movement& movement, std::vector<std::uint8_t>& moving) const;

    /// Returns the number of steps after which a tile that does not move again is sharp, however many tiles wait.
    [[nodiscard]] std::uint64_t longest() const { return longest_; }
    /// Returns the number of tiles that a step sharpens.
    [[nodiscard]] std::uint64_t tilesPerStep() const { return tilesPerStep_; }

private:
    [[nodiscard]] std::vector<std::uint64_t> firstPlaces(const sand::Movement& movement) const;

    std::uint64_t shortest_;  // [step], for which a tile counts as moving
    std::uint64_t tilesPerStep_;
    std::uint64_t longest_;
};

}  // namespace shapes
