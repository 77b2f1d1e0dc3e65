// SPDX-License-Identifier: Apache-2.0
#include "sand/model/mean_height.hpp"

namespace sand {

double meanHeight(const HeightAt& heightAt, double x, double y, double radius, int samples) {
    const int half = samples / 2;
    double sum = 0;
    for (int j = -half; j <= half; ++j) {
        for (int i = -half; i <= half; ++i) {
            sum += heightAt(x + radius * i / half, y + radius * j / half);
        }
    }
    return sum / (samples * samples);
}

}  // namespace sand
