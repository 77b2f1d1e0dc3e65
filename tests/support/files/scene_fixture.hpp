// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "base/input_error.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/support/files/folder_test.hpp"

/// Writes scene files into a folder of its own and returns the loader's messages.
class SceneFile : public test::FolderTest {
protected:
    std::filesystem::path write(const std::string& name, const std::string& text) {
        std::ofstream(folder_ / name) << text;
        return folder_ / name;
    }
    /// Returns the one line that a user reads, without the folder.
    std::string complaint(const std::string& text) {
        try {
            (void)scene::loadScene(write("s.toml", text));
        } catch (const base::InputError& error) {
            const std::string line = error.what();
            return line.substr(line.find(folder_.string()) == 0 ? folder_.string().size() + 1 : 0);
        }
        return "accepted";
    }
};

inline const std::string kFlat = "[field]\n[terrain]\n[material]\n";
