// SPDX-License-Identifier: Apache-2.0
#include <dlfcn.h>

#include <filesystem>

#include "files/input_error.hpp"
#include "haptic_bridge/security.hpp"

namespace haptic_bridge {
namespace {

namespace fs = std::filesystem;

const Security& load(const std::string& option) {
    std::error_code none;
    const fs::path bin = fs::read_symlink("/proc/self/exe", none).parent_path();
    for (const fs::path& folder : {bin, bin.parent_path() / "lib" / "sandwall"}) {
        const fs::path file = folder / "sandwall-security.so";
        if (!fs::exists(file, none)) {
            continue;
        }
        void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
        void* found = handle == nullptr ? nullptr : dlsym(handle, kSecuritySymbol);
        if (found == nullptr) {
            const char* reason = dlerror();
            throw files::InputError(option + ": " + (reason == nullptr ? file.string() + " is none of ours" : reason) +
                                    "; install Debian's libssl3");
        }
        return *reinterpret_cast<GetSecurity*>(found)();
    }
    throw files::InputError(option + ": there is no sandwall-security.so in " + bin.string() +
                            "; build Sandwall with Debian's libssl-dev");
}

}  // namespace

const Security& loadSecurity(const std::string& option) {
    static const Security& security = load(option);
    return security;
}

}  // namespace haptic_bridge
