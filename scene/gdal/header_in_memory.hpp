// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <filesystem>
#include <string>

namespace scene {

/// Header and first row of a text grid in ASCII, in GDAL's memory. GDAL reads neither byte order marks, nor UTF-16, nor
/// ends of lines of old Macs. Other texts stay where they are. Only one object may exist at a time.
class HeaderInMemory {
public:
    explicit HeaderInMemory(const std::filesystem::path& file);
    ~HeaderInMemory();
    HeaderInMemory(const HeaderInMemory&) = delete;
    HeaderInMemory& operator=(const HeaderInMemory&) = delete;

    /// Returns an empty path for a text that GDAL reads as it is.
    [[nodiscard]] std::filesystem::path path() const;

private:
    std::string text_;
};

}  // namespace scene
