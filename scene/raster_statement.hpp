// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "base/byte_stream.hpp"

namespace scene {

/// Tells what the numbers of a terrain mean, and how the program knows it. Programs print it when they have read
/// terrain, so that a user sees a wrong unit before hours of work.
struct RasterStatement {
    std::string file;
    std::string across, acrossFrom;     // unit of lengths, and what named it: "metres", "EPSG:32633"
    std::string up, upFrom;             // unit of heights, and what named it
    std::optional<std::string> noData;  // number of the file that means no data; nullopt if the file declares none
    double noDataShare = 0;             // cells without data [share of all]

    /// Returns "metres across (EPSG:32633), feet up (vertical datum), no data -9999 in 72 % of cells".
    [[nodiscard]] std::string text() const;

    void encode(base::ByteWriter& writer) const;
    /// Reads what encode() wrote. Throws base::FormatError for a share outside [0, 1], and for a text that is too long.
    static RasterStatement decode(base::ByteReader& reader);
    friend bool operator==(const RasterStatement&, const RasterStatement&) = default;
};

}  // namespace scene
