// SPDX-License-Identifier: Apache-2.0
// Fuzzes a scan as a Gwyddion Simple Field.
#include "scene/import/gsf_file.hpp"
#include "tests/fuzz/fuzz_target.hpp"

SANDWALL_FUZZER(gsf) {
    const fuzz::MemoryFile file({data, size});
    fuzz::takeOrRefuse([&] { (void)scene::withoutEmptyEdges(scene::readGsf(file.path())); });
    return 0;
}
