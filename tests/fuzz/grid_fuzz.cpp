// SPDX-License-Identifier: Apache-2.0
// An ESRI ASCII grid.
#include "fuzz_target.hpp"
#include "sand/esri_grid.hpp"

SANDWALL_FUZZER(grid) {
    const fuzz::MemoryFile file({data, size});
    fuzz::takeOrRefuse([&] { (void)sand::withoutEmptyEdges(sand::readEsriGrid(file.path())); });
    return 0;
}
