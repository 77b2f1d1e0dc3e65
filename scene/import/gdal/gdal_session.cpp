// SPDX-License-Identifier: Apache-2.0
#include "scene/import/gdal/gdal_session.hpp"

#include <cpl_error.h>

namespace scene {

GdalSession::GdalSession() {
    CPLPushErrorHandlerEx(keep, this);
    static const bool kReady = [] {
        // Plugins are code from any place where GDAL looks, and PROJ would download grids. Heights do not need either.
        CPLSetConfigOption("GDAL_DRIVER_PATH", "disable");
        CPLSetConfigOption("AAIGRID_DATATYPE", "Float64");  // so that no digit of a text is lost
        OSRSetPROJEnableNetwork(0);
        GDALAllRegister();
        return true;
    }();
    (void)kReady;
}

GdalSession::~GdalSession() { CPLPopErrorHandler(); }

void GdalSession::keep(CPLErr severity, CPLErrorNum /*number*/, const char* message) {
    auto& session = *static_cast<GdalSession*>(CPLGetErrorHandlerUserData());
    if (severity != CE_Failure && severity != CE_Fatal && severity != CE_Warning) {
        return;
    }
    std::string& kept = severity == CE_Warning ? session.warning_ : session.error_;
    if (kept.empty()) {
        kept = message;
    }
}

std::string GdalSession::complaint() const {
    if (!error_.empty()) {
        return error_;
    }
    return warning_.empty() ? "GDAL gives no reason" : warning_;
}

}  // namespace scene
