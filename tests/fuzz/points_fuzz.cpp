// SPDX-License-Identifier: Apache-2.0
// Fuzzes points of a survey as text.
#include <cmath>

#include "scene/import/points_file.hpp"
#include "tests/fuzz/fuzz_target.hpp"

SANDWALL_FUZZER(points) {
    const fuzz::MemoryFile file({data, size});
    fuzz::takeOrRefuse([&] {
        const scene::Points points = scene::readPoints(file.path());
        for (const auto& [x, y, z] : points) {
            if (points.size() < 3 || !std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) {
                throw std::logic_error("a cloud has too few points, or a point that is not finite");
            }
        }
    });
    return 0;
}
