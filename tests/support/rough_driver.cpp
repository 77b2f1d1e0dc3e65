// SPDX-License-Identifier: Apache-2.0
// Simulates an OpenGL driver that was compiled with fast-math (LD_PRELOAD). In the process of the rank
// SANDWALL_ROUGH_RANK, OSMesaMakeCurrent and each glFinish leave the calling thread rounding up, and taking subnormal
// numbers as zero. A rank calls glFinish in every frame.
#include <dlfcn.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

#include <cfenv>
#include <cstdlib>
#include <cstring>

namespace {

using Plain = void (*)();
using MakeCurrent = unsigned char (*)(void*, void*, unsigned, int, int);
using GetProcAddress = Plain (*)(const char*);

void* realOf(const char* symbol) {
    // RTLD_NEXT would not find it, because the module with OSMesa is loaded with RTLD_LOCAL.
    static void* const library = dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_LOCAL);
    return library == nullptr ? nullptr : dlsym(library, symbol);
}

void roughen() {
    const char* const rank = std::getenv("OMPI_COMM_WORLD_RANK");
    const char* const rough = std::getenv("SANDWALL_ROUGH_RANK");
    if (rank != nullptr && rough != nullptr && std::strcmp(rank, rough) == 0) {
        std::fesetround(FE_UPWARD);
        _mm_setcsr(_mm_getcsr() | _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON);
    }
}

Plain realFinish = nullptr;

void roughFinish() {
    realFinish();
    roughen();
}

}  // namespace

extern "C" unsigned char OSMesaMakeCurrent(void* context, void* buffer, unsigned type, int width, int height) {
    static const auto real = reinterpret_cast<MakeCurrent>(realOf("OSMesaMakeCurrent"));
    const unsigned char result = real(context, buffer, type, width, height);
    roughen();
    return result;
}

extern "C" Plain OSMesaGetProcAddress(const char* name) {
    static const auto real = reinterpret_cast<GetProcAddress>(realOf("OSMesaGetProcAddress"));
    const Plain found = real(name);
    if (std::strcmp(name, "glFinish") != 0) {
        return found;
    }
    realFinish = found;
    return roughFinish;
}
