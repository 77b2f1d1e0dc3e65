// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "scene/import/raster_file.hpp"
#include "scene/import/raster_units.hpp"
#include "tests/scene/import/import_fixture.hpp"
#include "tests/support/refusal.hpp"

/// Writes text grids and .prj files, and returns what is printed about them.
class Units : public Import {
protected:
    /// A raster of 3 x 2 whole heights, level enough to be lengths.
    void writeText(const std::string& corner = "xllcorner 500000\nyllcorner 5200000") {
        write("t.asc", "ncols 3\nnrows 2\n" + corner + "\ncellsize 10\n1 2 3\n4 5 6\n");
    }
    /// Returns a coordinate system as GDAL writes it: `form` is "WKT1_ESRI", "WKT2" and so on.
    [[nodiscard]] static std::string wktOf(const std::string& system, const char* form) {
        OGRSpatialReferenceH reference = OSRNewSpatialReference(nullptr);
        OSRSetFromUserInput(reference, system.c_str());
        char* text = nullptr;
        const std::string option = std::string("FORMAT=") + form;
        const std::array<const char*, 2> options{option.c_str(), nullptr};
        OSRExportToWktEx(reference, &text, options.data());
        std::string wkt = text;
        CPLFree(text);
        OSRDestroySpatialReference(reference);
        return wkt;
    }
    [[nodiscard]] std::string statementOf(const std::string& file) const {
        return scene::statementOf(scene::readRaster(path(file))).text();
    }
    [[nodiscard]] std::string refusedRaster(const std::string& file) const {
        std::string line = test::refusalOf([&] { (void)scene::readRaster(path(file)); });
        for (std::size_t at = 0; (at = line.find(folder_.string() + "/")) != std::string::npos;) {
            line.erase(at, folder_.string().size() + 1);
        }
        return line;
    }
};
