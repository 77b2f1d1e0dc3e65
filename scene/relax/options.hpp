// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace scene::relax {

/// What sandwall-relax was asked for (docs/relax.md).
struct Options {
    std::string in, out, scheme = "g", bedrock;
    double talus = 0;                  // [degree]
    double band = 0;                   // share of the talus
    std::optional<std::int64_t> most;  // sweeps
    int threads = 1;
    std::optional<double> maxError;  // [raster's unit], of a TIN of it
    std::optional<int> vertices;     // likewise
};

/// Both read IN, write OUT and print the line; they throw base::InputError.
void relaxGrid(const Options& options);
void relaxTin(const Options& options);

}  // namespace scene::relax
