// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <type_traits>
#include <utility>

#include "scene/import/raster_heights.hpp"

namespace scene {

/// Size of a raster, which is known before its pixels are read.
struct RasterSize {
    int columns = 0, rows = 0;
    NumberSize numbers = NumberSize::doubles;
    bool complete = false;  // the header marks no number as no data, so that every pixel has a height

    /// Returns the memory that the heights take while they are read [byte].
    [[nodiscard]] std::int64_t bytes() const { return std::int64_t{bytesOf(numbers)} * columns * rows; }
};

/// Calls of a program while a raster is read. Each may be empty.
class RasterCheck {
public:
    /// Called with the size before the pixels are read. It throws to refuse the raster.
    using Size = std::function<void(const RasterSize& size)>;
    /// Called with the part of the pixels that is read, 0 to 1. It must not throw.
    using Progress = std::function<void(double share)>;

    RasterCheck() = default;
    template <class Function>
    requires std::is_convertible_v<Function, Size> RasterCheck(Function size, Progress progress = {})
        : size_(std::move(size)), progress_(std::move(progress)) {}

    void operator()(const RasterSize& size) const {
        if (size_) {
            size_(size);
        }
    }
    void read(double share) const {
        if (progress_) {
            progress_(share);
        }
    }

private:
    Size size_;
    Progress progress_;
};

}  // namespace scene
