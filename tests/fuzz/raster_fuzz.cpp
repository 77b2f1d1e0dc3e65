// SPDX-License-Identifier: Apache-2.0
// Fuzzes rasters that GDAL reads, and the files beside them: as heights with a place, as a picture, and for their
// units. Heights that are read must be the same after they are written as a GeoTIFF and read again.
#include <cmath>

#include "scene/import/importer.hpp"
#include "scene/import/raster_file.hpp"
#include "scene/import/raster_memory.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/fuzz/raster_names.hpp"
#include "tests/fuzz/scratch_folder.hpp"

namespace {

constexpr std::int64_t kMostRaster = 8 * (1 << 18);  // [byte], so that an input takes less than a second

bool sameHeights(const scene::EsriGrid& one, const scene::EsriGrid& other) {
    return one.columns == other.columns && one.rows == other.rows &&
           std::equal(one.heights.begin(), one.heights.end(), other.heights.begin(), other.heights.end(),
                      [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); });
}

void requireSound(const scene::EsriGrid& grid) {
    fuzz::require(grid.heights.size() == static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows),
                  "a raster has another number of heights than cells");
    fuzz::require(grid.cellSize > 0 && std::isfinite(grid.cellSize) && std::isfinite(grid.westEdge) &&
                      std::isfinite(grid.southEdge) && grid.aspect() > 0 && std::isfinite(grid.aspect()),
                  "a raster has a place that is not finite");
    for (const double height : grid.heights) {
        fuzz::require(!std::isinf(height), "a raster has an infinite height");
    }
}

void takeHeights(const scene::Importer& importer, const fuzz::ScratchFolder& scratch, const std::string& file) {
    const scene::EsriGrid grid = scene::readByGdal(file, importer, scene::fitsMemory(file, kMostRaster));
    requireSound(grid);
    (void)scene::withoutEmptyEdges(grid);
    scratch.write("again.tif", importer.geoTiff(grid, "again.tif"));
    const scene::EsriGrid again = importer.readDem(scratch.path() / "again.tif", {});
    // Heights in another unit than lengths are multiplied and divided, which rounds them.
    fuzz::require(grid.units.heightsPerLength != 1 || sameHeights(grid, again),
                  "heights differ after they are written as a GeoTIFF and read");
}

}  // namespace

SANDWALL_FUZZER(raster) {
    if (size == 0) {
        return 0;
    }
    static const scene::Importer& kImporter = scene::loadImporter("the fuzzer of rasters");
    static const fuzz::ScratchFolder kScratch;
    const fuzz::RasterNames& names = fuzz::kRasterNames.at(data[0] % fuzz::kRasterNames.size());
    const std::vector<fuzz::Input> pieces = fuzz::piecesOf(fuzz::Input(data, size).subspan(1));
    if (pieces.empty()) {
        return 0;
    }
    kScratch.write(names.raster, pieces[0]);
    if (pieces.size() > 1) {
        kScratch.write(names.beside, pieces[1]);
    }
    // GDAL recognises the header of ERS and not the data.
    const std::string file =
        kScratch.path() / (std::string_view(names.beside) == "r.ers" ? names.beside : names.raster);
    fuzz::takeOrRefuse([&] { (void)kImporter.readUnits(file); });
    fuzz::takeOrRefuse([&] {
        const scene::EsriGrid picture =
            kImporter.readImage(file, scene::Colours::brightness, scene::fitsMemory(file, kMostRaster));
        for (const double height : picture.heights) {
            fuzz::require(!std::isinf(height), "a picture has an infinite height");
        }
    });
    fuzz::takeOrRefuse([&] { takeHeights(kImporter, kScratch, file); });
    kScratch.clear();
    return 0;
}
