// SPDX-License-Identifier: Apache-2.0
// Makes one rank hang in a function of MPI or OSMesa (LD_PRELOAD), as in a faulty driver. SANDWALL_HANG_RANK is the
// rank, SANDWALL_HANG_AT the name of the function. With SANDWALL_HANG_STOPPED the whole process is stopped there, also
// its watchdog.
#include <dlfcn.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <cstring>

#include "tests/support/machine/preloaded.hpp"

namespace {

using preloaded::ofOsMesa;
using preloaded::Plain;

void hangAt(const char* function) {
    const char* const at = std::getenv("SANDWALL_HANG_AT");
    if (!preloaded::isRankOf("SANDWALL_HANG_RANK") || at == nullptr || std::strcmp(at, function) != 0) {
        return;
    }
    if (std::getenv("SANDWALL_HANG_STOPPED") != nullptr) {
        raise(SIGSTOP);
    }
    while (true) {
        pause();
    }
}

void (*realRead)(int, int, int, int, unsigned, unsigned, void*) = nullptr;

void hangingRead(int x, int y, int width, int height, unsigned format, unsigned type, void* pixels) {
    hangAt("glReadPixels");
    realRead(x, y, width, height, format, type, pixels);
}

}  // namespace

extern "C" {

void* OSMesaCreateContextAttribs(const int* attributes, void* shared) {
    static const auto real = ofOsMesa<void* (*)(const int*, void*)>("OSMesaCreateContextAttribs");
    hangAt("OSMesaCreateContextAttribs");
    return real(attributes, shared);
}

void OSMesaDestroyContext(void* context) {
    static const auto real = ofOsMesa<void (*)(void*)>("OSMesaDestroyContext");
    hangAt("OSMesaDestroyContext");
    real(context);
}

Plain OSMesaGetProcAddress(const char* name) {
    static const auto real = ofOsMesa<Plain (*)(const char*)>("OSMesaGetProcAddress");
    const Plain found = real(name);
    if (std::strcmp(name, "glReadPixels") != 0) {
        return found;
    }
    realRead = reinterpret_cast<decltype(realRead)>(found);
    return reinterpret_cast<Plain>(hangingRead);
}

int MPI_Finalize() {
    static const auto real = reinterpret_cast<int (*)()>(dlsym(RTLD_NEXT, "MPI_Finalize"));
    hangAt("MPI_Finalize");
    return real();
}

int MPI_Init_thread(int* count, char*** words, int required, int* provided) {
    using Function = int (*)(int*, char***, int, int*);
    static const auto real = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "MPI_Init_thread"));
    hangAt("MPI_Init_thread");
    return real(count, words, required, provided);
}
}
