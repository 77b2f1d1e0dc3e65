// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/hand/pointer.hpp"

#include <gtest/gtest.h>

#include "base/byte_stream.hpp"

namespace {

using sand::kMaxProbe;

/// Returns whether a report with a sample at `probe` is accepted.
bool mayBeAt(const sand::ProbePoint& probe) {
    haptic_bridge::PointerReport report;
    report.count = 1;
    report.samples[0].probe = probe;
    try {
        requireValid(report);
    } catch (const base::FormatError&) {
        return false;
    }
    return true;
}

TEST(PointerPlace, MayBeWhereverTheToolMayBe) {
    for (const std::int32_t number : {-kMaxProbe, -1, 0, 1, kMaxProbe - 1}) {
        EXPECT_TRUE(mayBeAt({number, number, number})) << number;
    }
    for (const std::int32_t number : {-kMaxProbe - 1, kMaxProbe}) {
        EXPECT_FALSE(mayBeAt({number, 0, 0})) << number;
        EXPECT_FALSE(mayBeAt({0, number, 0})) << number;
        EXPECT_FALSE(mayBeAt({0, 0, number})) << number;
    }
}

}  // namespace
