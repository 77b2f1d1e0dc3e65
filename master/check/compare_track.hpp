// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>

namespace master {

/// Tracks up to which frame the sand of all ranks has been compared whole, and in which frame it differed first.
///
/// In each frame all ranks hash some hash tiles again from memory, one after the other. When every tile has had its
/// turn, memory that was wrong at the beginning of this round has been found. Used by one thread.
class CompareTrack {
public:
    /// `tiles` is the number of hash tiles. `firstDifference` is that of the session before its last start; 0: none.
    explicit CompareTrack(std::uint32_t tiles, std::uint64_t firstDifference = 0)
        : tiles_(tiles), firstDifference_(firstDifference) {}

    /// Adds frame `frame`, in which all ranks hashed `audited` tiles from memory and agreed.
    void agreed(std::uint64_t frame, std::uint32_t audited) {
        round_.push_back({frame, audited});
        inRound_ += audited;
        while (!round_.empty() && inRound_ - round_.front().audited >= tiles_) {
            inRound_ -= round_.front().audited;
            round_.pop_front();
        }
        lastWhole_ = inRound_ >= tiles_ ? round_.front().frame : lastWhole_;
    }
    /// Notes that sand differed in frame `frame`.
    void differed(std::uint64_t frame) { firstDifference_ = firstDifference_ == 0 ? frame : firstDifference_; }

    /// Returns the last frame at or after which every tile was hashed and agreed; 0: none.
    [[nodiscard]] std::uint64_t lastWhole() const { return lastWhole_; }
    /// Returns the first frame of the session in which sand differed; 0: none.
    [[nodiscard]] std::uint64_t firstDifference() const { return firstDifference_; }

private:
    struct Audit {
        std::uint64_t frame = 0;
        std::uint32_t audited = 0;
    };
    std::uint64_t tiles_;
    std::uint64_t firstDifference_;
    std::deque<Audit> round_;    // the shortest run of frames up to now that has hashed every tile
    std::uint64_t inRound_ = 0;  // tiles of round_
    std::uint64_t lastWhole_ = 0;
};

}  // namespace master
