// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "scene/import/esri_file.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/processes/run_program.hpp"

/// Runs sandwall-relax on files of its own folder.
class Relax : public test::FolderTest {
protected:
    [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
    void write(const std::string& name, const std::string& text) const { std::ofstream(path(name)) << text; }
    [[nodiscard]] std::string read(const std::string& name) const {
        std::ifstream stream(path(name));
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    /// Writes a grid of square cells with side 1; the heights begin in the north.
    void writeGrid(const std::string& name, int columns, int rows, const std::vector<double>& heights) const {
        scene::writeEsriGrid({columns, rows, 1, 0, 0, heights}, path(name));
    }
    /// Runs the program in the test's folder, so that arguments are plain file names. `before` are words of the shell.
    [[nodiscard]] support::Ran run(const std::string& arguments, const std::string& before = "") const {
        const std::filesystem::path root = std::filesystem::current_path();
        std::filesystem::current_path(folder_);
        support::Ran ran = support::runCommand(before + "'" + (root / SANDWALL_BIN_DIR / "sandwall-relax").string() +
                                               "' " + arguments);
        std::filesystem::current_path(root);
        return ran;
    }
    /// Runs the program, expects success, and returns its report line. On a slow machine, progress lines come before
    /// it.
    [[nodiscard]] nlohmann::json relax(const std::string& arguments) const {
        const support::Ran ran = run(arguments);
        EXPECT_EQ(ran.status, 0) << ran.output;
        const std::size_t line = ran.output.find('{');
        EXPECT_NE(line, std::string::npos) << ran.output;
        EXPECT_EQ(ran.output.find('\n', line), ran.output.size() - 1) << ran.output;
        return nlohmann::json::parse(ran.output.substr(std::min(line, ran.output.size())), nullptr, false);
    }
    /// Expects status 2, one line that contains `words`, and no file `out`. The lines about units that come before work
    /// are not counted.
    void expectRefused(const std::string& arguments, const std::string& words, const std::string& out) const {
        const support::Ran ran = run(arguments);
        EXPECT_EQ(ran.status, 2) << arguments << '\n' << ran.output;
        std::size_t lines = 0, statements = 0;
        std::istringstream text(ran.output);
        for (std::string line; std::getline(text, line);) {
            ++lines;
            statements += line.find(" across (") != std::string::npos ? 1U : 0U;
        }
        EXPECT_EQ(lines - statements, 1U) << ran.output;
        EXPECT_TRUE(ran.output.starts_with("sandwall-relax: ")) << ran.output;
        EXPECT_NE(ran.output.find(words), std::string::npos) << "not '" << words << "' in: " << ran.output;
        EXPECT_FALSE(std::filesystem::exists(path(out))) << arguments;
    }
};
