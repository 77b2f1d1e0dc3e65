// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace base {

/// Numbers from 0 on. To clear it costs nothing; it takes four bytes for every number up to the largest.
class IndexSet {
public:
    void clear() {
        if (++turn_ == 0) {
            std::fill(turns_.begin(), turns_.end(), 0);
            turn_ = 1;
        }
    }
    void reserve(std::size_t count) { turns_.resize(std::max(turns_.size(), count), 0); }
    /// Whether it is new.
    bool insert(std::int32_t number) {
        const auto at = static_cast<std::size_t>(number);
        if (at >= turns_.size()) {
            turns_.resize(at + at / 2 + 1, 0);
        }
        return insertReserved(number);
    }
    /// The same for a number below what was reserved.
    bool insertReserved(std::int32_t number) {
        const auto at = static_cast<std::size_t>(number);
        const bool isNew = turns_[at] != turn_;
        turns_[at] = turn_;
        return isNew;
    }
    /// Somebody will ask for it soon.
    void fetchReserved(std::int32_t number) const { __builtin_prefetch(turns_.data() + number); }

private:
    std::vector<std::uint32_t> turns_;  // in which it was put in last
    std::uint32_t turn_ = 1;
};

/// A set that can be walked through: its numbers in the order in which they came, each once.
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
