// SPDX-License-Identifier: Apache-2.0
// Loads a scene and prints which of the import module's libraries this process has mapped.
#include <cstdio>
#include <fstream>
#include <string>

#include "scene/load/scene_file.hpp"

int main(int argc, char** argv) {
    if (argc != 2) {
        return 2;
    }
    (void)scene::loadScene(argv[1]);
    std::ifstream maps("/proc/self/maps");
    const std::string text{std::istreambuf_iterator<char>(maps), {}};
    for (const char* library : {"sandwall-import", "libgdal", "libmuparser", "libproj"}) {
        std::printf("%s %s\n", library, text.find(library) == std::string::npos ? "no" : "mapped");
    }
}
