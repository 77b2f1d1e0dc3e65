// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/start.hpp"

#include <xxhash.h>

#include <algorithm>

#include "sand/height_field.hpp"

namespace sand::tin {
namespace {

constexpr std::uint64_t kMostVertices = 1 << 24;

std::int32_t between(files::ByteReader& reader, std::int32_t lowest, std::int32_t highest) {
    const auto number = reader.get<std::int32_t>();
    if (number < lowest || number > highest) {
        throw files::FormatError("a TIN with a number out of range");
    }
    return number;
}

std::size_t countOf(files::ByteReader& reader) {
    const auto count = reader.get<std::uint64_t>();
    if (count > kMostVertices) {
        throw files::FormatError("a TIN with too many vertices");
    }
    return count;
}

void requireCorners(const Start& start) {
    const std::vector<Place> corners{{0, 0}, {start.width, 0}, {start.width, start.depth}, {0, start.depth}};
    if (start.places.size() < 4 || !std::equal(corners.begin(), corners.end(), start.places.begin())) {
        throw files::FormatError("a TIN without its field's corners");
    }
    std::vector<Place> sorted = start.places;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
        throw files::FormatError("a TIN with two vertices in one place");
    }
}

}  // namespace

void Start::encode(files::ByteWriter& writer) const {
    for (const std::int32_t number : {width, depth, meanHeight, settings.spacing, settings.widest, settings.maxError,
                                      settings.mostVertices, std::int32_t{settings.keepConstraints ? 1 : 0}}) {
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
}

Start Start::decode(files::ByteReader& reader) {
    constexpr std::int32_t kLongest = kMaxSide * kLatticePerCell;
    Start start;
    start.width = between(reader, 1, kLongest);
    start.depth = between(reader, 1, kLongest);
    start.meanHeight = between(reader, -kMaxHeight, kMaxHeight);
    start.settings.spacing = between(reader, 1, kLongest);
    start.settings.widest = between(reader, 0, kLongest);
    start.settings.maxError = between(reader, 0, kMaxHeight);
    start.settings.mostVertices = between(reader, 4, kMostVertices);
    start.settings.keepConstraints = between(reader, 0, 1) != 0;
    for (std::size_t left = countOf(reader); left > 0; --left) {
        const std::int32_t x = between(reader, 0, start.width);
        start.places.push_back({x, between(reader, 0, start.depth)});
        start.heights.push_back(between(reader, -kMaxHeight, kMaxHeight));
    }
    requireCorners(start);
    const auto last = static_cast<std::int32_t>(start.places.size()) - 1;
    for (std::size_t left = countOf(reader); left > 0; --left) {
        const std::int32_t a = between(reader, 0, last);
        const std::int32_t b = between(reader, 0, last);
        if (a >= b) {
            throw files::FormatError("a TIN with an edge of nobody");
        }
        start.constraints.emplace_back(a, b);
    }
    return start;
}

std::uint64_t Start::digest() const {
    files::ByteWriter writer;
    encode(writer);
    const std::uint64_t digest = XXH3_64bits(writer.bytes().data(), writer.bytes().size());
    return digest == 0 ? 1 : digest;
}

}  // namespace sand::tin
