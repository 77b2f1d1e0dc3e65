// SPDX-License-Identifier: Apache-2.0
#include "scene/gdal/gdal_session.hpp"

#include <cpl_error.h>
#include <fmt/format.h>

#include <algorithm>

#include "base/input_error.hpp"

namespace scene {

GdalSession::GdalSession() {
    CPLPushErrorHandlerEx(keep, this);
    static const bool kReady = [] {
        // Plugins are code from any place where GDAL looks, and PROJ would download grids. Heights do not need either.
        CPLSetConfigOption("GDAL_DRIVER_PATH", "disable");
        CPLSetConfigOption("AAIGRID_DATATYPE", "Float64");           // so that no digit of a text is lost
        CPLSetConfigOption("GDAL_ERROR_ON_LIBJPEG_WARNING", "YES");  // a JPEG that is cut would end in grey
        CPLSetConfigOption("GTIFF_REPORT_COMPD_CS", "YES");  // otherwise GDAL drops the vertical datum of older files
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
    if (severity != CE_Warning && session.error_.empty()) {
        session.error_ = message;
    }
    constexpr std::size_t kMost = 5;  // a damaged file can give a warning per row
    if (std::find(session.heard_.begin(), session.heard_.end(), message) == session.heard_.end()) {
        if (session.heard_.size() < kMost) {
            session.heard_.emplace_back(message);
        } else {
            ++session.unheard_;
        }
    }
}

std::vector<std::string> GdalSession::warnings(const std::string& file) const {
    std::vector<std::string> lines;
    for (const std::string& message : heard_) {
        lines.push_back(base::InputError::oneLine(fmt::format("{}: GDAL warns: {}", file, message)));
    }
    if (unheard_ > 0) {
        lines.push_back(fmt::format("{}: GDAL warns {} more times; gdalinfo -checksum prints all", file, unheard_));
    }
    return lines;
}

std::string GdalSession::complaint() const {
    if (!error_.empty()) {
        return error_;
    }
    return heard_.empty() ? "GDAL gives no reason" : heard_.front();
}

}  // namespace scene
