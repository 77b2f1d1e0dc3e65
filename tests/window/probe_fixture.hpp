// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "pictures/png_file.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/processes/child_process.hpp"

/// Runs window_probe in separate processes, each with a folder for its pictures. Times are bounds, never measurements.
class ProbeTest : public test::FolderTest {
protected:
    static constexpr double kLong = 120;  // [s], bound for actions that take one or two seconds on an idle machine

    /// Starts window_probe. `environment` has arguments of env(1): NAME=value, or -u NAME.
    void start(const std::vector<std::string>& arguments, const std::vector<std::string>& environment = {}) {
        std::vector<std::string> command{"/usr/bin/env", "-u", "DISPLAY"};
        command.insert(command.end(), environment.begin(), environment.end());
        // With LP_NUM_THREADS=0 llvmpipe draws in the thread that calls GL.
        command.insert(command.end(), {"LP_NUM_THREADS=0", std::string(SANDWALL_BIN_DIR) + "/window_probe",
                                       "--pictures", folder_.string() + "/"});
        command.insert(command.end(), arguments.begin(), arguments.end());
        for (const char* old : {"probe.log", "left.png", "right.png"}) {
            std::filesystem::remove(folder_ / old);
        }
        probe_ = std::make_unique<support::ChildProcess>(command, folder_ / "probe.log");
    }
    /// Starts window_probe and waits until frame 0 is shown. Returns its output so far.
    std::string startAndShow(const std::vector<std::string>& arguments,
                             const std::vector<std::string>& environment = {}) {
        start(arguments, environment);
        EXPECT_TRUE(comesTo("frame 0 shown")) << probe_->output();
        return probe_->output();
    }
    /// Types a command and waits for its answer. Returns the whole output so far.
    std::string ask(const std::string& command, const std::string& answer) {
        probe_->type(command);
        EXPECT_TRUE(comesTo(answer)) << command << ": " << probe_->output();
        return probe_->output();
    }
    /// Waits for a whole line of window_probe's output.
    bool comesTo(const std::string& line) {
        return probe_->waitUntil([&] { return probe_->output().find(line + "\n") != std::string::npos; }, kLong);
    }
    /// Waits for the end of window_probe and returns its last output, which must be one line after `from` characters.
    /// The exit status must be `status`.
    std::string lastLine(int status, std::size_t from = 0) {
        const auto ended = probe_->wait(kLong);
        std::string text = probe_->output().substr(from);
        EXPECT_TRUE(ended.has_value()) << "it hangs after: " << text;
        EXPECT_EQ(ended.value_or(-1), status) << text;
        EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
        return text;
    }
    [[nodiscard]] pictures::Image picture(const std::string& eye) const {
        return pictures::readPng(folder_ / (eye + ".png"));
    }
    /// Returns the rest of each line that begins with `word`, such as of all "library ..." lines.
    static std::vector<std::string> linesOf(const std::string& output, const std::string& word) {
        std::vector<std::string> found;
        std::istringstream lines(output);
        for (std::string line; std::getline(lines, line);) {
            if (line.starts_with(word + " ")) {
                found.push_back(line.substr(word.size() + 1));
            }
        }
        return found;
    }

    std::unique_ptr<support::ChildProcess> probe_;
};
