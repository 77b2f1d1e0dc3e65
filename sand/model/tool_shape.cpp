// SPDX-License-Identifier: Apache-2.0
#include "sand/model/tool_shape.hpp"

#include <array>
#include <cstdlib>

#include "sand/model/tool_kernel.hpp"

namespace sand {
namespace {

constexpr double kBeside = 4;  // level of a place beside a piece; larger than any level within the piece's rectangle

constexpr std::array<SolePiece, 1> kPlate{{{0, 0, 1, 1, 0, 0}}};

// Heel; outer side, which the arch leaves on the ground; inner and outer ball; the five toes, the big toe first.
constexpr std::array<SolePiece, 9> kSole{{{-0.69, 0.05, 0.31, 0.62, 0, 0.07},
                                          {-0.13, -0.33, 0.52, 0.42, 0.06, 0.05},
                                          {0.43, 0.38, 0.27, 0.56, 0.005, 0.06},
                                          {0.30, -0.33, 0.29, 0.60, 0.01, 0.06},
                                          {0.85, 0.56, 0.15, 0.30, 0.015, 0.06},
                                          {0.815, 0.11, 0.105, 0.165, 0.03, 0.06},
                                          {0.755, -0.19, 0.095, 0.15, 0.03, 0.06},
                                          {0.675, -0.48, 0.088, 0.14, 0.03, 0.06},
                                          {0.575, -0.75, 0.08, 0.13, 0.03, 0.06}}};

/// Returns by how much the ring of places that take sand is wider than that of a small sphere [probe unit].
std::int64_t widerRing(const Tool& tool, TurnedShape::SphereRing ring) {
    if (tool.kind != ToolKind::sphere) {
        return (isRound(tool.kind) ? tool.radius : tool.halfWidth) / 4;
    }
    return ring == TurnedShape::SphereRing::narrow
               ? 0
               : std::min(tool.radius / 4, std::max(0, tool.radius - kLargestPlainTool));
}

}  // namespace

std::span<const SolePiece> solePieces(ToolKind kind) {
    return kind == ToolKind::footprint ? std::span<const SolePiece>(kSole) : std::span<const SolePiece>();
}

TurnedShape::TurnedShape(const Tool& tool, SphereRing ring, base::CodePath path)
    : tool_(tool),
      path_(path),
      length_(tool.radius),
      width_(tool.halfWidth),
      ring_(kRing + widerRing(tool, ring)),
      scale_(1 / std::sqrt(static_cast<double>(std::int64_t{tool.heading.x} * tool.heading.x +
                                               std::int64_t{tool.heading.y} * tool.heading.y))),
      east_(tool.radius),
      north_(tool.radius) {
    if (hasHeading()) {
        // Half sides of the upright rectangle around the turned tool. They are a little too large, because rounding may
        // have made the heading a little short.
        const std::int64_t x = std::abs(tool.heading.x), y = std::abs(tool.heading.y);
        const auto reach = [&](std::int64_t along, std::int64_t across) {
            const std::int64_t whole = along * tool.radius + across * tool.halfWidth;
            return whole / Heading::kLength + whole / (std::int64_t{Heading::kLength} * Heading::kLength / 2) + 2;
        };
        east_ = reach(x, y);
        north_ = reach(y, x);
    }
}

std::span<const SolePiece> TurnedShape::pieces() const {
    const std::span<const SolePiece> sole = solePieces(tool_.kind);
    return sole.empty() ? kPlate : sole;
}

void TurnedShape::undersides(std::int32_t z, const Offset& first, std::span<std::int32_t> row) const {
    if (tool_.kind == ToolKind::sphere) {
        const SphereRow cells{.square = std::int64_t{tool_.radius} * tool_.radius - first.y * first.y,
                              .first = first.x,
                              .centre = std::int64_t{z} * kUnitsPerProbe,
                              .count = static_cast<int>(row.size())};
        path_ != base::CodePath::baseline ? v3::undersidesOfSphere(cells, row.data())
                                          : baseline::undersidesOfSphere(cells, row.data());
        return;
    }
    Offset offset = first;
    for (std::int32_t& underside : row) {
        underside = this->underside(z, offset);
        offset.x += kProbePerCell;
    }
}

double TurnedShape::levelOf(const SolePiece& piece, const ToolPoint& place, double grown) const {
    const double along = place.along - piece.along * length_, across = place.across - piece.across * width_;
    const double length = piece.halfLength * length_ + grown, width = piece.halfWidth * width_ + grown;
    if (std::abs(along) > length || std::abs(across) > width) {
        return kBeside;  // without a division, because most of the nine pieces are far away
    }
    return along / length * (along / length) + across / width * (across / width);
}

std::int32_t TurnedShape::longUnderside(std::int32_t z, const Offset& offset) const {
    if (tool_.halfWidth == 0) {
        return kFree;
    }
    const ToolPoint place = placeOf(offset);
    if (tool_.kind == ToolKind::rectangle) {
        const bool below = std::abs(place.along) < length_ && std::abs(place.across) < width_;
        return below ? lowered(z, length_) : kFree;
    }
    if (tool_.kind == ToolKind::ellipsoid) {
        const double across = place.across * length_ / width_;
        const double square = length_ * length_ - place.along * place.along - across * across;
        return square > 0 ? lowered(z, std::sqrt(square)) : kFree;
    }
    double deepest = -1;
    for (const SolePiece& piece : pieces()) {
        const double level = levelOf(piece, place, 0);
        if (level < 1) {
            deepest = std::max(deepest, length_ * (1 - piece.lift - piece.bulge * level));
        }
    }
    return deepest >= 0 ? lowered(z, deepest) : kFree;
}

bool TurnedShape::longTakes(const Offset& offset) const {
    const ToolPoint place = placeOf(offset);
    const auto ring = static_cast<double>(ring_);
    if (tool_.kind == ToolKind::rectangle) {
        return std::abs(place.along) <= length_ + ring && std::abs(place.across) <= width_ + ring;
    }
    int near = 0, beside = 0;
    for (const SolePiece& piece : pieces()) {
        if (levelOf(piece, place, ring) <= 1) {
            ++near;
            beside += levelOf(piece, place, ring / 2) <= 1 ? 1 : 0;
        }
    }
    return near >= 1 && beside <= 1;
}

TurnedShape::ToolPoint TurnedShape::normalAt(const ToolPoint& place) const {
    if (tool_.kind == ToolKind::rectangle) {
        const bool end = std::abs(place.along) - length_ > std::abs(place.across) - width_;
        return end ? ToolPoint{place.along, 0} : ToolPoint{0, place.across};
    }
    const auto ring = static_cast<double>(ring_);
    ToolPoint normal{};
    double nearest = std::numeric_limits<double>::infinity();
    for (const SolePiece& piece : pieces()) {
        if (const double level = levelOf(piece, place, ring); level < nearest) {
            nearest = level;
            const double length = piece.halfLength * length_ + ring, width = piece.halfWidth * width_ + ring;
            normal = {(place.along - piece.along * length_) / (length * length),
                      (place.across - piece.across * width_) / (width * width)};
        }
    }
    return normal;
}

std::int64_t TurnedShape::longShare(const Offset& offset, const Offset& ahead) const {
    const ToolPoint normal = normalAt(placeOf(offset));
    const double length = std::sqrt(normal.along * normal.along + normal.across * normal.across);
    if (!(length > 0)) {
        return 0;
    }
    // The normal is in 1024ths, rounded towards zero, and the drag is below 2^24. The product stays below 2^36.
    const WholeToolPoint drag = turnedBack(ahead);
    const auto part = [length](double side) { return static_cast<std::int64_t>(1024 * side / length); };
    return part(normal.along) * drag.along + part(normal.across) * drag.across;
}

bool TurnedShape::before(const Offset& a, const Offset& b) const {
    const WholeToolPoint first = turnedBack(a), second = turnedBack(b);
    return first.along != second.along ? first.along < second.along : first.across < second.across;
}

CellRect TurnedShape::cellsAround(std::int64_t x, std::int64_t y, std::int64_t margin) const {
    // Rounds down, also below zero.
    const auto cell = [](std::int64_t coordinate) { return static_cast<int>(coordinate >> kProbeBits); };
    return {cell(x - east_ - margin), cell(y - north_ - margin), cell(x + east_ + margin) + 1,
            cell(y + north_ + margin) + 1};
}

}  // namespace sand
