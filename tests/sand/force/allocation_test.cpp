// SPDX-License-Identifier: Apache-2.0
// The force thread must not allocate memory, because that may take longer than its millisecond.
#include <gtest/gtest.h>

#include "tests/sand/force/force_samples.hpp"
#include "tests/sand/tin/tool_fixture.hpp"
#include "tests/support/machine/heap_count.hpp"

namespace {

using namespace samples;

TEST(ForceModel, AsksForNoMemory) {
    const SurfacePatch rough = roughPatch(1), level = levelPatch();
    const sand::tin::VertexSand layer = tin_samples::levelLayer(kSide, kSide, 4 * sand::kProbePerCell);
    const SurfacePatch tin({layer.triangles(), layer.heights()}, kCell, probeAt({kMiddle, kMiddle, 0}), kRadius);
    ASSERT_FALSE(tin.facets().empty());
    const std::array surfaces{&rough, &level, &tin};
    const Contour tool = Contour::sphere(kRadius);
    for (const auto law : {sand::ForceLaw::repulse, sand::ForceLaw::controlPoints}) {
        for (const auto between : {sand::Between::local, sand::Between::hold, sand::Between::interpolate}) {
            sand::ForceConstants constants;
            constants.law = law;
            constants.between = between;
            sand::force::ForceModel model(constants);
            double sum = 0;
            const long before = test::heapRequests();
            for (int tick = 0; tick < 100; ++tick) {
                const int step = tick / 16;
                sum += model
                           .at(*surfaces[static_cast<std::size_t>(step % 3)], static_cast<std::uint64_t>(step), tool,
                               placeAt(kRadius, kRadius * tick / 20), tick * kTick)
                           .push.z;
            }
            EXPECT_EQ(test::heapRequests(), before);
            EXPECT_GT(sum, 0);
        }
    }
    EXPECT_GT(test::heapRequests(), 0) << "nobody counted";
}

}  // namespace
