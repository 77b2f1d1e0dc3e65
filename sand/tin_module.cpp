// SPDX-License-Identifier: Apache-2.0
#include "sand/tin_module.hpp"

#include "host/module.hpp"

namespace sand {
namespace {

const TinModule& load() {
    void* const symbol = host::loadModule({.file = "sandwall-tin.so",
                                           .symbol = kTinSymbol,
                                           .askedBy = "a scene with a [tin]",
                                           .ifMissing = "copy it there from the build of the programs",
                                           .ifNotLoaded = "install it and the programs from one build of Sandwall"});
    return *reinterpret_cast<GetTinModule*>(symbol)();
}

}  // namespace

const TinModule& tinModule() {
    static const TinModule& module = load();
    return module;
}

}  // namespace sand
