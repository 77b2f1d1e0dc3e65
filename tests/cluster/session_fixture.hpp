// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/files/folder_test.hpp"
#include "tests/support/processes/child_process.hpp"
#include "tests/support/processes/control_client.hpp"
#include "tests/support/processes/events.hpp"
#include "tests/support/processes/run_program.hpp"

inline constexpr double kLong = 120;      // [s], for work that takes a few seconds on an idle machine
inline constexpr int kLevels = 8;         // largest difference of a channel in equal pictures
inline constexpr double kMostBad = 0.01;  // largest share of pixels that differ by more than kLevels

/// Whole sessions, started with scripts/sandwall, that are small enough for two cores. The tests check events, files,
/// exit statuses and values, and never the text of messages (docs/events.md).
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

    /// Returns a wall file of equal tiles of 96 x 72 pixels per eye.
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
    /// Returns a scene file of a small box of level sand.
    std::string scene(const std::string& more = "") {
        return write(
            "scene.toml",
            "name = \"test\"\n" + more +
                "[field]\ncolumns = 128\nrows = 128\n[terrain]\nheight = 0.2\n[material]\n[tool]\nradius = 0.04\n");
    }

    std::unique_ptr<support::ChildProcess> start(const std::vector<std::string>& arguments) {
        // By default mpirun gives its ranks a second to end. Supervised sessions set the same 0.
        std::vector<std::string> command{
            "/usr/bin/env", "-u", "DISPLAY", "-u", "WAYLAND_DISPLAY", "OMPI_MCA_odls_base_sigkill_timeout=0"};
        command.insert(command.end(), environment_.begin(), environment_.end());
        command.insert(command.end(), {SANDWALL_SOURCE_DIR "/scripts/sandwall", "run"});
        command.insert(command.end(), arguments.begin(), arguments.end());
        // Processes that end are not started again, except in recovery_test.cpp.
        if (std::find(arguments.begin(), arguments.end(), "--restarts") == arguments.end()) {
            command.insert(command.end(), {"--restarts", "0"});
        }
        // The output of an earlier session must not count as output of this one.
        std::filesystem::remove(folder_ / "output.txt");
        return std::make_unique<support::ChildProcess>(command, folder_ / "output.txt");
    }

    struct Ended {
        int status;
        std::string output;

        /// Returns true if the session has written an event of this name with the fields of `wanted`.
        [[nodiscard]] bool has(const std::string& name, const nlohmann::json& wanted) const {
            const auto all = support::eventsIn(output, name);
            return std::any_of(all.begin(), all.end(), [&](const auto& one) { return support::holds(one, wanted); });
        }
    };
    Ended runToEnd(const std::vector<std::string>& arguments, double seconds = 300) {
        const auto session = start(arguments);
        const std::optional<int> status = session->wait(seconds);
        EXPECT_TRUE(status.has_value()) << "still running after " << seconds << " s:\n" << session->output();
        return {status.value_or(-1), session->output()};
    }
    /// The session must have ended in order. On a busy machine the sand stands still again and again, and the hand has
    /// no force meanwhile. So the report's line `force` may be BAD, but no other line.
    static void expectInOrder(const Ended& ended) {
        const std::vector<nlohmann::json> reports = support::eventsIn(ended.output, "report");
        ASSERT_FALSE(reports.empty()) << ended.output;
        const nlohmann::json bad = reports.back()["bad"];
        EXPECT_TRUE(bad.empty() || bad == nlohmann::json::array({"force"})) << ended.output;
        EXPECT_EQ(ended.status, bad.empty() ? 0 : 1) << ended.output;
    }
    static void expectInOrder(support::ChildProcess& session) {
        const std::optional<int> status = session.wait(kLong);
        expectInOrder({status.value_or(-1), session.output()});
    }
    /// The session must have refused its input with `status` and one line. The line contains `named`: the file and
    /// line, the option or the value. On a busy machine ranks may also have reported that they wait for the master;
    /// each such line comes with an event.
    static void expectOneLine(const Ended& ended, const std::string& named, int status = 2) {
        const std::string message = support::messagesIn(ended.output);
        const auto waits = static_cast<std::ptrdiff_t>(support::eventsIn(ended.output, "waiting").size());
        EXPECT_EQ(ended.status, status) << ended.output;
        EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 1 + waits) << ended.output;
        EXPECT_TRUE(message.starts_with("sandwall")) << "a line must begin with its program's name: " << ended.output;
        EXPECT_NE(message.find(named), std::string::npos) << ended.output;
    }
    /// Waits until frames are shown.
    static void expectFrames(support::ChildProcess& session) {
        EXPECT_FALSE(session.waitForEvent("progress").is_null()) << session.output();
    }
    /// Waits until a hand numbers the steps.
    static void expectHand(support::ChildProcess& session) {
        EXPECT_FALSE(session.waitForEvent("link", {{"state", "linked"}}).is_null()) << session.output();
    }

    /// Sends an operator's command to the running session and returns the answer.
    [[nodiscard]] nlohmann::json answer(const std::string& words) const { return support::askSession(out(), words); }
    /// Sends a command that must succeed and returns the answer.
    nlohmann::json ask(const std::string& words) const {
        nlohmann::json answered = answer(words);
        EXPECT_TRUE(answered.is_object() && answered.value("ok", false)) << words << ": " << answered.dump();
        return answered.is_object() ? answered : nlohmann::json::object();
    }
    /// Asks for the status until `wanted` accepts it, and returns it. Fails after two minutes.
    nlohmann::json awaitStatus(const std::function<bool(const nlohmann::json&)>& wanted) const {
        const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(120);
        while (true) {
            nlohmann::json now = ask("status");
            if (wanted(now) || HasFailure()) {
                return now;
            }
            if (std::chrono::steady_clock::now() > until) {
                ADD_FAILURE() << "the expected status did not come within two minutes: " << now.dump();
                return now;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
    }

    /// The name of this machine in messages.
    [[nodiscard]] static std::string host() {
        std::array<char, 256> name{};
        gethostname(name.data(), name.size() - 1);
        return name.data();
    }
    [[nodiscard]] std::string out() const { return (folder_ / "out").string(); }
    [[nodiscard]] nlohmann::json json(const std::string& file) const { return nlohmann::json::parse(read(file)); }
    [[nodiscard]] nlohmann::json summary() const { return json("out/summary.json"); }
    /// The state hash at the end of an undisturbed replay of the session's journal.
    [[nodiscard]] std::string replayedHash() const {
        const support::Ran replayed = support::runProgram("sandwall-replay", out() + "/session.journal --hash");
        EXPECT_EQ(replayed.status, 0) << replayed.output;
        const std::string text = replayed.output.substr(0, replayed.output.find_last_not_of('\n') + 1);
        return text.substr(text.rfind('\n') + 1);  // warnings may be printed before the hash
    }

    std::vector<std::string> environment_;  // NAME=value, for the sessions
};
