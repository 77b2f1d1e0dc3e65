// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

#include "sand/grid/erosion.hpp"
#include "tests/support/sand/laws.hpp"

/// Helpers that let fields slide to rest, for tests of the solver.
namespace samples {

/// A sweep takes some twenty times as long under the address sanitizer. So its builds leave out the largest grids,
/// which the other builds test.
#ifdef __SANITIZE_ADDRESS__
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

/// A slow build takes ten times as long as a release build. Its tests run fewer of many similar cases.
#ifdef __OPTIMIZE__
inline constexpr bool kSlowBuild = kSanitized;
#else
inline constexpr bool kSlowBuild = true;
#endif

/// Sweeps until no sand moves. Expects that the volume stays and that no new extreme arises, which holds for any field
/// in a closed box. Returns the number of sweeps.
inline std::int64_t relax(sand::HeightField& field, const sand::Rules& rules, int most = 1000000) {
    const std::int64_t volume = field.volume();
    const Extremes before = extremesOf(field);
    sand::grid::Erosion erosion(field, rules);
    const std::int64_t outflow = erosion.sweep(field, most);
    EXPECT_TRUE(erosion.settled()) << nameOf(Law(rules.scheme)) << " still moves after " << most << " sweeps";
    EXPECT_EQ(field.volume() + outflow, volume);
    const Extremes after = extremesOf(field);
    EXPECT_GE(after.lowest, rules.rim == sand::Rim::open ? std::min(before.lowest, 0) : before.lowest);
    EXPECT_LE(after.highest, before.highest);
    return erosion.sweepsDone();
}

}  // namespace samples
