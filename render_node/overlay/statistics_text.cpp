// SPDX-License-Identifier: Apache-2.0
#include "render_node/overlay/statistics_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace render_node {

void History::add(double value) {
    if (values_.size() == kLength) {
        values_.erase(values_.begin());
    }
    values_.push_back(value);
}

double History::largest() const { return values_.empty() ? 0 : *std::max_element(values_.begin(), values_.end()); }

double History::mean() const {
    return values_.empty() ? 0
                           : std::accumulate(values_.begin(), values_.end(), 0.0) / static_cast<double>(values_.size());
}

std::string milliseconds(double ms) { return ms < 99.95 ? fmt::format("{:.1f}", ms) : fmt::format("{:.0f}", ms); }

TileStatistics::TileStatistics(const walls::Wall& wall, const walls::Tile& tile, std::string host)
    : rank_(tile.rank), host_(std::move(host)) {
    for (const walls::Tile& any : wall.tiles) {
        tileNames_.push_back(any.name);
    }
}

void TileStatistics::add(const TileFigures& figures, std::uint64_t frame) {
    frame_ = frame;
    wall_ = figures.wall;
    if (wall_.frameMs > 0) {  // 0: no frame has been swapped yet
        frameMs_.add(wall_.frameMs);
        drawMs_.add(figures.drawMs);
        waitMs_.add(figures.waitMs);
    }
    if (const auto mine = static_cast<std::size_t>(rank_); mine <= wall_.swaps.size()) {
        skewMs_.add(wall_.swaps[mine - 1] * 1e-3);
    }
}

bool TileStatistics::drags() const { return wall_.slowest && wall_.slowest->rank == rank_; }

bool TileStatistics::motionIsSlow() const {
    constexpr double kNoticed = 1.1;
    return wall_.sweepsOwed > 0 || wall_.slowMotion > kNoticed;
}

std::string TileStatistics::nameOf(int rank) const {
    const auto index = static_cast<std::size_t>(rank);
    return rank < 1 || index > tileNames_.size() ? "THE MASTER"
                                                 : fmt::format("RANK {} {}", rank, tileNames_[index - 1]);
}

std::string TileStatistics::darkText() const {
    const std::size_t others = wall_.dark.size() - 1;
    return fmt::format("DARK: {}{}", nameOf(static_cast<int>(wall_.dark.front())),
                       others == 0 ? "" : fmt::format(" AND {} MORE", others));
}

std::vector<TileStatistics::Line> TileStatistics::longLines() const {
    const double mean = frameMs_.mean();
    std::vector<Line> lines{{fmt::format("{} ON {}", nameOf(rank_), host_), Line::Kind::plain, 4}};
    if (!wall_.dark.empty()) {
        lines.push_back({darkText(), Line::Kind::bad});
    }
    lines.push_back({fmt::format("{:.1f} FPS, FRAME {}", mean > 0 ? 1000 / mean : 0, frame_), Line::Kind::plain, 3});
    if (wall_.divergences > 0) {
        lines.push_back(
            {fmt::format("DIFFERED IN {} FRAMES, HEALED {}", wall_.divergences, wall_.healed), Line::Kind::bad});
    } else {
        lines.push_back({fmt::format("HASHES AGREED IN {} FRAMES", wall_.agreed), Line::Kind::good, 2});
    }
    if (wall_.unplaced > 0) {
        lines.push_back({fmt::format("NO ROOM FOR SAND IN {} STEPS", wall_.unplaced), Line::Kind::bad});
    }
    if (motionIsSlow()) {
        lines.push_back({fmt::format("SLOW MOTION {:.1f}, {} OWED", wall_.slowMotion.value_or(1), wall_.sweepsOwed),
                         Line::Kind::slow});
    }
    if (const auto& slowest = wall_.slowest) {
        lines.push_back(
            {fmt::format("SLOWEST: {}, {:.0f} %", nameOf(slowest->rank), 100 * slowest->share), Line::Kind::slow});
        lines.push_back(
            {fmt::format("THE WALL WAITS {} MS FOR IT", milliseconds(slowest->keptMs)), Line::Kind::slow, 1});
    } else {
        lines.push_back({"SLOWEST: NO RANK STANDS OUT"});
    }
    return lines;
}

std::vector<TileStatistics::Line> TileStatistics::shortLines() const {
    const double mean = frameMs_.mean();
    std::vector<Line> lines{{fmt::format("R{} {:.1f} FPS", rank_, mean > 0 ? 1000 / mean : 0)}};
    if (!wall_.dark.empty()) {
        lines.push_back({fmt::format("DARK R{}", fmt::join(wall_.dark, " R")), Line::Kind::bad});
    } else if (const auto& slowest = wall_.slowest) {
        lines.push_back({fmt::format("SLOWEST R{} {:.0f}%", slowest->rank, 100 * slowest->share), Line::Kind::slow});
    } else {
        lines.push_back({"SLOWEST -"});
    }
    if (motionIsSlow()) {
        lines.push_back({fmt::format("SLOW {:.1f}", wall_.slowMotion.value_or(1)), Line::Kind::slow});
    } else {
        lines.push_back({fmt::format("DRAW {} MS", milliseconds(drawMs_.latest()))});
    }
    if (wall_.divergences > 0) {
        lines.push_back({fmt::format("DIFFERED {}", wall_.divergences), Line::Kind::bad});
    } else {
        lines.push_back({fmt::format("AGREED {}", wall_.agreed), Line::Kind::good});
    }
    return lines;
}

std::vector<TileStatistics::Line> TileStatistics::lines(std::size_t letters, std::size_t count) const {
    std::vector<Line> lines = letters < kLetters ? shortLines() : longLines();
    for (int least = 1; lines.size() > count && least <= 4; ++least) {
        std::erase_if(lines, [&](const Line& line) { return line.leftOut == least; });
    }
    lines.resize(std::min(lines.size(), count));
    for (Line& line : lines) {
        line.text.resize(std::min(line.text.size(), letters));
    }
    return lines;
}

}  // namespace render_node
