// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/packed_cells.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace sand::grid {
namespace {

constexpr std::size_t kVector = 16, kVectors = 32, kNumbers = kVector * kVectors;  // of a group
using Numbers = std::array<std::uint32_t, kNumbers>;

/// Maps numbers of small magnitude to small numbers.
constexpr std::uint32_t folded(std::uint32_t number) { return (number << 1) ^ (0 - (number >> 31)); }
constexpr std::uint32_t unfolded(std::uint32_t number) { return (number >> 1) ^ (0 - (number & 1)); }

/// Writes the numbers of a group, folded, or their differences to those of `before`. Returns the bits that any has.
std::uint32_t fold(const std::int32_t* plain, Numbers& to) {
    std::uint32_t any = 0;
    for (std::size_t i = 0; i < kNumbers; ++i) {
        to[i] = folded(static_cast<std::uint32_t>(plain[i]));
        any |= to[i];
    }
    return any;
}
std::uint32_t foldDifferences(const std::int32_t* plain, const std::int32_t* before, Numbers& to) {
    std::uint32_t any = 0;
    for (std::size_t i = 0; i < kNumbers; ++i) {
        to[i] = folded(static_cast<std::uint32_t>(plain[i]) - static_cast<std::uint32_t>(before[i]));
        any |= to[i];
    }
    return any;
}

void pack(const Numbers& numbers, unsigned bits, std::uint32_t* words) {
    std::array<std::uint32_t, kVector> word{};
    unsigned used = 0;  // bits of `word`
    for (std::size_t vector = 0; bits > 0 && vector < kVectors; ++vector) {
        const std::uint32_t* const from = numbers.data() + vector * kVector;
        for (std::size_t lane = 0; lane < kVector; ++lane) {
            word[lane] |= from[lane] << used;
        }
        used += bits;
        if (used < 32) {
            continue;
        }
        words = std::copy(word.begin(), word.end(), words);
        used -= 32;
        for (std::size_t lane = 0; lane < kVector; ++lane) {
            word[lane] = used > 0 ? from[lane] >> (bits - used) : 0;
        }
    }
}

void unpack(const std::uint32_t* words, unsigned bits, Numbers& numbers) {
    const std::uint32_t mask = bits == 32 ? ~0U : (1U << bits) - 1;
    unsigned used = 0;  // bits of the words that earlier vectors have
    for (std::size_t vector = 0; vector < kVectors; ++vector) {
        std::uint32_t* const to = numbers.data() + vector * kVector;
        if (bits == 0) {
            std::fill_n(to, kVector, 0U);
            continue;
        }
        for (std::size_t lane = 0; lane < kVector; ++lane) {
            to[lane] = words[lane] >> used;
        }
        if (used + bits > 32) {
            for (std::size_t lane = 0; lane < kVector; ++lane) {
                to[lane] |= words[kVector + lane] << (32 - used);
            }
        }
        for (std::size_t lane = 0; lane < kVector; ++lane) {
            to[lane] = unfolded(to[lane] & mask);
        }
        used += bits;
        words += used >= 32 ? kVector : 0;
        used -= used >= 32 ? 32 : 0;
    }
}

}  // namespace

std::size_t PackedCells::across() const {
    return (static_cast<std::size_t>(cells_.x1 - cells_.x0) + kVector - 1) / kVector * kVector;
}

/// Returns the numbers row by row, after one row that holds what the differences of the first row refer to.
std::vector<std::int32_t> PackedCells::plainOf(const CellArray& grid, int first) const {
    const std::size_t width = across(), rows = static_cast<std::size_t>(cells_.y1 - cells_.y0);
    const std::size_t groups = (width * rows + kNumbers - 1) / kNumbers;
    std::vector<std::int32_t> plain(width + groups * kNumbers);
    std::int32_t* to = plain.data() + width;
    for (int y = cells_.y0; y < cells_.y1; ++y, to += width) {
        const std::int32_t* const row = grid.row(y - first);
        std::int32_t* const end = std::copy(row + cells_.x0, row + cells_.x1, to);
        std::fill(end, to + width, row[cells_.x1 - 1]);
    }
    for (; to != plain.data() + plain.size(); ++to) {  // fills the last group with numbers whose differences are 0
        *to = *(to - width);
    }
    plain[0] = plain[width];
    std::copy_n(plain.data() + width, width - 1, plain.data() + 1);
    return plain;
}

PackedCells::PackedCells(const CellArray& grid, const CellRect& cells, int first) : cells_(cells) {
    static_assert(kLanes == kVector && kGroup == kVectors);
    const std::vector<std::int32_t> plain = plainOf(grid, first);
    const std::size_t width = across();
    first_ = plain[0];
    groups_.resize((plain.size() - width) / kNumbers);
    Numbers numbers{};
    std::size_t words = 0;
    isZero_ = true;
    for (std::size_t i = 0; i < groups_.size(); ++i) {
        const std::int32_t* const here = plain.data() + width + i * kNumbers;
        const auto bits = static_cast<unsigned>(std::bit_width(fold(here, numbers)));
        const auto ofDifferences = static_cast<unsigned>(std::bit_width(foldDifferences(here, here - width, numbers)));
        isZero_ = isZero_ && bits == 0;
        groups_[i] = {static_cast<std::uint8_t>(std::min(bits, ofDifferences)), ofDifferences < bits, words};
        words += groups_[i].bits * kVector;
    }
    words_.resize(words);
    for (std::size_t i = 0; i < groups_.size(); ++i) {
        const std::int32_t* const here = plain.data() + width + i * kNumbers;
        (void)(groups_[i].differences ? foldDifferences(here, here - width, numbers) : fold(here, numbers));
        pack(numbers, groups_[i].bits, words_.data() + groups_[i].words);
    }
}

std::vector<std::int32_t> PackedCells::unpacked() const {
    const std::size_t width = across();
    std::vector<std::int32_t> plain(width + groups_.size() * kNumbers);
    Numbers numbers{};
    for (std::size_t i = 0; i < groups_.size(); ++i) {
        std::int32_t* const here = plain.data() + width + i * kNumbers;
        unpack(words_.data() + groups_[i].words, groups_[i].bits, numbers);
        for (std::size_t n = 0; n < kNumbers; n += kVector) {
            std::array<std::uint32_t, kVector> before{};  // a vector, because a row has at least as many numbers
            const std::size_t place = i * kNumbers + n;
            if (groups_[i].differences && place >= width) {
                std::copy_n(here + n - width, kVector, before.begin());
            }
            for (std::size_t lane = 0; lane < kVector; ++lane) {
                here[n + lane] = static_cast<std::int32_t>(numbers[n + lane] + before[lane]);
            }
            for (std::size_t lane = 0; groups_[i].differences && place < width && lane < kVector; ++lane) {
                const std::int32_t west = place + lane == 0 ? first_ : here[n + lane - 1];
                here[n + lane] = static_cast<std::int32_t>(numbers[n + lane] + static_cast<std::uint32_t>(west));
            }
        }
    }
    return plain;
}

void PackedCells::putInto(CellArray& grid, int first, int end, int to) const {
    const std::vector<std::int32_t> plain = unpacked();
    for (int y = std::max(first, cells_.y0); y < std::min(end, cells_.y1); ++y) {
        const std::int32_t* const row = plain.data() + across() * static_cast<std::size_t>(y - cells_.y0 + 1);
        std::copy_n(row, cells_.x1 - cells_.x0, grid.row(y - first + to) + cells_.x0);
    }
}

std::vector<std::int32_t> PackedCells::numbers() const {
    const std::vector<std::int32_t> plain = unpacked();
    const auto columns = static_cast<std::size_t>(cells_.x1 - cells_.x0);
    std::vector<std::int32_t> numbers;
    numbers.reserve(columns * static_cast<std::size_t>(cells_.y1 - cells_.y0));
    for (int y = cells_.y0; y < cells_.y1; ++y) {
        const std::int32_t* const row = plain.data() + across() * static_cast<std::size_t>(y - cells_.y0 + 1);
        numbers.insert(numbers.end(), row, row + columns);
    }
    return numbers;
}

}  // namespace sand::grid
