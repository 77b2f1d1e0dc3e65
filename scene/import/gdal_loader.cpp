// SPDX-License-Identifier: Apache-2.0
#include "host/module.hpp"
#include "scene/import/importer.hpp"

namespace scene {
namespace {

const Importer& load(std::string_view what) {
    void* const symbol =
        host::loadModule({.file = "sandwall-import.so",
                          .symbol = kImportSymbol,
                          .askedBy = std::string(what),
                          .ifMissing = "build Sandwall with Debian's libgdal-dev and libmuparser-dev",
                          .ifNotLoaded = "install Debian's libgdal32 (Debian 13: libgdal36) and libmuparser2v5"});
    return *reinterpret_cast<GetImporter*>(symbol)();
}

}  // namespace

const Importer& loadImporter(std::string_view what) {
    static const Importer& importer = load(what);
    return importer;
}

}  // namespace scene
