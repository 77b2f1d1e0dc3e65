// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <random>

#include "sand/model/units.hpp"

namespace structure {

/// Random numbers of one input. They depend on the seed and on the number of the input, so that inputs can be tried in
/// any order and in parts.
class Chance {
public:
    Chance(std::uint32_t seed, std::uint64_t input) {
        std::seed_seq mixed{seed, static_cast<std::uint32_t>(input), static_cast<std::uint32_t>(input >> 32U)};
        random_.seed(mixed);
    }

    /// Returns a number from 0 to `end` - 1; 0 if `end` is 0.
    std::size_t below(std::size_t end) { return end == 0 ? 0 : random_() % end; }
    bool oneIn(std::size_t count) { return below(count) == 0; }
    template <class List>
    auto& of(List& list) {
        return list[below(list.size())];
    }
    /// Returns a number at the end of a range, or one that is small or random.
    std::int32_t odd() {
        constexpr std::int32_t kMost = sand::kMaxHeight;
        constexpr std::array kEnds{0,
                                   1,
                                   -1,
                                   kMost,
                                   -kMost,
                                   kMost + 1,
                                   -kMost - 1,
                                   kMost / 2,
                                   -kMost / 2,
                                   kMost / 2 + 1,
                                   std::numeric_limits<std::int32_t>::max(),
                                   std::numeric_limits<std::int32_t>::min()};
        const auto any = static_cast<std::int32_t>(random_());
        return oneIn(2) ? of(kEnds) : oneIn(2) ? any : any % (4 * sand::kUnitsPerCell);
    }
    std::int64_t wide() {
        constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
        constexpr std::array kEnds{std::int64_t{0}, kMost, -kMost - 1, std::int64_t{1} << 62, -(std::int64_t{1} << 62)};
        return oneIn(3) ? of(kEnds) : static_cast<std::int64_t>(odd()) << below(33);
    }
    std::mt19937& engine() { return random_; }

private:
    std::mt19937 random_;
};

}  // namespace structure
