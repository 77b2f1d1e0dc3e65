// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

namespace scene {

/// Returns the EPSG code of a coordinate system with metres at this place: the UTM zone, or a stereographic system near
/// a pole. Returns 3857, which has inexact metres everywhere, if the place is not finite.
[[nodiscard]] inline int metricSystemAt(double longitude, double latitude /* [degree] */) {
    if (!std::isfinite(longitude) || !std::isfinite(latitude)) {
        return 3857;
    }
    if (std::abs(latitude) > 84) {
        return latitude < 0 ? 3031 : 3413;
    }
    const double turned = std::fmod(longitude + 180, 360);
    const double fromDateLine = turned < 0 ? turned + 360 : turned;
    return (latitude < 0 ? 32700 : 32600) + std::clamp(static_cast<int>(fromDateLine / 6) + 1, 1, 60);
}

/// Returns the command that converts a raster in degrees to metres, for messages. Its middle is at this place.
/// `options` come first, such as "-s_srs EPSG:4326 " for a file without a coordinate system.
[[nodiscard]] inline std::string warpCommand(const std::string& file, double longitude, double latitude /* [degree] */,
                                             const std::string& options = "") {
    return fmt::format("gdalwarp {}-t_srs EPSG:{} -r bilinear {} metres.tif", options,
                       metricSystemAt(longitude, latitude), std::filesystem::path(file).filename().string());
}

}  // namespace scene
