// SPDX-License-Identifier: Apache-2.0
#include "scene/import/raster_file.hpp"

#include <string>
#include <vector>

#include "base/input_error.hpp"
#include "base/text.hpp"
#include "host/whole_file.hpp"
#include "scene/import/esri_file.hpp"
#include "scene/import/importer.hpp"
#include "scene/import/no_data.hpp"
#include "scene/import/prj_file.hpp"

namespace scene {
namespace {

namespace fs = std::filesystem;

void write(const base::Bytes& bytes, const fs::path& file) {
    host::WholeFile whole(file);
    whole.stream().write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    whole.keep();
}

}  // namespace

bool namesGeoTiff(const fs::path& file) {
    const std::string ending = base::endingOf(file);
    return ending == ".tif" || ending == ".tiff";
}

void checkRasterName(const fs::path& file) {
    const std::string ending = base::endingOf(file);
    std::error_code none;
    const bool plain = !fs::exists(file, none) || fs::is_regular_file(file, none);
    if (plain && !namesGeoTiff(file) && ending != ".asc" && ending != ".txt" && !ending.empty()) {
        throw base::InputError(file.string() +
                               ": no known ending; name it .tif for a GeoTIFF, .asc for an ESRI ASCII grid");
    }
}

EsriGrid readRaster(const fs::path& file, const RasterCheck& check) {
    const std::string ending = base::endingOf(file);
    std::error_code none;
    const bool plain = fs::is_regular_file(file, none);
    if (plain && !ending.empty() && ending != ".asc" && ending != ".txt" && !holdsEsriGrid(file)) {
        return readByGdal(file, loadImporter(file.string()), check);
    }
    if (!plain || !prjBeside(file)) {
        return readEsriGrid(file, check);
    }
    return readTextWithUnits(file, loadImporter(file.string()), check);
}

EsriGrid readByGdal(const fs::path& file, const Importer& importer, const RasterCheck& check) {
    EsriGrid grid = importer.readDem(file, check);
    const std::vector<std::string> warnings =
        undeclaredNoData(grid, "if it does: gdal_edit.py -a_nodata {0} " + file.filename().string());
    grid.warnings.insert(grid.warnings.end(), warnings.begin(), warnings.end());
    return grid;
}

EsriGrid readTextWithUnits(const fs::path& file, const Importer& importer, const RasterCheck& check) {
    // GDAL only reads the units. It reads a word in place of a height as 0; readEsriGrid() reports the line.
    const RasterDescription described = importer.readUnits(file);
    EsriGrid grid = readEsriGrid(file, check);
    grid.units = described.units;
    grid.origins = described.origins;
    grid.warnings.insert(grid.warnings.begin(), described.warnings.begin(), described.warnings.end());
    grid.countHeightsInLengths();
    return grid;
}

void writeRaster(const EsriGrid& grid, const fs::path& file) {
    if (namesGeoTiff(file)) {
        write(loadImporter(file.string()).geoTiff(grid, file.string()), file);
        return;
    }
    writeEsriGrid(grid, file);
    if (!grid.units.crs.empty()) {
        const fs::path beside = fs::path(file).replace_extension(".prj");
        const std::string text = loadImporter(file.string()).esriWkt(grid.units.crs, beside.string());
        write({text.begin(), text.end()}, beside);
    }
}

}  // namespace scene
