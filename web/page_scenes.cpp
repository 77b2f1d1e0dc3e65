// SPDX-License-Identifier: Apache-2.0
// Encodes scenes for the page: a file of each has the header of a journal of this scene, which the page reads as one.
// usage: page_scenes FOLDER SCENE.toml... Writes FOLDER/SCENE.scene.
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "base/input_error.hpp"
#include "host/version.hpp"
#include "journal/memory_writer.hpp"
#include "scene/load/scene_file.hpp"

namespace {

void write(const std::filesystem::path& file, const base::Bytes& bytes) {
    std::ofstream stream(file, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) {
        throw base::InputError(file.string() + ": cannot be written; check the folder and the disk");
    }
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 3) {
        fmt::print(stderr, "usage: page_scenes FOLDER SCENE.toml...\n");
        return base::kExitBadInput;
    }
    try {
        for (int i = 2; i < count; ++i) {
            const std::filesystem::path file = arguments[i];
            const journal::MemoryWriter writer(scene::loadScene(file), 0, "web page", host::release());
            write(std::filesystem::path(arguments[1]) / (file.stem().string() + ".scene"), writer.bytes());
        }
    } catch (const base::InputError& error) {
        fmt::print(stderr, "page_scenes: {}\n", error.what());
        return base::kExitBadInput;
    }
    return 0;
}
