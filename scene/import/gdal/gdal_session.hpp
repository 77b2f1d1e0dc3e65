// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cpl_conv.h>
#include <gdal.h>
#include <ogr_srs_api.h>

#include <memory>
#include <string>
#include <type_traits>

namespace scene {

struct CloseDataset {
    void operator()(void* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<void, CloseDataset>;

struct FreeReference {
    void operator()(OGRSpatialReferenceH reference) const { OSRDestroySpatialReference(reference); }
};
using SpatialReference = std::unique_ptr<std::remove_pointer_t<OGRSpatialReferenceH>, FreeReference>;

struct FreeText {
    void operator()(char* text) const { CPLFree(text); }
};
using GdalText = std::unique_ptr<char, FreeText>;

/// While it lives, GDAL prints nothing and loads nothing: what it would have said is kept for our own line.
class GdalSession {
public:
    GdalSession();
    ~GdalSession();
    GdalSession(const GdalSession&) = delete;
    GdalSession& operator=(const GdalSession&) = delete;

    /// The first error since the start, or else the first warning; "GDAL does not say why" without either.
    [[nodiscard]] std::string complaint() const;

private:
    static void keep(CPLErr severity, CPLErrorNum number, const char* message);

    std::string error_, warning_;
};

}  // namespace scene
