// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace host {

/// Loadable part of Sandwall, and the messages for a user who lacks it.
struct Module {
    std::string file;         // "sandwall-import.so"
    std::string symbol;       // function that the file defines
    std::string askedBy;      // option or setting that needs it; messages begin with this
    std::string ifMissing;    // "build Sandwall with Debian's libgdal-dev"
    std::string ifNotLoaded;  // "install Debian's libgdal32"
};

/// Returns the folders that may hold modules: the folder of this program, then ../lib/sandwall next to it.
[[nodiscard]] std::vector<std::filesystem::path> moduleFolders();

/// Loads a module and returns the address of its symbol. The module stays loaded until the process ends, because
/// libraries leave threads and thread-local memory behind. If loading changed how the calling thread computes with
/// floats (base/float_environment.hpp), sets this back and prints a line.
///
/// Throws base::InputError if the module is in none of the folders, cannot be loaded, or is of another build.
[[nodiscard]] void* loadModule(const Module& module,
                               const std::vector<std::filesystem::path>& folders = moduleFolders());

/// Sets the calling thread to compute with floats as the sand needs it (base/float_environment.hpp). Prints a line if
/// that changed something. Call it after loading or opening what is not ours; `what` names it in the line.
void repairFloatsAfter(const std::string& what);

}  // namespace host
