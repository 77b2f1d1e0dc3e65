// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace host {

/// A loadable part of Sandwall, and what to tell the user if it is missing.
struct Module {
    std::string file;         // "sandwall-import.so"
    std::string symbol;       // the function that it defines
    std::string askedBy;      // the option or setting that needs it: messages begin with this
    std::string ifMissing;    // "build Sandwall with Debian's libgdal-dev"
    std::string ifNotLoaded;  // "install Debian's libgdal32"
};

/// Folders that hold modules: that of this program, then ../lib/sandwall beside it.
[[nodiscard]] std::vector<std::filesystem::path> moduleFolders();

/// Loads a module for good and returns the address of its symbol. Modules stay loaded, because libraries leave threads
/// and thread-local memory behind.
///
/// Throws base::InputError if the module is in none of the folders, cannot be loaded, or is of another build.
[[nodiscard]] void* loadModule(const Module& module,
                               const std::vector<std::filesystem::path>& folders = moduleFolders());

}  // namespace host
