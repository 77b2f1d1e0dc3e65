// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sand {

/// Work that a computation may still do, counted in cells that a sweep visits and never in time. So every replica ends
/// it at the same place.
class WorkLimit {
public:
    explicit WorkLimit(std::int64_t cells) : left_(cells) {}

    /// Subtracts `cells` from the work that is left. If less is left, subtracts nothing more from now on, and returns
    /// false.
    [[nodiscard]] bool take(std::int64_t cells) {
        reached_ = reached_ || cells > left_;
        left_ -= reached_ ? 0 : cells;
        return !reached_;
    }
    [[nodiscard]] std::int64_t left() const { return reached_ ? 0 : left_; }  // [cell]
    /// Returns whether take() has returned false.
    [[nodiscard]] bool reached() const { return reached_; }

private:
    std::int64_t left_;
    bool reached_ = false;
};

}  // namespace sand
