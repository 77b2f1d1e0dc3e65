// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/geometry/tin_start.hpp"

#include <xxhash.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "sand/model/height_field.hpp"

namespace sand::tin {
namespace {

std::int32_t between(base::ByteReader& reader, std::int32_t lowest, std::int32_t highest) {
    const auto number = reader.get<std::int32_t>();
    if (number < lowest || number > highest) {
        throw base::FormatError("a TIN with a number out of range");
    }
    return number;
}

std::size_t countOf(base::ByteReader& reader) {
    const auto count = reader.get<std::uint64_t>();
    if (count > kMostPlaces) {
        throw base::FormatError("a TIN with too many vertices");
    }
    return count;
}

constexpr std::int32_t kKeeps = 1, kHasHoles = 2;  // bits after the settings

void encodeHoles(const Holes& holes, base::ByteWriter& writer) {
    writer.put(static_cast<std::uint64_t>(holes.runs().size()));
    for (const Holes::Run& run : holes.runs()) {
        writer.put(run.row);
        writer.put(run.first);
        writer.put(run.end);
    }
}

std::shared_ptr<const Holes> decodeHoles(base::ByteReader& reader, const TinStart& start) {
    if (start.width % kLatticePerCell != 0 || start.depth % kLatticePerCell != 0) {
        throw base::FormatError("a TIN with holes in cells that are not whole");
    }
    const Cells cells = nominalCells(start.width, start.depth);
    std::vector<Holes::Run> runs;
    for (std::size_t left = countOf(reader); left > 0; --left) {
        Holes::Run run;
        run.row = between(reader, 0, cells.rows - 1);
        run.first = between(reader, 0, cells.columns - 1);
        run.end = between(reader, 1, cells.columns);
        runs.push_back(run);
    }
    try {
        return std::make_shared<const Holes>(cells, std::move(runs));
    } catch (const std::invalid_argument& wrong) {
        throw base::FormatError(std::string("not a TIN: ") + wrong.what());
    }
}

void requireCorners(const TinStart& start) {
    const std::vector<Place> corners{{0, 0}, {start.width, 0}, {start.width, start.depth}, {0, start.depth}};
    if (start.places.size() < 4 || !std::equal(corners.begin(), corners.end(), start.places.begin())) {
        throw base::FormatError("a TIN without its field's corners");
    }
    std::vector<Place> sorted = start.places;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
        throw base::FormatError("a TIN with two vertices in one place");
    }
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

void TinStart::encode(base::ByteWriter& writer) const {
    for (const std::int32_t number :
         {width, depth, meanHeight, settings.spacing, settings.widest, settings.maxError, settings.mostVertices,
          (settings.keepConstraints ? kKeeps : 0) | (holes != nullptr ? kHasHoles : 0)}) {
        writer.put(number);
    }
    writer.put(static_cast<std::uint64_t>(places.size()));
    for (std::size_t i = 0; i < places.size(); ++i) {
        writer.put(places[i].x);
        writer.put(places[i].y);
        writer.put(heights[i]);
    }
    writer.put(static_cast<std::uint64_t>(constraints.size()));
    for (const auto& [a, b] : constraints) {
        writer.put(a);
        writer.put(b);
    }
    if (holes != nullptr) {
        encodeHoles(*holes, writer);
    }
}

TinStart TinStart::decode(base::ByteReader& reader) {
    constexpr std::int32_t kLongest = kMaxSide * kLatticePerCell;
    TinStart start;
    start.width = between(reader, 1, kLongest);
    start.depth = between(reader, 1, kLongest);
    start.meanHeight = between(reader, -kMaxHeight, kMaxHeight);
    // The heights themselves are bounded, because the volumes of a hostile start would exceed 64 bits.
    const double area = static_cast<double>(start.width) * start.depth;
    const auto highest =
        static_cast<std::int32_t>(std::min<double>(kMaxHeight, static_cast<double>(kMostSand) / (6 * area)));
    start.settings.spacing = between(reader, 1, kLongest);
    start.settings.widest = between(reader, 0, kLongest);
    start.settings.maxError = between(reader, 0, kMaxHeight);
    start.settings.mostVertices = between(reader, 4, std::int32_t{kMostPlaces});
    const std::int32_t bits = between(reader, 0, kKeeps | kHasHoles);
    start.settings.keepConstraints = (bits & kKeeps) != 0;
    for (std::size_t left = countOf(reader); left > 0; --left) {
        const std::int32_t x = between(reader, 0, start.width);
        start.places.push_back({x, between(reader, 0, start.depth)});
        start.heights.push_back(between(reader, -highest, highest));
    }
    requireCorners(start);
    const auto last = static_cast<std::int32_t>(start.places.size()) - 1;
    for (std::size_t left = countOf(reader); left > 0; --left) {
        const std::int32_t a = between(reader, 0, last);
        const std::int32_t b = between(reader, 0, last);
        if (a >= b) {
            throw base::FormatError("a TIN with a constraint that does not list its smaller vertex first");
        }
        start.constraints.emplace_back(a, b);
    }
    if ((bits & kHasHoles) != 0) {
        start.holes = decodeHoles(reader, start);
    }
    return start;
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
