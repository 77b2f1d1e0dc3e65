// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/refine/border.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>

namespace sand::tin {
namespace {

std::int32_t wayBetween(const LatticePoint& a, const LatticePoint& b) {
    return std::abs(b.x - a.x) + std::abs(b.y - a.y);
}

class BorderMaker {
public:
    BorderMaker(std::span<const double> heights, const Cells& cells, const Holes* holes, double maxError,
                const LongestEdges& longest)
        : heights_(heights), cells_(cells), holes_(holes), maxError_(maxError), longest_(longest) {
        for (const LatticePoint& corner : corners()) {
            numbers_.emplace(corner, static_cast<Vertex>(numbers_.size()));
        }
    }

    Border take() {
        if (holes_ != nullptr) {
            for (const Holes::Part& part : holes_->outline()) {
                const std::vector<Vertex> along = add(part.from, part.to, longest_.onOutline);
                for (std::size_t i = 1; i < along.size(); ++i) {
                    border_.edges.emplace_back(std::minmax(along[i - 1], along[i]));
                }
            }
        }
        const auto [southWest, southEast, northEast, northWest] = corners();
        if (cells_.first.y > 0) {
            addSide(southWest, southEast);
            addSide(northWest, northEast);
        }
        if (cells_.first.x > 0) {
            addSide(southWest, northWest);
            addSide(southEast, northEast);
        }
        return std::move(border_);
    }

private:
    [[nodiscard]] std::array<LatticePoint, 4> corners() const {
        return {LatticePoint{0, 0}, {cells_.width, 0}, {cells_.width, cells_.depth}, {0, cells_.depth}};
    }
    [[nodiscard]] bool isGround(int column, int row) const {
        return column >= 0 && row >= 0 && column < cells_.columns && row < cells_.rows &&
               !std::isnan(sample(column, row));
    }
    [[nodiscard]] double sample(int column, int row) const {
        return heights_[static_cast<std::size_t>(row) * static_cast<std::size_t>(cells_.columns) +
                        static_cast<std::size_t>(column)];
    }
    /// Returns the mean of the samples of the ground beside a place. Returns not a number if there is no ground.
    [[nodiscard]] double heightAt(const LatticePoint& place) const {
        const int east = cells_.columnOf(2 * std::int64_t{place.x} + 1, 2);
        const int west = cells_.columnOf(2 * std::int64_t{place.x} - 1, 2);
        const int north = cells_.rowOf(2 * std::int64_t{place.y} + 1, 2);
        const int south = cells_.rowOf(2 * std::int64_t{place.y} - 1, 2);
        double sum = 0, count = 0;
        for (int row = south; row <= north; ++row) {
            for (int column = west; column <= east; ++column) {
                if (isGround(column, row)) {
                    sum += sample(column, row);
                    count += 1;
                }
            }
        }
        return sum / count;
    }

    /// Both ends of a straight part and the places beside the cell centres between them, in order. `wanted` marks
    /// the places that the border gets.
    struct Chain {
        std::vector<LatticePoint> places;
        std::vector<double> heights;
        std::vector<bool> wanted;
    };
    [[nodiscard]] Chain chainOf(const LatticePoint& from, const LatticePoint& to) const {
        Chain chain;
        const auto append = [&](const LatticePoint& place) {
            if (const double height = heightAt(place); !std::isnan(height)) {
                chain.places.push_back(place);
                chain.heights.push_back(height);
            }
        };
        append(from);
        for (int column = cells_.columnOf(from.x); column <= cells_.columnOf(to.x); ++column) {
            const std::int32_t x = cells_.first.x + column * cells_.spacing.x;
            if (x > from.x && x < to.x) {
                append({x, from.y});
            }
        }
        for (int row = cells_.rowOf(from.y); row <= cells_.rowOf(to.y); ++row) {
            const std::int32_t y = cells_.first.y + row * cells_.spacing.y;
            if (y > from.y && y < to.y) {
                append({from.x, y});
            }
        }
        append(to);
        chain.wanted.assign(chain.places.size(), false);
        if (!chain.wanted.empty()) {
            chain.wanted.front() = chain.wanted.back() = true;
        }
        return chain;
    }

    /// Marks the place that is farthest from the line between two marked places, again and again.
    void thinOut(Chain& chain, std::int32_t longest) const {
        std::vector<std::pair<std::size_t, std::size_t>> open{{0, chain.places.size() - 1}};
        while (!open.empty()) {
            const auto [first, last] = open.back();
            open.pop_back();
            const double way = wayBetween(chain.places[first], chain.places[last]);
            double worst = maxError_;
            std::size_t at = first;
            for (std::size_t i = first + 1; i < last; ++i) {
                const double share = wayBetween(chain.places[first], chain.places[i]) / way;
                const double line = chain.heights[first] + share * (chain.heights[last] - chain.heights[first]);
                if (const double error = std::abs(chain.heights[i] - line); error > worst) {
                    worst = error;
                    at = i;
                }
            }
            if (at == first && last > first + 1 && longest > 0 && way > longest) {
                at = first + (last - first) / 2;
            }
            if (at != first) {
                chain.wanted[at] = true;
                open.insert(open.end(), {{first, at}, {at, last}});
            }
        }
    }

    /// Adds the straight part between two places to the border. Returns the vertices along it, with both ends.
    std::vector<Vertex> add(const LatticePoint& from, const LatticePoint& to, std::int32_t longest) {
        Chain chain = chainOf(from, to);
        std::vector<Vertex> along;
        if (chain.places.empty()) {
            return along;
        }
        thinOut(chain, longest);
        for (std::size_t i = 0; i < chain.places.size(); ++i) {
            if (!chain.wanted[i]) {
                continue;
            }
            const auto [found, fresh] = numbers_.emplace(chain.places[i], static_cast<Vertex>(numbers_.size()));
            if (fresh) {
                border_.places.push_back(chain.places[i]);
                border_.heights.push_back(chain.heights[i]);
            }
            along.push_back(found->second);
        }
        return along;
    }

    /// Adds a side of the field, part by part from one existing vertex to the next.
    void addSide(const LatticePoint& from, const LatticePoint& to) {
        std::vector<LatticePoint> there;
        for (auto found = numbers_.lower_bound(from); found != numbers_.end() && found->first <= to; ++found) {
            if (doubledArea(from, to, found->first) == 0) {
                there.push_back(found->first);
            }
        }
        for (std::size_t i = 1; i < there.size(); ++i) {
            const LatticePoint& a = there[i - 1];
            const LatticePoint& b = there[i];
            // A part has either ground all along or no ground. Look at its middle, because it may be only half a cell
            // long.
            const LatticePoint middle{a.x + (b.x - a.x) / 2, a.y + (b.y - a.y) / 2};
            if (!std::isnan(heightAt(middle))) {
                add(a, b, longest_.onRim);
            }
        }
    }

    std::span<const double> heights_;
    const Cells& cells_;
    const Holes* holes_;
    double maxError_;
    LongestEdges longest_;
    std::map<LatticePoint, Vertex> numbers_;  // of corners and border
    Border border_;
};

}  // namespace

std::shared_ptr<const Holes> holesOf(std::span<const double> heights, const Cells& cells) {
    std::vector<Holes::Run> runs;
    for (std::size_t i = 0; i < heights.size(); ++i) {
        const auto row = static_cast<std::int32_t>(i / static_cast<std::size_t>(cells.columns));
        const auto column = static_cast<std::int32_t>(i % static_cast<std::size_t>(cells.columns));
        if (!std::isnan(heights[i])) {
            continue;
        }
        if (runs.empty() || runs.back().row != row || runs.back().end != column) {
            runs.push_back({row, column, column});
        }
        runs.back().end = column + 1;
    }
    return runs.empty() ? nullptr : std::make_shared<const Holes>(cells, std::move(runs));
}

Border borderOf(std::span<const double> heights, const Cells& cells, const Holes* holes, double maxError,
                const LongestEdges& longest) {
    return BorderMaker(heights, cells, holes, maxError, longest).take();
}

}  // namespace sand::tin
