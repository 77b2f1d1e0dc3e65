// SPDX-License-Identifier: Apache-2.0
// Simulates an OpenGL driver that was compiled with fast-math (LD_PRELOAD). In the process of the rank
// SANDWALL_ROUGH_RANK, OSMesaMakeCurrent and each glFinish leave the calling thread rounding up, and taking subnormal
// numbers as zero. A rank calls glFinish in every frame.
#include <cfenv>
#include <cstring>

#include "base/float_register.hpp"
#include "tests/support/machine/preloaded.hpp"

namespace {

using preloaded::ofOsMesa;
using preloaded::Plain;
using MakeCurrent = unsigned char (*)(void*, void*, unsigned, int, int);
using GetProcAddress = Plain (*)(const char*);

void roughen() {
    if (preloaded::isRankOf("SANDWALL_ROUGH_RANK")) {
        std::fesetround(FE_UPWARD);
        using namespace base::float_register;
        set(get() | kFlushesResults | kFlushesOperands);
    }
}

Plain realFinish = nullptr;

void roughFinish() {
    realFinish();
    roughen();
}

}  // namespace

extern "C" unsigned char OSMesaMakeCurrent(void* context, void* buffer, unsigned type, int width, int height) {
    static const auto real = ofOsMesa<MakeCurrent>("OSMesaMakeCurrent");
    const unsigned char result = real(context, buffer, type, width, height);
    roughen();
    return result;
}

extern "C" Plain OSMesaGetProcAddress(const char* name) {
    static const auto real = ofOsMesa<GetProcAddress>("OSMesaGetProcAddress");
    const Plain found = real(name);
    if (std::strcmp(name, "glFinish") != 0) {
        return found;
    }
    realFinish = found;
    return roughFinish;
}
