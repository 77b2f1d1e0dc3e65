// SPDX-License-Identifier: Apache-2.0
#include "shapes/model/grain.hpp"

#include <gtest/gtest.h>

namespace {

using shapes::kGrainSide;

TEST(Grain, IsAsBrightOnAverageAsSmoothSand) {
    const std::vector<std::uint8_t> texels = shapes::makeGrain({0.7F, 0.7F});
    for (const std::size_t channel : {0U, 1U}) {
        double sum = 0;
        for (std::size_t i = channel; i < texels.size(); i += 4) {
            sum += texels[i];
        }
        EXPECT_NEAR(sum / (kGrainSide * kGrainSide), 127.5, 2) << "channel " << channel;
    }
}

}  // namespace
