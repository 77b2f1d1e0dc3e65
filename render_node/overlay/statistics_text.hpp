// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "lockstep/wall_figures.hpp"
#include "walls/wall.hpp"

namespace render_node {

/// Figures of the last complete frame that a tile shows.
struct TileFigures {
    // Figures of this rank: time to draw all eyes; time from its arrival at the barrier to its swap.
    double drawMs = 0, waitMs = 0;
    lockstep::WallFigures wall;  // figures from the master
};

/// Last kLength values of one figure, oldest first.
class History {
public:
    static constexpr std::size_t kLength = 120;

    void add(double value);
    [[nodiscard]] const std::vector<double>& values() const { return values_; }
    [[nodiscard]] double latest() const { return values_.empty() ? 0 : values_.back(); }
    [[nodiscard]] double largest() const;
    [[nodiscard]] double mean() const;

private:
    std::vector<double> values_;
};

/// Figures of the wall as one of its tiles shows them: as text, and as histories of the last frames.
class TileStatistics {
public:
    TileStatistics(const walls::Wall& wall, const walls::Tile& tile, std::string host);

    /// Adds the figures of the frame before `frame`.
    void add(const TileFigures& figures, std::uint64_t frame);

    struct Line {
        enum class Kind : std::uint8_t { plain, good, slow, bad };
        std::string text;
        Kind kind = Kind::plain;
        int leftOut = 0;  // if lines do not fit, 1 is left out first, 2 next; 0 is only cut at the end
    };
    /// Returns at most `count` lines from the top. If `letters` is less than kLetters, returns shorter lines and cuts
    /// them to `letters` letters.
    [[nodiscard]] std::vector<Line> lines(std::size_t letters, std::size_t count) const;
    static constexpr std::size_t kLetters = 32;
    static constexpr std::size_t kLongLines = 5;  // with so many lines of kLetters letters, no warning is left out

    [[nodiscard]] const History& frameMs() const { return frameMs_; }  // time from swap to swap
    [[nodiscard]] const History& drawMs() const { return drawMs_; }
    [[nodiscard]] const History& waitMs() const { return waitMs_; }
    // Delay of this rank's swap after the first swap of the wall.
    [[nodiscard]] const History& skewMs() const { return skewMs_; }
    /// Returns whether the wall waits for this tile.
    [[nodiscard]] bool drags() const;

private:
    [[nodiscard]] std::string nameOf(int rank) const;
    /// Returns the line about the dark tiles. At least one tile must be dark.
    [[nodiscard]] std::string darkText() const;
    /// Returns whether the tool waits for sweeps, or has been noticeably slower than the hand.
    [[nodiscard]] bool motionIsSlow() const;
    [[nodiscard]] std::vector<Line> longLines() const;
    [[nodiscard]] std::vector<Line> shortLines() const;

    std::vector<std::string> tileNames_;  // by rank, starting with rank 1
    int rank_;
    std::string host_;
    std::uint64_t frame_ = 0;
    lockstep::WallFigures wall_;
    History frameMs_, drawMs_, waitMs_, skewMs_;
};

/// Returns a time in short form, such as "0.4", "31.2" or "131".
[[nodiscard]] std::string milliseconds(double ms);

}  // namespace render_node
