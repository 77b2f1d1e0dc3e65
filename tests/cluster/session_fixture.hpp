// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/child_process.hpp"
#include "tests/support/folder_test.hpp"

inline constexpr double kLong = 120;      // [s], for what takes a few on an idle machine
inline constexpr int kLevels = 8;         // of a channel, within which pictures are alike
inline constexpr double kMostBad = 0.01;  // share of the pixels beyond that

/// Whole sessions through scripts/sandwall, at sizes that two cores draw in moments.
class SessionTest : public test::FolderTest {
protected:
    std::string write(const std::string& name, const std::string& text) {
        std::ofstream(folder_ / name) << text;
        return (folder_ / name).string();
    }
    [[nodiscard]] std::string read(const std::string& name) const {
        std::ifstream stream(folder_ / name);
        return {std::istreambuf_iterator<char>(stream), {}};
    }

    /// A wall of equal tiles of 96 x 72 pixels per eye.
    std::string wall(int rows, int columns, const std::string& stereo = "passive") {
        const std::string text =
            "name = \"test\"\n[viewer]\neye = [0.0, 1.6, 3.0]\neye_separation = 0.065\n[stereo]\nmode = \"" + stereo +
            "\"\n[grid]\nrows = " + std::to_string(rows) + "\ncolumns = " + std::to_string(columns) +
            "\ntile_size = [1.0, 0.75]\nbezel = [0.0104166666666666667, 0.0104166666666666667]\ntile_pixels = [96, "
            "72]\n"
            "lower_left = [" +
            std::to_string(-0.505 * columns) +
            ", 0.4, 0.0]\n[clip]\nnear = 0.1\nfar = 20.0\n[stage]\n"
            "centre = [0.0, 1.2, 0.0]\nwidth = 2.6\ntilt_deg = 40.0\n";
        return write("wall.toml", text);
    }
    /// A small level sand box.
    std::string scene(const std::string& more = "") {
        return write(
            "scene.toml",
            "name = \"test\"\n" + more +
                "[field]\ncolumns = 128\nrows = 128\n[terrain]\nheight = 0.2\n[material]\n[tool]\nradius = 0.04\n");
    }

    std::unique_ptr<support::ChildProcess> start(const std::vector<std::string>& arguments) {
        std::vector<std::string> command{"/usr/bin/env", "-u", "DISPLAY"};
        command.insert(command.end(), environment_.begin(), environment_.end());
        command.insert(command.end(), {SANDWALL_SOURCE_DIR "/scripts/sandwall", "run"});
        command.insert(command.end(), arguments.begin(), arguments.end());
        // What ends stays ended; recovery_test.cpp is about what is started again.
        if (std::find(arguments.begin(), arguments.end(), "--restarts") == arguments.end()) {
            command.insert(command.end(), {"--restarts", "0"});
        }
        // What an earlier session has said must not pass for this one's.
        std::filesystem::remove(folder_ / "output.txt");
        return std::make_unique<support::ChildProcess>(command, folder_ / "output.txt");
    }

    struct Ended {
        int status;
        std::string output;
    };
    Ended runToEnd(const std::vector<std::string>& arguments, double seconds = 120) {
        const auto session = start(arguments);
        const std::optional<int> status = session->wait(seconds);
        EXPECT_TRUE(status.has_value()) << "still running after " << seconds << " s:\n" << session->output();
        return {status.value_or(-1), session->output()};
    }

    /// As messages name this machine.
    [[nodiscard]] static std::string host() {
        std::array<char, 256> name{};
        gethostname(name.data(), name.size() - 1);
        return name.data();
    }
    [[nodiscard]] std::string out() const { return (folder_ / "out").string(); }
    [[nodiscard]] nlohmann::json summary() const { return nlohmann::json::parse(read("out/summary.json")); }

    std::vector<std::string> environment_;  // NAME=value, for the sessions
};
