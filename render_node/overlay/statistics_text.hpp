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

/// What a tile has to show of a frame that is over.
struct TileFigures {
    double drawMs = 0, waitMs = 0;  // this rank's: drawing all eyes; from its arrival at the barrier to its swap
    lockstep::WallFigures wall;     // what the master knows
};

/// The last values of one figure, the oldest first; older ones are forgotten.
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

/// How the wall keeps up, as one of its tiles tells it: in words, and as histories of the last frames.
class TileStatistics {
public:
    TileStatistics(const walls::Wall& wall, const walls::Tile& tile, std::string host);

    /// Of the frame before `frame`.
    void add(const TileFigures& figures, std::uint64_t frame);

    struct Line {
        enum class Kind : std::uint8_t { plain, good, slow, bad };
        std::string text;
        Kind kind = Kind::plain;
    };
    /// The most important first. Where there is room for fewer than kLetters, shorter ones, cut to fit.
    [[nodiscard]] std::vector<Line> lines(std::size_t letters) const;
    static constexpr std::size_t kLetters = 32;

    [[nodiscard]] const History& frameMs() const { return frameMs_; }  // from swap to swap
    [[nodiscard]] const History& drawMs() const { return drawMs_; }
    [[nodiscard]] const History& waitMs() const { return waitMs_; }
    [[nodiscard]] const History& skewMs() const { return skewMs_; }  // after the first swap of the wall
    /// Whether it is this tile that the wall waits for.
    [[nodiscard]] bool drags() const;

private:
    [[nodiscard]] std::string nameOf(int rank) const;
    [[nodiscard]] std::vector<Line> longLines() const;
    [[nodiscard]] std::vector<Line> shortLines() const;

    std::vector<std::string> tileNames_;  // by rank, from 1
    int rank_;
    std::string host_;
    std::uint64_t frame_ = 0;
    lockstep::WallFigures wall_;
    History frameMs_, drawMs_, waitMs_, skewMs_;
};

/// As a person reads it at a glance: "0.4", "31.2", "131".
[[nodiscard]] std::string milliseconds(double ms);

}  // namespace render_node
