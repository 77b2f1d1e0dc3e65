// SPDX-License-Identifier: Apache-2.0
// This file is compiled twice, as the sweeps of sand/ are: once for every x86-64 and once for x86-64-v3.
#include "bench/sand/baseline_schemes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bench::SANDWALL_CODE_PATH {
namespace {

/// Returns the part of a difference above the talus, with its sign.
inline float excess(float difference, float talus) {
    return difference - std::max(std::min(difference, talus), -talus);
}

// Each loop keeps the largest move of each column in `largest`, because a reduction to one number would not vectorise.

void balancePairs(float* __restrict first, int pairs, float talus, float* __restrict largest) {
    for (int i = 0; i < pairs; ++i) {
        const float move = 0.5F * excess(first[2 * i] - first[2 * i + 1], talus);
        first[2 * i] -= move;
        first[2 * i + 1] += move;
        largest[i] = std::max(largest[i], std::abs(move));
    }
}

void balanceRows(float* __restrict lower, float* __restrict upper, int count, float talus, float* __restrict largest) {
    for (int i = 0; i < count; ++i) {
        const float move = 0.5F * excess(lower[i] - upper[i], talus);
        lower[i] -= move;
        upper[i] += move;
        largest[i] = std::max(largest[i], std::abs(move));
    }
}

/// Balances every face once, from south to north. In a row the even faces come before the odd faces, because a vector
/// unit can take them together. One after another they would be eight times slower.
float inPlaceN4(float talus, FloatField& field, FloatField& scratch) {
    float* largest = scratch.row(0);
    std::fill_n(largest, field.side, 0.0F);
    for (int y = 0; y < field.side; ++y) {
        for (const int x : {0, 1}) {
            balancePairs(field.row(y) + x, (field.side - x) / 2, talus, largest);
        }
        if (y + 1 < field.side) {
            balanceRows(field.row(y), field.row(y + 1), field.side, talus, largest);
        }
    }
    return *std::max_element(largest, largest + field.side);
}

void rowN4(const float* __restrict south, const float* __restrict here, const float* __restrict north, int count,
           float talus, float* __restrict out, float* __restrict largest) {
    for (int i = 0; i < count; ++i) {
        const float h = here[i];
        const float change = 0.25F * (excess(h - here[i - 1], talus) + excess(h - here[i + 1], talus) +
                                      excess(h - south[i], talus) + excess(h - north[i], talus));
        out[i] = h - change;
        largest[i] = std::max(largest[i], std::abs(change));
    }
}

void rowN8(const float* __restrict south, const float* __restrict here, const float* __restrict north, int count,
           float talus, float diagonalTalus, float* __restrict out, float* __restrict largest) {
    for (int i = 0; i < count; ++i) {
        const float h = here[i];
        const float faces = excess(h - here[i - 1], talus) + excess(h - here[i + 1], talus) +
                            excess(h - south[i], talus) + excess(h - north[i], talus);
        const float corners = excess(h - south[i - 1], diagonalTalus) + excess(h - south[i + 1], diagonalTalus) +
                              excess(h - north[i - 1], diagonalTalus) + excess(h - north[i + 1], diagonalTalus);
        const float change = 0.125F * (faces + corners);
        out[i] = h - change;
        largest[i] = std::max(largest[i], std::abs(change));
    }
}

/// Computes each row of the next heights by `row(south, here, north, out, largest)`. Returns the largest change of a
/// cell [cell].
template <class Row>
float jacobi(FloatField& field, FloatField& scratch, const Row& row) {
    field.refreshGhosts();
    // The ghost row of `scratch` is free until the next refresh.
    float* largest = scratch.row(-1);
    std::fill_n(largest, field.side, 0.0F);
    for (int y = 0; y < field.side; ++y) {
        row(field.row(y - 1), field.row(y), field.row(y + 1), scratch.row(y), largest);
    }
    const float moved = *std::max_element(largest, largest + field.side);
    field.heights.swap(scratch.heights);
    return moved;
}

}  // namespace

float sweep(BaselineScheme scheme, float talus, FloatField& field, FloatField& scratch) {
    const int side = field.side;
    if (scheme == BaselineScheme::inPlaceN4) {
        return inPlaceN4(talus, field, scratch);
    }
    if (scheme == BaselineScheme::jacobiN4) {
        return jacobi(field, scratch, [=](auto south, auto here, auto north, auto out, auto largest) {
            rowN4(south, here, north, side, talus, out, largest);
        });
    }
    const float diagonal = scheme == BaselineScheme::jacobiN8r2 ? talus * std::numbers::sqrt2_v<float> : talus;
    return jacobi(field, scratch, [=](auto south, auto here, auto north, auto out, auto largest) {
        rowN8(south, here, north, side, talus, diagonal, out, largest);
    });
}

}  // namespace bench::SANDWALL_CODE_PATH
