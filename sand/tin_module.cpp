// SPDX-License-Identifier: Apache-2.0
#include "sand/tin_module.hpp"

#include <dlfcn.h>

#include <filesystem>

#include "files/input_error.hpp"

namespace sand {
namespace {

namespace fs = std::filesystem;

const TinModule& load() {
    std::error_code none;
    const fs::path bin = fs::read_symlink("/proc/self/exe", none).parent_path();
    for (const fs::path& folder : {bin, bin.parent_path() / "lib" / "sandwall"}) {
        const fs::path file = folder / "sandwall-tin.so";
        if (!fs::exists(file, none)) {
            continue;
        }
        void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
        void* found = handle == nullptr ? nullptr : dlsym(handle, kTinSymbol);
        if (found == nullptr) {
            const char* reason = dlerror();
            throw files::InputError(std::string("a scene with a [tin]: ") +
                                    (reason == nullptr ? file.string() + " is none of ours" : reason) +
                                    "; install it and the programs from one build of Sandwall");
        }
        return *reinterpret_cast<GetTinModule*>(found)();
    }
    throw files::InputError("a scene with a [tin]: there is no sandwall-tin.so in " + bin.string() +
                            "; copy it there from the build that the programs are of");
}

}  // namespace

const TinModule& tinModule() {
    static const TinModule& module = load();
    return module;
}

}  // namespace sand
