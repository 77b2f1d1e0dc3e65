// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cpl_conv.h>
#include <cpl_string.h>
#include <gdal.h>
#include <ogr_srs_api.h>

#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace scene {

struct CloseDataset {
    void operator()(void* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<void, CloseDataset>;

struct FreeReference {
    void operator()(OGRSpatialReferenceH reference) const { OSRDestroySpatialReference(reference); }
};
using SpatialReference = std::unique_ptr<std::remove_pointer_t<OGRSpatialReferenceH>, FreeReference>;

struct FreeList {
    void operator()(char** list) const { CSLDestroy(list); }
};
using GdalList = std::unique_ptr<char*, FreeList>;

struct FreeText {
    void operator()(char* text) const { CPLFree(text); }
};
using GdalText = std::unique_ptr<char, FreeText>;

/// Session in which GDAL prints no message and loads no plugin. Its messages are kept for this project's own error
/// line.
class GdalSession {
public:
    GdalSession();
    ~GdalSession();
    GdalSession(const GdalSession&) = delete;
    GdalSession& operator=(const GdalSession&) = delete;

    /// Returns the first error of the session, or else the first warning. Returns "GDAL gives no reason" without
    /// either.
    [[nodiscard]] std::string complaint() const;
    /// Returns every warning once, and errors that did not stop GDAL, as lines that begin with `file`. At most a few;
    /// the last line counts the rest.
    [[nodiscard]] std::vector<std::string> warnings(const std::string& file) const;

private:
    static void keep(CPLErr severity, CPLErrorNum number, const char* message);

    std::string error_;
    std::vector<std::string> heard_;  // different messages, in their order
    std::size_t unheard_ = 0;         // further different messages
};

}  // namespace scene
