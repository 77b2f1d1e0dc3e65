// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/devices/sand_picture.hpp"

#include <algorithm>
#include <cmath>

namespace haptic_bridge {
namespace {

constexpr double kPixelsPerNewton = 40;
constexpr double kBarDepth = 3;  // [tool radius] at the end of the bar

std::uint32_t colour(double red, double green, double blue) {
    const auto level = [](double share) {
        return static_cast<std::uint32_t>(std::lround(std::clamp(share, 0.0, 1.0) * 255));
    };
    return 0xff000000U | level(blue) << 16 | level(green) << 8 | level(red);
}

class Painter {
public:
    explicit Painter(Picture& picture) : picture_(picture) {}
    void dot(double x, double y, std::uint32_t c) {
        const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
        if (column >= 0 && row >= 0 && column < picture_.width && row < picture_.height) {
            picture_.pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(picture_.width) +
                            static_cast<std::size_t>(column)] = c;
        }
    }
    void line(double x, double y, double toX, double toY, std::uint32_t c) {
        const int steps = static_cast<int>(std::min(4096.0, std::hypot(toX - x, toY - y))) + 1;
        for (int i = 0; i <= steps; ++i) {
            const double share = static_cast<double>(i) / steps;
            for (const double beside : {0.0, 1.0}) {
                dot(x + share * (toX - x) + beside, y + share * (toY - y), c);
                dot(x + share * (toX - x), y + share * (toY - y) + beside, c);
            }
        }
    }
    void arrow(double x, double y, double toX, double toY, std::uint32_t c) {
        line(x, y, toX, toY, c);
        const double length = std::hypot(toX - x, toY - y);
        if (length > 3) {
            const double alongX = (toX - x) / length * 8, alongY = (toY - y) / length * 8;
            line(toX, toY, toX - alongX + alongY / 2, toY - alongY - alongX / 2, c);
            line(toX, toY, toX - alongX - alongY / 2, toY - alongY + alongX / 2, c);
        }
    }
    void circle(double x, double y, double radius, std::uint32_t c) {
        const int steps = std::clamp(static_cast<int>(8 * radius), 16, 4096);
        for (int i = 0; i < steps; ++i) {
            const double angle = 2 * M_PI * i / steps;
            dot(x + radius * std::cos(angle), y + radius * std::sin(angle), c);
            dot(x + (radius - 1) * std::cos(angle), y + (radius - 1) * std::sin(angle), c);
        }
    }
    /// Draws a bar up or down from the middle of the picture's height.
    void bar(int left, double share, std::uint32_t c) {
        const double middle = picture_.height / 2.0, end = middle * (1 - std::clamp(share, -1.0, 1.0));
        const double lowest = std::min(middle, end);
        const int rows = static_cast<int>(std::abs(end - middle)) + 1;
        for (int row = 0; row < rows; ++row) {
            for (int x = 0; x < 6; ++x) {
                dot(left + x, lowest + row, c);
            }
        }
    }

private:
    Picture& picture_;
};

std::uint32_t shade(const SandSketch& sand, int column, int row, double mean, double span) {
    const auto at = [&](int c, int r) {
        c = std::clamp(c, 0, sand.columns - 1);
        r = std::clamp(r, 0, sand.rows - 1);
        return static_cast<double>(sand.heights[static_cast<std::size_t>(r) * static_cast<std::size_t>(sand.columns) +
                                                static_cast<std::size_t>(c)]);
    };
    const double slopeEast = (at(column + 1, row) - at(column - 1, row)) / 2;
    const double slopeNorth = (at(column, row + 1) - at(column, row - 1)) / 2;
    // Light comes from the north-west, as on maps.
    const double lit =
        (slopeEast - slopeNorth + 1.2) / (1.7 * std::sqrt(1 + slopeEast * slopeEast + slopeNorth * slopeNorth));
    const double high = 0.12 * std::clamp((at(column, row) - mean) / span, -1.0, 1.0);
    const double light = std::clamp(0.25 + 0.7 * lit + high, 0.05, 1.0);
    return colour(0.95 * light, 0.8 * light, 0.55 * light);
}

void paintSand(const SandSketch& sand, const SketchFrame& frame, Picture& picture) {
    double sum = 0, span = 1e-9;
    for (const float height : sand.heights) {
        sum += height;
    }
    const double mean = sum / static_cast<double>(sand.heights.size());
    for (const float height : sand.heights) {
        span = std::max(span, std::abs(height - mean));
    }
    const double perCell = 2 * frame.halfWidth * frame.pixelsPerHalfSide / sand.columns;
    for (int row = 0; row < picture.height; ++row) {
        const int cellRow = static_cast<int>(std::floor(sand.rows - (row + 0.5 - frame.top) / perCell));
        for (int column = 0; column < picture.width; ++column) {
            const int cellColumn = static_cast<int>(std::floor((column + 0.5 - frame.left) / perCell));
            const bool inside = cellRow >= 0 && cellRow < sand.rows && cellColumn >= 0 && cellColumn < sand.columns;
            picture.pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width) +
                           static_cast<std::size_t>(column)] =
                inside ? shade(sand, cellColumn, cellRow, mean, span) : colour(0.1, 0.1, 0.12);
        }
    }
}

}  // namespace

void SandSketch::take(const sand::Replica& terrain) {
    const sand::Rules& field = terrain.rules();
    const int every = (std::max(field.columns, field.rows) + kMostSide - 1) / kMostSide;
    columns = (field.columns + every - 1) / every;
    rows = (field.rows + every - 1) / every;
    heights.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    std::size_t next = 0;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            // Heights are in kept cells, so that differences of heights are slopes.
            heights[next++] = static_cast<float>(terrain.surface().height((column * every + 0.5) * sand::kProbePerCell,
                                                                          (row * every + 0.5) * sand::kProbePerCell)) /
                              static_cast<float>(sand::kUnitsPerCell * every);
        }
    }
    toolRadius = terrain.toolRadius() / (std::min(field.columns, field.rows) * terrain.cellSize() / 2);
    step = terrain.stepNumber();
}

SketchFrame SketchFrame::of(int width, int height, int columns, int rows) {
    const double shorter = std::min(columns, rows);
    SketchFrame frame;
    frame.halfWidth = columns / shorter;
    frame.halfHeight = rows / shorter;
    frame.pixelsPerHalfSide = std::min(width / (2 * frame.halfWidth), height / (2 * frame.halfHeight));
    frame.left = width / 2.0 - frame.halfWidth * frame.pixelsPerHalfSide;
    frame.top = height / 2.0 - frame.halfHeight * frame.pixelsPerHalfSide;
    return frame;
}

void paint(const SandSketch& sand, const SketchedHand& hand, Picture& picture) {
    picture.pixels.resize(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
    if (sand.heights.empty()) {
        std::fill(picture.pixels.begin(), picture.pixels.end(), colour(0.1, 0.1, 0.12));
        return;
    }
    const SketchFrame frame = SketchFrame::of(picture.width, picture.height, sand.columns, sand.rows);
    paintSand(sand, frame, picture);
    Painter painter(picture);
    const double x = frame.pixelX(hand.x), y = frame.pixelY(hand.y);
    const std::uint32_t red = colour(0.85, 0.1, 0.1), blue = colour(0.1, 0.3, 0.8);
    painter.circle(x, y, std::max(3.0, sand.toolRadius * frame.pixelsPerHalfSide), hand.touches ? red : blue);
    if (hand.touches) {
        painter.arrow(x, y, x + kPixelsPerNewton * hand.force.x, y - kPixelsPerNewton * hand.force.y, red);
        painter.bar(2, 2 * kPixelsPerNewton * hand.force.z / picture.height, red);
    }
    painter.bar(picture.width - 8, -hand.depth / kBarDepth, blue);
}

}  // namespace haptic_bridge
