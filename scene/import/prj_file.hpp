// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace scene {

/// Text of a .prj file, which gives the coordinate system of the raster beside it. It is WKT, or lines of a key and a
/// value as ArcInfo wrote them.
struct PrjFile {
    std::filesystem::path file;
    std::string text;  // UTF-8, in any encoding of the file

    /// Returns whether it names a system of degrees. Knows it by the first word, without GDAL.
    [[nodiscard]] bool inDegrees() const;
    /// Returns the unit of heights that ArcInfo's line Zunits names; nullopt without it and for "NO".
    [[nodiscard]] std::optional<std::string> heightUnit() const;
};

/// Returns the .prj file beside a raster, or nullopt if there is none. Throws base::InputError if it cannot be read as
/// text.
[[nodiscard]] std::optional<PrjFile> prjBeside(const std::filesystem::path& raster);

}  // namespace scene
