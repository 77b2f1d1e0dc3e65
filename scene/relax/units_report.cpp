// SPDX-License-Identifier: Apache-2.0
// Prints and checks units and sizes of the files of sandwall-relax.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "base/input_error.hpp"
#include "host/json_fields.hpp"
#include "host/print_line.hpp"
#include "sand/model/height_field.hpp"
#include "scene/import/raster_memory.hpp"
#include "scene/relax/options.hpp"

namespace scene::relax {

void printResult(const Options& options, const Result& result) {
    if (!result.moved && result.atRest) {
        host::printLine(
            "no sand moved: no slope of {} is steep enough to slide at a talus of {:g} degrees; {} has the same "
            "heights",
            options.in, options.talus, options.out);
    } else {
        host::printLine("the sand of {} {} after {} sweeps; its steepest slope is {:.1f} degrees", options.out,
                        result.atRest ? "rests" : "still moves", result.sweeps, result.steepest);
    }
}

void printStatement(const RasterStatement& statement) { host::printLine("{}: {}", statement.file, statement.text()); }

nlohmann::ordered_json jsonOf(const RasterStatement& statement) {
    nlohmann::ordered_json json = host::jsonOf(statement);
    json.erase("file");  // the command line names it
    return json;
}

RasterCheck fitsSolver(const std::string& file, std::int64_t freeBytes) {
    return [=, memory = fitsMemory(file, freeBytes)](const RasterSize& size) {
        if (size.columns > sand::kMaxSide || size.rows > sand::kMaxSide) {
            throw base::InputError(
                fmt::format("{}: has {} x {} cells, and {} a side is the most; cut it with gdal_translate -srcwin, or "
                            "coarsen it: gdal_translate -r average -outsize 50% 50%",
                            file, size.columns, size.rows, sand::kMaxSide));
        }
        memory(size);
    };
}

}  // namespace scene::relax
