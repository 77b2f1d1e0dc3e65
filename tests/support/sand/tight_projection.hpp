// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "sand/model/height_field.hpp"

/// The projection to which a certificate refers, solved as far as the precision of doubles allows. It is slow and
/// shares no code with the tested solver.
namespace reference {

/// The field nearest to `start` in which no quad is steeper than `steepest` [unit]. The steepness of a quad is the root
/// of half of its four squared differences. The solver takes dual gradient steps with momentum and restart. The field
/// must be closed, with square cells, and have at least 2 x 2 of them.
class TightProjection {
public:
    TightProjection(const sand::HeightField& start, double steepest)
        : columns_(start.columns()), rows_(start.rows()), radius_(std::sqrt(2.0) * steepest) {
        for (int y = 0; y < rows_; ++y) {
            for (int x = 0; x < columns_; ++x) {
                start_.push_back(start.height(x, y));
            }
        }
        heights_ = start_;
        now_.resize(start_.size());
        extrapolated_ = now_;
    }

    /// Iterates until no quad is steeper than allowed by more than a share of 1e-7, at most 200,000 times. Returns true
    /// if it has reached that.
    bool solve() {
        double weight = 1;
        for (int i = 0; i < 200000; ++i) {
            const double excess = computeHeights();
            if (i % 100 == 99 && excess <= 1e-7 * radius_ && stale_ <= 1e-7 * radius_) {
                return true;
            }
            weight = step(weight);
        }
        return false;
    }

    [[nodiscard]] double squaredDistanceTo(const sand::HeightField& field) const {
        double sum = 0;
        for (std::size_t i = 0; i < heights_.size(); ++i) {
            const auto cell = static_cast<int>(i);
            const double change = field.height(cell % columns_, cell / columns_) - heights_[i];
            sum += change * change;
        }
        return sum;
    }

private:
    using Faces = std::array<double, 4>;  // southern, northern, western, eastern

    [[nodiscard]] std::array<std::size_t, 4> corners(int x, int y) const {
        const auto a = static_cast<std::size_t>(y * columns_ + x);
        const auto row = static_cast<std::size_t>(columns_);
        return {a, a + 1, a + row, a + row + 1};
    }
    [[nodiscard]] Faces differences(int x, int y) const {
        const auto [a, b, c, d] = corners(x, y);
        return {heights_[b] - heights_[a], heights_[d] - heights_[c], heights_[c] - heights_[a],
                heights_[d] - heights_[b]};
    }
    static double length(const Faces& f) { return std::sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2] + f[3] * f[3]); }

    template <class Visit>
    void forEachQuad(Visit visit) const {
        for (int y = 0; y + 1 < rows_; ++y) {
            for (int x = 0; x + 1 < columns_; ++x) {
                visit(x, y, corners(x, y)[0]);
            }
        }
    }

    /// Computes the heights from the extrapolated pressures. Returns the greatest excess of a quad.
    double computeHeights() {
        heights_ = start_;
        forEachQuad([this](int x, int y, std::size_t quad) {
            const auto [a, b, c, d] = corners(x, y);
            const Faces& f = extrapolated_[quad];
            heights_[a] += f[0] + f[2];
            heights_[b] += f[3] - f[0];
            heights_[c] += f[1] - f[2];
            heights_[d] -= f[1] + f[3];
        });
        double excess = 0;
        forEachQuad([&](int x, int y, std::size_t) { excess = std::max(excess, length(differences(x, y)) - radius_); });
        return excess;
    }

    /// Takes a gradient step of 1/16, because the operator of the face differences has norm 8 and each face belongs to
    /// two quads.
    double step(double weight) {
        const std::vector<Faces> before = now_;
        double turn = 0;
        stale_ = 0;
        forEachQuad([&](int x, int y, std::size_t quad) {
            const Faces slope = differences(x, y);
            Faces next = extrapolated_[quad];
            for (std::size_t i = 0; i < 4; ++i) {
                next[i] += slope[i] / 16;
            }
            const double size = length(next);
            const double share = size > radius_ / 16 ? 1 - radius_ / 16 / size : 0.0;
            for (std::size_t i = 0; i < 4; ++i) {
                next[i] *= share;
                turn += (extrapolated_[quad][i] - next[i]) * (next[i] - before[quad][i]);
                stale_ = std::max(stale_, std::abs(next[i] - extrapolated_[quad][i]));
            }
            now_[quad] = next;
        });
        const double from = turn > 0 ? 1 : weight;
        const double to = 0.5 * (1 + std::sqrt(1 + 4 * from * from));
        forEachQuad([&](int, int, std::size_t quad) {
            for (std::size_t i = 0; i < 4; ++i) {
                extrapolated_[quad][i] = now_[quad][i] + (from - 1) / to * (now_[quad][i] - before[quad][i]);
            }
        });
        return to;
    }

    int columns_, rows_;
    double radius_;
    std::vector<double> start_, heights_;
    std::vector<Faces> now_, extrapolated_;
    double stale_ = 1e300;  // greatest change in the last step
};

}  // namespace reference
