// SPDX-License-Identifier: Apache-2.0
// The force thread must not allocate memory, because that may take longer than its millisecond.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "tests/sand/force/force_samples.hpp"
#include "tests/sand/tin/tool_fixture.hpp"

namespace {
thread_local int asked = 0;
}  // namespace

// Not inlined, because g++ would otherwise warn that memory of malloc is given to delete, and memory of new to free.
[[gnu::noinline]] void* operator new(std::size_t size) {
    ++asked;
    if (void* memory = std::malloc(size > 0 ? size : 1)) {
        return memory;
    }
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

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
            const int before = asked;
            for (int tick = 0; tick < 100; ++tick) {
                const int step = tick / 16;
                sum += model
                           .at(*surfaces[static_cast<std::size_t>(step % 3)], static_cast<std::uint64_t>(step), tool,
                               placeAt(kRadius, kRadius * tick / 20), tick * kTick)
                           .push.z;
            }
            EXPECT_EQ(asked, before);
            EXPECT_GT(sum, 0);
        }
    }
    EXPECT_GT(asked, 0) << "nobody counted";
}

}  // namespace
