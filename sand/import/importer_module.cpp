// SPDX-License-Identifier: Apache-2.0
#include <dlfcn.h>

#include "files/input_error.hpp"
#include "sand/import/importer.hpp"

namespace sand {
namespace {

namespace fs = std::filesystem;

const Importer& load(const std::string& what) {
    std::error_code none;
    const fs::path bin = fs::read_symlink("/proc/self/exe", none).parent_path();
    for (const fs::path& folder : {bin, bin.parent_path() / "lib" / "sandwall"}) {
        const fs::path file = folder / "sandwall-import.so";
        if (!fs::exists(file, none)) {
            continue;
        }
        // Never closed: GDAL keeps what it has registered until the program ends.
        void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
        void* found = handle == nullptr ? nullptr : dlsym(handle, kImportSymbol);
        if (found == nullptr) {
            const char* reason = dlerror();
            throw files::InputError(what + ": " + (reason == nullptr ? file.string() + " is none of ours" : reason) +
                                    "; install Debian's libgdal32 and libmuparser2v5");
        }
        return *reinterpret_cast<GetImporter*>(found)();
    }
    throw files::InputError(what + ": there is no sandwall-import.so in " + bin.string() +
                            "; build Sandwall with Debian's libgdal-dev and libmuparser-dev");
}

}  // namespace

const Importer& loadImporter(const std::string& what) {
    static const Importer& importer = load(what);
    return importer;
}

}  // namespace sand
