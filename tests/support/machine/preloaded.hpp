// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dlfcn.h>

#include <cstdlib>
#include <cstring>

/// Parts of modules that replace functions of other libraries (LD_PRELOAD) in the process of one rank.
namespace preloaded {

using Plain = void (*)();

/// Returns whether this process is the rank that the environment variable `variable` names.
inline bool isRankOf(const char* variable) {
    const char* const rank = std::getenv("OMPI_COMM_WORLD_RANK");
    const char* const named = std::getenv(variable);
    return rank != nullptr && named != nullptr && std::strcmp(rank, named) == 0;
}

/// Returns the function `symbol` of OSMesa, or null. RTLD_NEXT would not find it, because the module with OSMesa is
/// loaded with RTLD_LOCAL.
template <class Function>
Function ofOsMesa(const char* symbol) {
    static void* const library = dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_LOCAL);
    return reinterpret_cast<Function>(library == nullptr ? nullptr : dlsym(library, symbol));
}

}  // namespace preloaded
