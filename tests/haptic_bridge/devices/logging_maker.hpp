// SPDX-License-Identifier: Apache-2.0
// The maker's library of the example's driver: a device that writes each force to the file that it is opened with.
#pragma once

#include <cstdio>

namespace maker {

inline std::FILE*& log() {
    static std::FILE* file = nullptr;
    return file;
}
inline bool open(const char* what) {
    log() = std::fopen(what, "w");
    return log() != nullptr && std::setvbuf(log(), nullptr, _IOLBF, 1024) == 0;
}
inline void close() { std::fclose(log()); }
inline bool readPlace(double& x, double& y, double& z) {
    x = y = z = 0;
    return true;
}
inline bool button(int) { return false; }
inline bool setForce(double x, double y, double z) { return std::fprintf(log(), "%.9g %.9g %.9g\n", x, y, z) > 0; }
inline const char* lastError() { return "the file cannot be written"; }

}  // namespace maker
