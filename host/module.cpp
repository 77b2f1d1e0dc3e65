// SPDX-License-Identifier: Apache-2.0
#include "host/module.hpp"

#include <dlfcn.h>

#include <cstring>

#include "base/float_environment.hpp"
#include "base/input_error.hpp"
#include "host/build_id.hpp"
#include "host/print_line.hpp"

namespace host {
namespace {

namespace fs = std::filesystem;

fs::path findModule(const Module& module, const std::vector<fs::path>& folders) {
    std::string places;
    for (const fs::path& folder : folders) {
        std::error_code none;
        if (fs::exists(folder / module.file, none)) {
            return folder / module.file;
        }
        places += (places.empty() ? "" : " and ") + folder.string();
    }
    throw base::InputError(module.askedBy + ": there is no " + module.file + " in " + places + "; " + module.ifMissing);
}

/// Throws for a module of another build, because its interfaces and its numbers may differ.
void requireSameBuild(void* handle, const fs::path& file) {
    void* const found = dlsym(handle, "sandwallBuildId");
    const char* const build = found == nullptr ? "none" : reinterpret_cast<const char* (*)()>(found)();
    if (std::strcmp(build, buildId()) != 0) {
        throw base::InputError(file.string() + ": is of build " + build + ", and this program of " + buildId() +
                               "; install programs and modules of one build");
    }
}

}  // namespace

std::vector<fs::path> moduleFolders() {
    std::error_code none;
    const fs::path bin = fs::read_symlink("/proc/self/exe", none).parent_path();
    return {bin, bin.parent_path() / "lib" / "sandwall"};
}

void* loadModule(const Module& module, const std::vector<fs::path>& folders) {
    const fs::path file = findModule(module, folders);
    void* const handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) {
        const char* const reason = dlerror();
        throw base::InputError(module.askedBy + ": " +
                               (reason == nullptr ? file.string() + " cannot be loaded" : reason) + "; " +
                               module.ifNotLoaded);
    }
    requireSameBuild(handle, file);
    repairFloatsAfter(file.string());
    void* const symbol = dlsym(handle, module.symbol.c_str());
    if (symbol == nullptr) {
        throw base::InputError(file.string() + ": does not define " + module.symbol + "; " + module.ifNotLoaded);
    }
    return symbol;
}

void repairFloatsAfter(const std::string& what) {
    if (const std::string was = base::repairFloats(); !was.empty()) {
        printLine("{}: changed how this process computes: it {}; this was set back", what, was);
    }
}

}  // namespace host
