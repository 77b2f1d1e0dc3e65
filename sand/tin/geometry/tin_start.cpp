// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/geometry/tin_start.hpp"

#include <xxhash.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "sand/model/height_field.hpp"

namespace sand::tin {
namespace {

bool within(std::int32_t number, std::int32_t lowest, std::int32_t highest) {
    return number >= lowest && number <= highest;
}

/// Returns whether two vertices are in one place.
bool hasTwins(std::vector<LatticePoint> places) {
    std::sort(places.begin(), places.end());
    return std::adjacent_find(places.begin(), places.end()) != places.end();
}

}  // namespace

Cells nominalCells(std::int32_t width, std::int32_t depth) {
    constexpr std::int32_t kMiddle = kLatticePerCell / 2;
    return {.columns = width / kLatticePerCell,
            .rows = depth / kLatticePerCell,
            .first = {kMiddle, kMiddle},
            .width = width,
            .depth = depth};
}

double mostHeight(int columns, int rows) {
    return static_cast<double>(kMostSand) / (6.0 * columns * rows * kLatticePerCell * kLatticePerCell);
}

std::shared_ptr<const Holes> holesOf(const TinStart& start, std::vector<Holes::Run> runs) {
    if (start.width % kLatticePerCell != 0 || start.depth % kLatticePerCell != 0) {
        throw base::FormatError("are in cells that are not whole");
    }
    const Cells cells = nominalCells(start.width, start.depth);
    for (const Holes::Run& run : runs) {
        if (!within(run.row, 0, cells.rows - 1) || !within(run.first, 0, cells.columns - 1) ||
            !within(run.end, 1, cells.columns)) {
            throw base::FormatError("are outside the field");
        }
    }
    try {
        return std::make_shared<const Holes>(cells, std::move(runs));
    } catch (const std::invalid_argument& wrong) {
        throw base::FormatError(wrong.what());
    }
}

void TinStart::encode(base::ByteWriter& writer) const { base::putMember(writer, *this); }

TinStart TinStart::decode(base::ByteReader& reader) { return base::read<TinStart>(reader); }

std::string TinStart::refusal() const {
    const std::vector<LatticePoint> corners{{0, 0}, {width, 0}, {width, depth}, {0, depth}};
    if (places.size() < 4 || !std::equal(corners.begin(), corners.end(), places.begin())) {
        return "a TIN without its field's corners";
    }
    // The heights themselves are bounded, because the volumes of a hostile start would exceed 64 bits.
    const double area = static_cast<double>(width) * depth;
    const auto highest =
        static_cast<std::int32_t>(std::min<double>(kMaxHeight, static_cast<double>(kMostSand) / (6 * area)));
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (!within(places[i].x, 0, width) || !within(places[i].y, 0, depth)) {
            return "a TIN with a vertex outside its field";
        }
        if (!within(heights[i], -highest, highest)) {
            return "a TIN with a height of " + std::to_string(heights[i]) + "; at most " + std::to_string(highest) +
                   " is allowed";
        }
    }
    if (hasTwins(places)) {
        return "a TIN with two vertices in one place";
    }
    const auto last = static_cast<std::int32_t>(places.size()) - 1;
    for (const auto& [a, b] : constraints) {
        if (a < 0 || a >= b || b > last) {
            return "a TIN with a constraint that does not list two of its vertices, the smaller first";
        }
    }
    return "";
}

std::size_t TinStart::mostVertices() const {
    constexpr std::size_t kCrossings = 4096;  // more than any sensible session has at its limit
    return std::max(places.size(), static_cast<std::size_t>(settings.mostVertices)) + kCrossings;
}

std::uint64_t TinStart::digest() const {
    base::ByteWriter writer;
    encode(writer);
    const std::uint64_t digest = XXH3_64bits(writer.bytes().data(), writer.bytes().size());
    return digest == 0 ? 1 : digest;
}

}  // namespace sand::tin
