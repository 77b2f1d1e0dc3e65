// SPDX-License-Identifier: Apache-2.0
// Rasters in every form that GDAL can write. With SANDWALL_PRINT_FORMS=1 the test prints each of them, as
// scripts/checks/raster_forms.sh does.
#include "tests/scene/import/raster_forms.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "scene/import/importer.hpp"
#include "tests/scene/import/import_fixture.hpp"
#include "tests/support/refusal.hpp"

namespace {

class RasterForms : public Import {
protected:
    /// Expects that this project reads the file as GDAL does. Returns what was compared, for the table.
    std::string compare(const test::RasterForm& form, const std::string& file) {
        const std::optional<test::GdalValues> values = test::valuesOf(file, form.driver);
        if (!values) {
            return "GDAL cannot read it";
        }
        scene::EsriGrid grid;
        const std::string refused =
            test::refusalOf([&] { grid = scene::loadImporter("test").readDem(file, scene::RasterCheck{}); });
        if (values->degrees) {
            EXPECT_NE(refused.find("are degrees, but sand needs lengths"), std::string::npos) << form.name() << refused;
            return "refused: degrees";
        }
        EXPECT_EQ(refused, "nothing") << form.name();
        EXPECT_EQ(grid.columns, values->columns) << form.name();
        EXPECT_EQ(grid.rows, values->rows) << form.name();
        // A table of greys means signed bytes or white-is-zero; the numbers are the same as without.
        EXPECT_EQ(grid.heights.size(), values->heights.size()) << form.name();
        for (std::size_t i = 0; i < std::min(grid.heights.size(), values->heights.size()); ++i) {
            const double ours = grid.heights[i], theirs = values->heights[i];
            EXPECT_TRUE(ours == theirs || (std::isnan(ours) && std::isnan(theirs)))
                << form.name() << ", pixel " << i << ": " << ours << " instead of " << theirs;
        }
        EXPECT_DOUBLE_EQ(grid.westEdge, values->place[0]) << form.name();
        EXPECT_DOUBLE_EQ(grid.cellSize, values->place[1]) << form.name();
        const double south =
            values->place[5] < 0 ? values->place[3] + values->place[5] * values->rows : values->place[3];
        EXPECT_DOUBLE_EQ(grid.southEdge, south) << form.name();
        const auto empty =
            std::count_if(grid.heights.begin(), grid.heights.end(), [](double h) { return std::isnan(h); });
        return fmt::format("read, {} without data", empty);
    }
};

/// Returns the names of GDAL's drivers that the program opens a raster with, from its source.
std::set<std::string> driversOfTheProgram() {
    std::ifstream stream(SANDWALL_SOURCE_DIR "/scene/import/gdal/gdal_raster.cpp");
    const std::string source{std::istreambuf_iterator<char>(stream), {}};
    const std::size_t begin = source.find("kDrivers[] = {"), end = source.find("nullptr", begin);
    std::set<std::string> names;
    for (std::size_t at = source.find('"', begin); at < end;) {
        const std::size_t close = source.find('"', at + 1);
        names.insert(source.substr(at + 1, close - at - 1));
        at = source.find('"', close + 1);
    }
    return names;
}

TEST_F(RasterForms, AreReadAsGdalReadsThem) {
    const bool print = std::getenv("SANDWALL_PRINT_FORMS") != nullptr;
    std::map<std::string, int> read;  // forms by driver
    int number = 0;
    for (const test::RasterForm& form : test::rasterForms()) {
        const std::string folder = path(std::to_string(++number));
        std::filesystem::create_directory(folder);
        const std::string name = form.driver == "SRTMHGT" ? "N47E010" : "t";
        const std::string file = fmt::format("{}/{}.{}", folder, name, form.ending);
        const bool written = test::writeForm(form, file);
        const std::string result = written ? compare(form, file) : "GDAL cannot write it";
        read[form.driver] += written && result != "GDAL cannot read it" ? 1 : 0;
        if (print) {
            fmt::print("{}: {}\n", form.name(), result);
        }
        std::filesystem::remove_all(folder);
    }
    for (const auto& [driver, count] : read) {
        if (print) {
            fmt::print("{}: {} forms\n", driver, count);
        }
    }
    if (print) {
        for (const std::string& driver : test::formatsThatGdalCannotWrite()) {
            fmt::print("{}: GDAL cannot write it\n", driver);
        }
    }
    // A driver that wrote nothing would not be tested. GDAL 3.6.2 cannot read the files of Leveller that it writes.
    std::set<std::string> known;
    for (const auto& [driver, count] : read) {
        EXPECT_EQ(count > 0, driver != "Leveller") << driver;
        known.insert(driver);
    }
    for (const std::string& name : test::formatsThatGdalCannotWrite()) {
        known.insert(name);
        GDALDriverH driver = GDALGetDriverByName(name.c_str());
        ASSERT_NE(driver, nullptr) << name;
        EXPECT_EQ(GDALGetMetadataItem(driver, GDAL_DCAP_CREATE, nullptr), nullptr) << name;
        EXPECT_EQ(GDALGetMetadataItem(driver, GDAL_DCAP_CREATECOPY, nullptr), nullptr) << name;
    }
    EXPECT_EQ(known, driversOfTheProgram());
}

}  // namespace
