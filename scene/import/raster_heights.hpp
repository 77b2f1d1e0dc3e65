// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <utility>
#include <variant>
#include <vector>

#include "sand/model/cell_array.hpp"

namespace scene {

/// Size in which a raster's numbers are held: floats hold whole numbers of up to 16 bits exactly.
enum class NumberSize { floats, doubles };

/// Returns the memory that one number takes [byte].
[[nodiscard]] constexpr int bytesOf(NumberSize size) {
    return static_cast<int>(size == NumberSize::floats ? sizeof(float) : sizeof(double));
}

/// Heights of a raster, row by row from the north. A height that is not a number means no data.
///
/// Holds the numbers of the source, and what makes heights of them. Each access computes the height in doubles, so that
/// it is the same for numbers of either size. Not thread-safe.
class RasterHeights {
public:
    RasterHeights() : RasterHeights(NumberSize::doubles) {}
    /// Numbers that are added to floats must be floats, or whole numbers of up to 16 bits.
    explicit RasterHeights(NumberSize size);
    // Not explicit, so that a grid can be written as a list of its members.
    RasterHeights(std::vector<double> heights) : numbers_(std::move(heights)) {}
    RasterHeights(std::initializer_list<double> heights) : RasterHeights(std::vector<double>(heights)) {}

    void reserve(std::size_t count);
    /// Adds a height. Call it before multiply() and divide(), which change the heights that are there.
    void add(double height) {
        if (auto* floats = std::get_if<Floats>(&numbers_)) {
            floats->push_back(static_cast<float>(height));
        } else {
            std::get<Doubles>(numbers_).push_back(height);
        }
    }

    [[nodiscard]] std::size_t size() const {
        return std::visit([](const auto& numbers) { return numbers.size(); }, numbers_);
    }
    [[nodiscard]] bool empty() const { return size() == 0; }
    [[nodiscard]] double operator[](std::size_t index) const {
        const auto* floats = std::get_if<Floats>(&numbers_);
        double height = floats != nullptr ? (*floats)[index] : (*std::get_if<Doubles>(&numbers_))[index];
        for (const Change& change : changes_) {
            height = change.divides ? height / change.by : height * change.by + change.more;
        }
        return height;
    }

    /// Makes height * factor + summand of every height.
    void multiply(double factor, double summand);
    /// Makes height / divisor of every height.
    void divide(double divisor);
    /// Exchanges north and south of a raster with so many columns.
    void turnOver(int columns);
    /// Keeps a part of a raster with so many columns, without a second copy. Rows of `part` count from the north.
    void keepPart(int columns, const sand::CellRect& part);

    /// Iterator that returns heights by value. All of them belong to the same heights, which must outlive it.
    class Iterator {
    public:
        using iterator_category = std::input_iterator_tag;
        using value_type = double;
        using difference_type = std::ptrdiff_t;
        using pointer = const double*;
        using reference = double;

        Iterator(const RasterHeights& heights, std::size_t at) : heights_(&heights), at_(at) {}
        double operator*() const { return (*heights_)[at_]; }
        Iterator& operator++() {
            ++at_;
            return *this;
        }
        Iterator operator++(int) { return std::exchange(*this, Iterator(*heights_, at_ + 1)); }
        friend bool operator==(const Iterator& a, const Iterator& b) { return a.at_ == b.at_; }

    private:
        const RasterHeights* heights_;
        std::size_t at_;
    };
    using const_iterator = Iterator;
    [[nodiscard]] Iterator begin() const { return {*this, 0}; }
    [[nodiscard]] Iterator end() const { return {*this, size()}; }

    /// Compares heights, whatever their size. Heights without data are never equal.
    friend bool operator==(const RasterHeights& a, const RasterHeights& b);

private:
    using Floats = std::vector<float>;
    using Doubles = std::vector<double>;
    /// A division, or a multiplication and an addition. A division by 1 / x would round differently.
    struct Change {
        bool divides = false;
        double by = 1, more = 0;
    };

    std::variant<Floats, Doubles> numbers_;
    std::vector<Change> changes_;  // in their order
};

}  // namespace scene
