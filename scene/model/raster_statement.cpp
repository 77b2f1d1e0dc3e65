// SPDX-License-Identifier: Apache-2.0
#include "scene/model/raster_statement.hpp"

#include <fmt/format.h>

namespace scene {
namespace {

std::string withOrigin(const std::string& what, const std::string& origin) {
    return origin.empty() ? what : fmt::format("{} ({})", what, origin);
}

}  // namespace

std::string RasterStatement::text() const {
    const std::string result = withOrigin(across + " across", acrossFrom) + ", " + withOrigin(up + " up", upFrom);
    if (!noData && noDataShare == 0) {
        return result + ", no cells without data";
    }
    const double percent = 100 * noDataShare;
    return result + fmt::format(", no data{} in {} % of cells", noData ? " " + *noData : "",
                                percent > 0 && percent < 0.1 ? "less than 0.1" : fmt::format("{:.3g}", percent));
}

}  // namespace scene
