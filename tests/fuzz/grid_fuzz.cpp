// SPDX-License-Identifier: Apache-2.0
// Fuzzes an ESRI ASCII grid.
#include "scene/import/esri_file.hpp"
#include "tests/fuzz/fuzz_target.hpp"

SANDWALL_FUZZER(grid) {
    const fuzz::MemoryFile file({data, size});
    fuzz::takeOrRefuse([&] { (void)scene::withoutEmptyEdges(scene::readEsriGrid(file.path())); });
    return 0;
}
