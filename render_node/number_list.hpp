// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace render_node {

/// Whole numbers from 0 on, each once, in the order in which they came. Takes a byte for each that there could be, and
/// costs what is put in.
class NumberList {
public:
    /// From now on numbers are below this, which must not be less than before.
    void growTo(std::size_t count) { marks_.resize(count); }
    void add(std::int32_t number) {
        std::uint8_t& mark = marks_[static_cast<std::size_t>(number)];
        if (mark == 0) {
            mark = 1;
            all_.push_back(number);
        }
    }
    void clear() {
        for (const std::int32_t number : all_) {
            marks_[static_cast<std::size_t>(number)] = 0;
        }
        all_.clear();
    }
    [[nodiscard]] const std::vector<std::int32_t>& all() const { return all_; }

private:
    std::vector<std::uint8_t> marks_;
    std::vector<std::int32_t> all_;
};

}  // namespace render_node
