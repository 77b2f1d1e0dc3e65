// SPDX-License-Identifier: Apache-2.0
// Fuzzes a PNG as a picture and as heights. The input is a file, or chunks that get correct checksums and whose pixels
// may be compressed here. A picture that is read must be equal after it is written and read again.
#include <cmath>

#include "pictures/png_file.hpp"
#include "scene/import/importer.hpp"
#include "scene/import/raster_memory.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/fuzz/png_chunks.hpp"

namespace {

constexpr std::size_t kMostPixels = 1 << 18;        // of a picture that is written again
constexpr std::int64_t kMostBytes = 4 * (1 << 18);  // of a raster, so that an input takes less than a second

void readPicture(const std::string& file) {
    const pictures::Image picture = pictures::readPng(file);
    if (picture.pixels() <= kMostPixels) {
        const fuzz::MemoryFile written({});
        pictures::writePng(written.path(), picture);
        fuzz::require(pictures::readPng(written.path()) == picture, "a picture differs after it is written and read");
    }
}

void readHeights(const std::string& file) {
    static const scene::Importer& kImporter = scene::loadImporter("the fuzzer of PNG");
    const scene::EsriGrid grid = kImporter.readImage(file, scene::Colours::none, scene::fitsMemory(file, kMostBytes));
    for (const double height : grid.heights) {
        fuzz::require(std::isnan(height) || (height >= 0 && height <= 1), "a picture has a height beyond its white");
    }
}

}  // namespace

SANDWALL_FUZZER(png) {
    if (size == 0) {
        return 0;
    }
    const fuzz::Input input = fuzz::Input(data, size).subspan(1);
    const bool whole = data[0] % 3 == 0;
    const base::Bytes made = whole ? base::Bytes{} : fuzz::pngOf(input, data[0] % 3 == 2);
    const fuzz::MemoryFile file(whole ? input : fuzz::Input(made));
    fuzz::takeOrRefuse([&] { readPicture(file.path()); });
    fuzz::takeOrRefuse([&] { readHeights(file.path()); });
    return 0;
}
