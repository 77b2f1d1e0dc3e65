// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "scene/import/esri_grid.hpp"
#include "scene/model/raster_statement.hpp"

namespace scene::relax {

/// Command line of sandwall-relax (docs/relax.md).
struct Options {
    std::string in, out, scheme = "g", bedrock;
    double talus = 0;                  // [degree]
    double band = 0;                   // share of the talus
    std::optional<std::int64_t> most;  // most sweeps; nullopt: until the sand is at rest
    int threads = 1;
    std::optional<double> maxError;  // of the TIN of a raster [raster's unit]
    std::optional<int> vertices;     // of the TIN of a raster
    bool lengths = false;            // the raster has lengths, even if they seem to be degrees
};

/// Throws base::InputError if the lengths of IN seem to be degrees, unless `lengths` is set.
void checkLengths(const EsriGrid& raster, const Options& options);

/// Both functions read IN, write OUT and print the report line. They throw base::InputError.
void relaxGrid(const Options& options);
void relaxTin(const Options& options);

/// Result of a run, for printResult().
struct Result {
    bool moved = false;   // whether a height has changed
    bool atRest = false;  // whether no sand would move in another sweep
    std::int64_t sweeps = 0;
    double steepest = 0;  // [degree]
};
/// Prints one sentence about the result on stderr.
void printResult(const Options& options, const Result& result);

/// Prints "FILE: metres across (EPSG:32633), …" on stderr.
void printStatement(const RasterStatement& statement);

/// Returns the statement as the object `units` of the report (docs/relax.md).
[[nodiscard]] nlohmann::ordered_json jsonOf(const RasterStatement& statement);

/// Returns a check for a raster that the solver reads: its sides and the free memory. `file` is for the message.
[[nodiscard]] RasterCheck fitsSolver(const std::string& file, std::int64_t freeBytes);

}  // namespace scene::relax
