// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "scene/import/esri_grid.hpp"
#include "scene/raster_statement.hpp"

namespace scene::relax {

/// Prints "FILE: metres across (EPSG:32633), …" on stderr.
void printStatement(const RasterStatement& statement);

/// Returns the statement as the object `units` of the report (docs/relax.md).
[[nodiscard]] nlohmann::ordered_json jsonOf(const RasterStatement& statement);

/// Returns a check for a raster that the solver reads: its sides and the free memory. `file` is for the message.
[[nodiscard]] RasterCheck fitsSolver(const std::string& file, std::int64_t freeBytes);

}  // namespace scene::relax
