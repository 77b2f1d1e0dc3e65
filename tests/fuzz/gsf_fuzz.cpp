// SPDX-License-Identifier: Apache-2.0
// A scan as a Gwyddion Simple Field.
#include "fuzz_target.hpp"
#include "sand/import/gsf_file.hpp"

SANDWALL_FUZZER(gsf) {
    const fuzz::MemoryFile file({data, size});
    fuzz::takeOrRefuse([&] { (void)sand::withoutEmptyEdges(sand::readGsf(file.path())); });
    return 0;
}
