// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace base {

/// Set of numbers from 0 up. clear() takes constant time. The set takes 4 bytes for every number up to the largest.
class IndexSet {
public:
    void clear() {
        if (++turn_ == 0) {
            std::fill(turns_.begin(), turns_.end(), 0);
            turn_ = 1;
        }
    }
    void reserve(std::size_t count) { turns_.resize(std::max(turns_.size(), count), 0); }
    /// Adds a number. Returns whether it is new.
    bool insert(std::int32_t number) {
        const auto at = static_cast<std::size_t>(number);
        if (at >= turns_.size()) {
            turns_.resize(at + at / 2 + 1, 0);
        }
        return insertReserved(number);
    }
    /// Adds a number that is less than the reserved count. Returns whether it is new.
    bool insertReserved(std::int32_t number) {
        const auto at = static_cast<std::size_t>(number);
        const bool isNew = turns_[at] != turn_;
        turns_[at] = turn_;
        return isNew;
    }
    /// Loads the entry of a number into the cache, because a caller needs it soon.
    void fetchReserved(std::int32_t number) const { __builtin_prefetch(turns_.data() + number); }

private:
    std::vector<std::uint32_t> turns_;  // turn in which each number was added last
    std::uint32_t turn_ = 1;
};

/// IndexSet that also lists its numbers, each once, in the order in which they were added.
class IndexList {
public:
    void clear() {
        set_.clear();
        all_.clear();
    }
    void reserve(std::size_t count) { set_.reserve(count); }
    void add(std::int32_t number) {
        if (set_.insert(number)) {
            all_.push_back(number);
        }
    }
    void add(const std::vector<std::int32_t>& numbers) {
        for (const std::int32_t number : numbers) {
            add(number);
        }
    }
    [[nodiscard]] const std::vector<std::int32_t>& all() const { return all_; }

private:
    IndexSet set_;
    std::vector<std::int32_t> all_;
};

}  // namespace base
