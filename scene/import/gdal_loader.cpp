// SPDX-License-Identifier: Apache-2.0
#include "host/module.hpp"
#include "scene/import/importer.hpp"

namespace scene {
namespace {

const Importer& load(const std::string& what) {
    void* const symbol = host::loadModule({.file = "sandwall-import.so",
                                           .symbol = kImportSymbol,
                                           .askedBy = what,
                                           .ifMissing = "build Sandwall with Debian's libgdal-dev and libmuparser-dev",
                                           .ifNotLoaded = "install Debian's libgdal32 and libmuparser2v5"});
    return *reinterpret_cast<GetImporter*>(symbol)();
}

}  // namespace

const Importer& loadImporter(const std::string& what) {
    static const Importer& importer = load(what);
    return importer;
}

}  // namespace scene
