// SPDX-License-Identifier: Apache-2.0
// A scan as a Gwyddion Simple Field.
#include "fuzz_target.hpp"
#include "sand/import/gsf_file.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const fuzz::MemoryFile file({data, size});
    fuzz::takeOrRefuse([&] { (void)sand::withoutEmptyEdges(sand::readGsf(file.path())); });
    return 0;
}
